//! The findings of a check.

use crate::error::{Error, Place, Problem, Result};
use crate::output::readable;
use std::collections::BTreeMap;
use std::fmt;

/// Findings of one kind shown per file; the rest are counted.
const SHOWN: usize = 5;

/// How many findings of a kind are shown before the one that counts the rest: none where all have
/// one cause, which one remedy mends.
fn shown(kind: &str) -> usize {
    match kind {
        "wrap" | "time" | "jump" | "payload" | "turned" => 0,
        _ => SHOWN,
    }
}

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

impl Severity {
    /// Its name in JSON: `note`, `warning`, `refused`.
    pub fn name(self) -> &'static str {
        match self {
            Severity::Note => "note",
            Severity::Warn => "warning",
            Severity::Refuse => "refused",
        }
    }
}

/// One thing found in a log.
#[derive(Debug, Clone, PartialEq)]
pub struct LogFinding {
    /// What it is about: `file`, `cell`, `column`, `range`, `none`, `short`, `time`, `jump`, `gap`,
    /// `jitter`, `payload`, `turned`, `wrap`, `stuck`, `held`, `outlier`, `extreme`, `step`,
    /// `missing`, `unobserved`, `unit`, `relation`, `supply`, `excitation`; of a
    /// diagnosis' conventions `sign`, `zero`, `unit`, `angles`, `drive`, `time_unit`,
    /// `time_shift`, `stalled` or `clipped`.
    pub kind: &'static str,
    /// How much it matters.
    pub severity: Severity,
    /// Where; nowhere in particular if it is about all logs together.
    pub place: Option<Place>,
    /// What was found.
    pub what: String,
    /// What to do about it.
    pub remedy: String,
    /// What the remedy does to the error of the model's simulation, where it was simulated.
    pub proof: Option<Proof>,
}

/// Errors of a simulated model, before and after a remedy, on the same samples.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Proof {
    /// Root-mean-square error as given, rad.
    pub before_rad: f64,
    /// The same with the remedy, rad: larger where the remedy makes the angles themselves larger.
    pub after_rad: f64,
    /// Error as given over that of going on at constant speed, which knows no unit.
    pub before_share: f64,
    /// The same with the remedy.
    pub after_share: f64,
}

impl LogFinding {
    /// Where it is and what it is, without the remedy.
    pub fn statement(&self) -> String {
        match &self.place {
            Some(place) => format!("{place}: {}", self.what),
            None => format!("all logs together: {}", self.what),
        }
    }
}

impl fmt::Display for LogFinding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let severity = self.severity.name();
        write!(f, "{severity}: {} ({})", self.statement(), self.remedy)
    }
}

/// What was found, and what to do about it.
pub(super) type Advice<'a> = (String, &'a str);

/// Findings so far, a bounded number of each kind per file.
#[derive(Debug, Default)]
pub(super) struct Findings {
    /// In the order found.
    pub list: Vec<LogFinding>,
    /// By kind and remedy.
    counts: BTreeMap<(&'static str, String), (usize, Option<LogFinding>)>,
}

impl Findings {
    /// Something worth knowing.
    pub fn note(&mut self, kind: &'static str, place: impl Into<Option<Place>>, words: Advice) {
        self.add(kind, Severity::Note, place.into(), words);
    }

    /// Something that may mislead, or leaves a question open.
    pub fn warn(&mut self, kind: &'static str, place: impl Into<Option<Place>>, words: Advice) {
        self.add(kind, Severity::Warn, place.into(), words);
    }

    /// Something that makes the log useless.
    pub fn refuse(&mut self, kind: &'static str, place: Place, problem: &Problem) {
        let words = (problem.what.clone(), &*problem.remedy);
        self.add(kind, Severity::Refuse, Some(place), words);
    }

    /// What cannot be read becomes a finding; the system's refusals stay errors.
    pub fn broken(&mut self, kind: &'static str, error: Error) -> Result<()> {
        match error {
            Error::Data { place, problem } => {
                self.refuse(kind, place, &problem);
                Ok(())
            }
            other => Err(other),
        }
    }

    /// Adds what a file has at most once.
    pub fn extend(&mut self, findings: impl IntoIterator<Item = LogFinding>) {
        self.list.extend(findings);
    }

    /// Adds a finding, or counts it if its kind has been shown often enough.
    fn add(&mut self, kind: &'static str, severity: Severity, place: Option<Place>, words: Advice) {
        let finding = LogFinding {
            kind,
            severity,
            place,
            what: readable(words.0),
            remedy: readable(words.1),
            proof: None,
        };
        let key = (kind, finding.remedy.clone());
        let (count, first_hidden) = self.counts.entry(key).or_default();
        *count += 1;
        if *count <= shown(kind) {
            self.list.push(finding);
        } else if first_hidden.is_none() {
            *first_hidden = Some(finding);
        }
    }

    /// Ends a file: says how many of each kind were not shown.
    pub fn close(&mut self) {
        for ((kind, _), (count, hidden)) in std::mem::take(&mut self.counts) {
            if let Some(first) = hidden {
                let what = match count - shown(kind) - 1 {
                    0 => first.what,
                    more => format!("{}; and {more} more like it", first.what),
                };
                self.list.push(LogFinding { what, ..first });
            }
        }
    }
}
