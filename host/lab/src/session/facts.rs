//! What each log holds, as far as it can be read.

use super::LabSession;
use super::saved::{SavedLog, SavedSession};
use crate::error::{Error, Place, Result};
use crate::log::{LogRequest, RawLog};
use crate::model::Model;

/// What a log holds, as far as it can be read.
#[derive(Debug, Clone)]
pub struct LogFacts {
    /// The log.
    pub log: SavedLog,
    /// What it holds, or why it cannot be read and what mends it.
    pub content: std::result::Result<LogContent, (String, String)>,
}

/// What a log holds.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LogContent {
    /// Motions, where a model says what they are.
    pub motions: Option<usize>,
    /// Samples, or rows before any model.
    pub samples: usize,
    /// Their length together, s, where a model says which column is the time.
    pub seconds: Option<f64>,
}

impl LabSession {
    /// What each log holds by the model in force.
    pub fn log_facts(&self, saved: &SavedSession, model: Option<&Model>) -> Vec<LogFacts> {
        let facts = |log: &SavedLog| LogFacts {
            log: log.clone(),
            content: self.content(log, model).map_err(|error| {
                let remedy = error.remedy().unwrap_or_default().into_owned();
                (self.shortened(&error.to_string()), remedy)
            }),
        };
        saved.logs.iter().map(facts).collect()
    }

    fn content(&self, log: &SavedLog, model: Option<&Model>) -> Result<LogContent> {
        let path = self.log_path(&log.file);
        if !path.exists() {
            return Err(Error::usage(
                "its file is not in this session",
                format!("drop {} here: it takes its place", log.file),
            ));
        }
        let request = LogRequest {
            path,
            rows: log.rows,
        };
        let Some(model) = model else {
            return raw_content(&request);
        };
        let motions = crate::log::read(&[request], &model.log)?;
        Ok(LogContent {
            motions: Some(motions.len()),
            samples: motions.iter().map(|motion| motion.len()).sum(),
            seconds: Some(motions.iter().map(|motion| motion.duration_s()).sum()),
        })
    }
}

/// What can be said of a log before a model says what its columns mean.
fn raw_content(request: &LogRequest) -> Result<LogContent> {
    let raw = RawLog::read_request(request)?;
    let samples = raw.columns.first().map_or(0, Vec::len);
    let numbers = raw.columns.iter().flatten().any(|value| value.is_finite());
    if samples == 0 || !numbers {
        return Err(Error::data(
            Place::file(&request.path),
            "no row of it holds a number",
            "export it as text in UTF-8, a header line above the rows",
        ));
    }
    Ok(LogContent {
        motions: None,
        samples,
        seconds: None,
    })
}
