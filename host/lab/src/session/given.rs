//! What the command line gives a new session.

use super::LabSession;
use super::bring::{is_model, model_step};
use super::saved::SavedStep;
use crate::error::{Error, Result};
use crate::log::{LogFormat, LogRequest};
use std::path::{Path, PathBuf};

fn text(file: &Path) -> Result<String> {
    std::fs::read_to_string(file).map_err(|why| Error::file(file, "read", why))
}

/// A model and logs, as files.
#[derive(Debug, Clone, Default)]
pub struct ProjectFiles {
    /// Model file: TOML, URDF or MJCF.
    pub model: Option<PathBuf>,
    /// Logs.
    pub logs: Vec<LogRequest>,
}

impl ProjectFiles {
    /// Files as they stand on a command line: a model, first or known by its ending, and logs.
    ///
    /// # Errors
    /// Two models.
    pub fn of(files: &[LogRequest]) -> Result<ProjectFiles> {
        let mut given = ProjectFiles::default();
        for (index, file) in files.iter().enumerate() {
            let unknown = !LogFormat::is_log(&file.path);
            if !(is_model(&file.path) || index == 0 && unknown) {
                given.logs.push(file.clone());
            } else if let Some(first) = given.model.replace(file.path.clone()) {
                return Err(Error::usage(
                    format!("{} and {file} are two models", first.display()),
                    "begin with one of them, and drop the other into the page",
                ));
            }
        }
        Ok(given)
    }

    /// Reads them once, so that what is wrong is said before a browser opens.
    ///
    /// # Errors
    /// Files that cannot be read, a model that is none.
    pub fn check(&self) -> Result<()> {
        if let Some(file) = &self.model {
            model_step(file, &text(file)?)?;
        }
        for log in &self.logs {
            std::fs::File::open(&log.path).map_err(|why| Error::file(&log.path, "read", why))?;
        }
        Ok(())
    }
}

impl LabSession {
    /// Copies the given files into the session.
    ///
    /// # Errors
    /// Files that cannot be read or written.
    pub fn bring(&self, given: &ProjectFiles) -> Result<()> {
        if let Some(file) = &given.model {
            let step = SavedStep {
                title: "as given".into(),
                ..model_step(file, &text(file)?)?
            };
            self.push_step(step)?;
        }
        for log in &given.logs {
            let bytes =
                std::fs::read(&log.path).map_err(|why| Error::file(&log.path, "read", why))?;
            let name = LogRequest::whole(&log.path).name();
            let file = self.keep_log(&name, &bytes)?;
            self.take_rows(&file, log.rows)?;
        }
        Ok(())
    }
}
