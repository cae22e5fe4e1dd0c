//! Logs as named: those to learn from, and those to judge by.

use super::LogFinding;
use super::folder::expanded;
use super::read::read_with_findings;
use super::request::LogRequest;
use super::same_rows::SizedRequest;
use crate::error::{Error, Result};
use crate::model::LogColumns;
use crate::motion::{NAME_ONCE, Split};

/// Logs to learn from and logs to judge by, which share no row.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct LogSet {
    /// To learn from.
    pub training: Vec<LogRequest>,
    /// To judge by.
    pub held_out: Vec<LogRequest>,
}

impl LogSet {
    /// The logs to learn from, then those to judge by.
    pub fn all(&self) -> Vec<LogRequest> {
        [self.training.as_slice(), &self.held_out].concat()
    }

    /// Their motions; none in `held_out` means that all are learned from.
    ///
    /// # Errors
    /// Logs that cannot be read, or rows in both.
    pub fn read(&self, columns: &LogColumns) -> Result<Split> {
        Ok(self.read_with_findings(columns)?.0)
    }

    /// As [`LogSet::read`], with a warning for each log of which motions are left out.
    ///
    /// # Errors
    /// As [`LogSet::read`].
    pub fn read_with_findings(&self, columns: &LogColumns) -> Result<(Split, Vec<LogFinding>)> {
        self.told_apart()?;
        let (training, mut findings) = read_with_findings(&self.training, columns)?;
        let (held_out, more) = read_with_findings(&self.held_out, columns)?;
        findings.extend(more);
        let split = Split { training, held_out };
        Ok((split, findings))
    }

    /// Refuses rows that are both learned from and judged by.
    fn told_apart(&self) -> Result<()> {
        let (training, held_out) = (expanded(&self.training)?, expanded(&self.held_out)?);
        let training = SizedRequest::all(&training);
        for own in SizedRequest::all(&held_out) {
            let mut fitted = training.iter();
            let fitted = fitted.find_map(|log| Some((log.request, log.same(&own)?)));
            if let Some((fitted, by)) = fitted {
                let held = own.request;
                let message = if fitted == held {
                    format!("{held} is fitted and held out")
                } else {
                    format!(
                        "{held} is held out, and shares rows with {fitted}, which is fitted{}",
                        by.words()
                    )
                };
                return Err(Error::usage(message, NAME_ONCE));
            }
        }
        Ok(())
    }
}
