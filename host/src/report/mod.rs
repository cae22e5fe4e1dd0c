//! What was found, for people and programs: a page, a text and a JSON of the same values.

mod candidates;
mod closed_loop;
pub mod effect_page;
mod failures;
mod headline;
mod json;
pub(crate) mod page;
mod parameters;
pub mod playback;
mod proposal;
mod provenance;
mod remains;
mod signatures;
#[cfg(test)]
mod tests;
mod text;
mod traces;
mod waterfall;
mod words;

pub use json::{diagnosis_json, json};
pub use page::html;
pub use proposal::proposal_text;
pub(crate) use signatures::chart as signature_chart;
pub use text::diagnosis_text;

use crate::compare::{Comparison, SignalError};
use crate::diagnose::Diagnosis;
use crate::output::plot::Tone;
use serde::Serialize;

/// Tone of what was measured.
const MEASURED: Tone = Tone::Ink;
/// Tone of the first model.
const BEFORE: Tone = Tone::Orange;
/// Tone of the last model.
const AFTER: Tone = Tone::Blue;
/// Tone of what noise and resolution leave.
const FLOOR: Tone = Tone::Green;

/// Everything a page shows.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Report {
    /// Heading of the page.
    pub title: String,
    /// A chain of models against the same motions: the first is before, the last after.
    pub comparisons: Vec<Comparison>,
    /// What is missing in the first of them, where that was asked.
    pub diagnosis: Option<Diagnosis>,
    /// What the report was made from.
    pub provenance: ReportProvenance,
}

/// What a report was made from and by.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ReportProvenance {
    /// Version of this program.
    pub program_version: String,
    /// Models, in the order of the chain.
    pub model_files: Vec<ModelFile>,
    /// Logs.
    pub logs: Vec<LogFile>,
    /// The command line that makes it again.
    pub command: String,
}

/// A model that was read.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ModelFile {
    /// Its name.
    pub name: String,
    /// SHA-256 of its bytes, in hexadecimal.
    pub sha256: String,
}

/// A log that was read.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct LogFile {
    /// Its name.
    pub name: String,
    /// SHA-256 of its bytes, in hexadecimal.
    pub sha256: String,
    /// Rows in it.
    pub samples: usize,
    /// Whether it took no part in any fit.
    pub held_out: bool,
}

impl Report {
    /// The model at the start of the chain.
    fn before(&self) -> Option<&Comparison> {
        self.comparisons.first()
    }

    /// The model at the end of the chain, if it has more than one.
    fn after(&self) -> Option<&Comparison> {
        self.comparisons.get(1..)?.last()
    }
}

/// Root-mean-square over the joints, which share their samples.
fn pooled(comparison: &Comparison, of: fn(&SignalError) -> f64) -> f64 {
    let squares: f64 = comparison.pooled().map(|signal| of(signal).powi(2)).sum();
    (squares / comparison.pooled().count() as f64).sqrt()
}
