//! What the command line gives a new session.

use super::LabSession;
use super::bring::{check_model, is_model};
use super::saved::SavedStep;
use crate::error::{Error, Result};
use crate::log::lerobot::dataset_files;
use crate::log::{LogFormat, LogRequest, unfolded};
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
            let unknown = !LogFormat::is_log(&file.path) && !file.path.is_dir();
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
            check_model(file, &text(file)?)?;
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
        for log in &given.logs {
            match dataset_files(&log.path)? {
                Some(files) => self.keep_dataset(&log.path, &files)?,
                None => self.bring_logs(log)?,
            }
        }
        // A robot's file takes the columns of the first log.
        if let Some(file) = &given.model {
            let beside = file.parent().unwrap_or(Path::new(""));
            let step = SavedStep {
                title: "as given".into(),
                ..self.model_step(file, &text(file)?, Some(beside))?
            };
            self.push_step(step)?;
        }
        Ok(())
    }

    /// Copies a log into the session, or those of a folder.
    fn bring_logs(&self, request: &LogRequest) -> Result<()> {
        for log in unfolded(std::slice::from_ref(request))? {
            let bytes =
                std::fs::read(&log.path).map_err(|why| Error::file(&log.path, "read", why))?;
            let name = LogRequest::whole(&log.path).name();
            let file = self.keep_log(&name, &bytes)?;
            self.take_rows(&file, log.rows)?;
        }
        Ok(())
    }
}
