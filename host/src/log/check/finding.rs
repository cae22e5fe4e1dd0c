//! What a check has to say.

use crate::error::Place;
use std::collections::BTreeMap;
use std::fmt;

/// Findings of one kind shown per file; the rest are counted.
const SHOWN: usize = 20;

/// How much a finding matters.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Severity {
    /// Worth knowing.
    Note,
    /// May mislead a diagnosis, or leaves a question open.
    Warn,
    /// The log cannot be used as it is.
    Refuse,
}

/// One thing found in a log.
#[derive(Debug, Clone, PartialEq)]
pub struct Finding {
    /// How much it matters.
    pub severity: Severity,
    /// Where; nowhere in particular if it is about all logs together.
    pub place: Option<Place>,
    /// What was found.
    pub what: String,
    /// What to do about it.
    pub remedy: String,
}

impl Finding {
    /// Where it is and what it is, without the remedy.
    pub fn statement(&self) -> String {
        match &self.place {
            Some(place) => format!("{place}: {}", self.what),
            None => format!("all logs together: {}", self.what),
        }
    }
}

impl fmt::Display for Finding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let word = match self.severity {
            Severity::Note => "note",
            Severity::Warn => "warning",
            Severity::Refuse => "refused",
        };
        write!(f, "{word}: {} ({})", self.statement(), self.remedy)
    }
}

/// Findings so far, a bounded number of each kind per file.
#[derive(Debug, Default)]
pub(super) struct Findings {
    /// In the order found.
    pub list: Vec<Finding>,
    counts: BTreeMap<&'static str, (usize, Option<Finding>)>,
}

impl Findings {
    /// Adds a finding, or counts it if its kind has been shown often enough.
    pub fn add(
        &mut self,
        kind: &'static str,
        severity: Severity,
        place: impl Into<Option<Place>>,
        what: impl Into<String>,
        remedy: impl Into<String>,
    ) {
        let finding = Finding {
            severity,
            place: place.into(),
            what: what.into(),
            remedy: remedy.into(),
        };
        let (count, first_hidden) = self.counts.entry(kind).or_default();
        *count += 1;
        if *count <= SHOWN {
            self.list.push(finding);
        } else if first_hidden.is_none() {
            *first_hidden = Some(finding);
        }
    }

    /// Ends a file: says how many of each kind were not shown.
    pub fn close(&mut self) {
        for (count, hidden) in std::mem::take(&mut self.counts).into_values() {
            if let Some(first) = hidden {
                self.list.push(Finding {
                    what: format!("{}; and {} more like it", first.what, count - SHOWN - 1),
                    ..first
                });
            }
        }
    }
}
