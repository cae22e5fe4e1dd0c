//! What was found, for people and programs: a page, a text and a JSON of the same values.

mod candidates;
mod closed_loop;
mod command;
mod diagnosis_file;
mod discovery;
pub mod effect_page;
mod failures;
mod file_names;
mod gains_page;
mod headline;
mod json;
mod log_check;
mod margins;
mod outcomes;
pub mod page;
mod parameters;
pub mod playback;
pub mod plot;
mod proposal;
mod provenance;
mod raw_plot;
mod refitted;
mod remains;
mod signatures;
mod study_plots;
pub mod table;
#[cfg(test)]
mod tests;
mod text;
mod traces;
mod tuned;
mod verification;
mod waterfall;
mod words;

pub use diagnosis_file::DiagnosisFile;
pub use discovery::{discovered_terms, discovery_text, law_section, term_chart, verdict_sentence};
pub use file_names::{file_name, file_names};
pub use gains_page::{GainsReport, gains_page};
pub use json::{diagnosis_json, discovery_json, gains_json, json};
pub use log_check::{log_check_json, log_check_text};
pub use margins::{
    MarginsPart, input_margins_text, is_low, margins_json, margins_parts, margins_text,
    place_margins_json, with_margins,
};
pub use outcomes::{outcomes_csv, outcomes_html, outcomes_text};
pub use page::html;
pub use page::html_with;
pub use proposal::{next_steps, proposal_text};
pub use raw_plot::{raw_html, raw_text};
pub use refitted::{refitted_json, refitted_text, remedy_of};
pub use signatures::chart as signature_chart;
pub use study_plots::{monte_carlo_svg, sweep_svg};
pub use text::diagnosis_text;
pub use tuned::tuned_text;
pub use verification::verification_text;

use handstand_control::synth;
use handstand_diagnose::diagnose;
use handstand_experiment as experiment;
use handstand_logs as log;
use handstand_model::{dynamics, effects, error, model, motion, output};
use handstand_study as study;

use handstand_fit::{compare, fitting};

use crate::compare::Comparison;
use crate::diagnose::Diagnosis;
use crate::model::JointNames;
use crate::motion::{Motion, Split};
use crate::output::number::hex;
use crate::plot::Tone;
use serde::Serialize;
use sha2::{Digest as _, Sha256};

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
    /// What joints and links are called on the page.
    #[serde(skip)]
    pub names: JointNames,
}

/// What a report was made from and by.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ReportProvenance {
    /// Version of this program.
    pub program_version: String,
    /// Models, in the order of the chain.
    pub model_files: Vec<HashedModel>,
    /// Logs.
    pub logs: Vec<LogFile>,
    /// The command line that makes it again.
    pub command: String,
}

impl ReportProvenance {
    /// Of this version of the program: `command` read the files, and the logs gave these motions.
    pub fn new(model_files: Vec<HashedModel>, split: &Split, command: impl Into<String>) -> Self {
        let mut logs = Vec::new();
        add_logs(&mut logs, &split.training, false);
        add_logs(&mut logs, &split.held_out, true);
        ReportProvenance {
            program_version: env!("CARGO_PKG_VERSION").to_string(),
            model_files,
            logs,
            command: command.into(),
        }
    }
}

fn add_logs(logs: &mut Vec<LogFile>, motions: &[Motion], held_out: bool) {
    for motion in motions {
        let name = file_name(&motion.source.path);
        let same = |log: &&mut LogFile| log.name == name && log.held_out == held_out;
        match logs.iter_mut().find(same) {
            Some(log) => {
                log.samples += motion.len();
                log.motions.push(motion.name.clone());
            }
            None => logs.push(LogFile {
                name,
                motions: vec![motion.name.clone()],
                sha256: motion.source.sha256.clone(),
                samples: motion.len(),
                held_out,
            }),
        }
    }
}

/// A model that was read.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct HashedModel {
    /// Its name.
    pub name: String,
    /// SHA-256 of its bytes, in hexadecimal.
    pub sha256: String,
}

impl HashedModel {
    /// The file of this name with these contents.
    pub fn of(name: impl Into<String>, contents: &[u8]) -> HashedModel {
        HashedModel {
            name: name.into(),
            sha256: hex(Sha256::digest(contents)),
        }
    }
}

/// A log that was read.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct LogFile {
    /// Its name.
    pub name: String,
    /// The motions in it.
    pub motions: Vec<String>,
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

    /// Whether a motion was held out; nothing where no motion was fitted. Of motions of one name
    /// the one after `earlier` others.
    fn is_held_out(&self, motion: &str, earlier: usize) -> Option<bool> {
        let logs = &self.provenance.logs;
        let is_fitted = self.diagnosis.is_some() || logs.iter().any(|log| log.held_out);
        let logs = logs.iter().filter(|_| is_fitted);
        let named = |log: &LogFile| log.motions.iter().filter(|own| *own == motion).count();
        let mut roles = logs.flat_map(|log| std::iter::repeat_n(log.held_out, named(log)));
        roles.nth(earlier)
    }
}
