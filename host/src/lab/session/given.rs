//! What the command line gives a new session.

use super::LabSession;
use super::saved::SavedLog;
use crate::error::{Error, Result};
use crate::log::LogRequest;
use crate::model::Model;
use std::path::PathBuf;

/// A model and logs, as files.
#[derive(Debug, Clone, Default)]
pub struct Given {
    /// Model file.
    pub model: Option<PathBuf>,
    /// Logs.
    pub logs: Vec<LogRequest>,
}

impl Given {
    /// Reads them once, so that what is wrong is said before a browser opens.
    ///
    /// # Errors
    /// Files that cannot be read, a model that is none.
    pub fn check(&self) -> Result<()> {
        if let Some(file) = &self.model {
            Model::load(file)?;
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
    pub fn bring(&self, given: &Given) -> Result<()> {
        if let Some(file) = &given.model {
            let text =
                std::fs::read_to_string(file).map_err(|why| Error::file(file, "read", why))?;
            self.begin_model("as given", &text)?;
        }
        for log in &given.logs {
            let bytes =
                std::fs::read(&log.path).map_err(|why| Error::file(&log.path, "read", why))?;
            let name = LogRequest::whole(&log.path).name();
            let file = self.keep_log(&name, &bytes)?;
            let rows = log.rows;
            self.change(|saved| {
                saved.logs.push(SavedLog {
                    file,
                    rows,
                    held_out: false,
                });
                Ok(())
            })?;
        }
        Ok(())
    }
}
