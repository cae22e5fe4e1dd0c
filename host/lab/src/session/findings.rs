//! What the check of the logs finds, kept while model and logs stay as they are: it simulates, and
//! pages ask for it again and again.

use super::LabSession;
use super::aside::aside;
use super::saved::{SavedLog, SavedSession};
use crate::diagnose::conventions::{self, ModelFile};
use crate::error::Result;
use crate::log::LogFinding;
use std::sync::{Arc, PoisonError};

/// What findings depend on.
#[derive(Debug, Clone, PartialEq)]
struct Checked {
    toml: String,
    logs: Vec<SavedLog>,
}

/// The last findings.
#[derive(Debug, Default)]
pub(super) struct KnownFindings(Option<(Checked, Arc<Vec<LogFinding>>)>);

impl LabSession {
    /// What `handstand log check` finds; nothing without model or logs. Who asks while the check
    /// runs waits for its end.
    ///
    /// # Errors
    /// The system's refusal.
    pub fn findings(&self, saved: &SavedSession) -> Result<Arc<Vec<LogFinding>>> {
        let step = saved.step().filter(|_| !saved.logs.is_empty());
        let (Some(step), Some(model)) = (step, self.model(saved)?) else {
            return Ok(Arc::default());
        };
        let asked = Checked {
            toml: step.toml.clone(),
            logs: saved.logs.clone(),
        };
        let known = self.findings.lock();
        let mut known = known.unwrap_or_else(PoisonError::into_inner);
        if let Some((_, found)) = known.0.as_ref().filter(|(key, _)| *key == asked) {
            return Ok(found.clone());
        }
        let file = ModelFile {
            path: &self.model_path(saved.current),
            text: &step.toml,
        };
        let logs = self.log_set(saved).all();
        let found = aside(|| conventions::findings(&logs, &model, file))?;
        let found = Arc::new(found);
        known.0 = Some((asked, found.clone()));
        Ok(found)
    }
}
