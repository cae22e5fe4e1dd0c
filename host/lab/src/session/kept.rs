//! Diagnoses, kept by what they were made of: the bytes of the model and of the logs. One comes
//! back when its model and its logs do.

use super::card::SavedDiagnosis;
use super::saved::{SavedLog, SavedSession};
use crate::output::number::hex;
use serde::{Deserialize, Serialize};
use sha2::{Digest as _, Sha256};

/// Most diagnoses of a session; the oldest goes first.
const MOST: usize = 24;

/// A diagnosis, and what it is of.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct KeptDiagnosis {
    /// The model and the logs.
    pub of: DiagnosedFiles,
    /// What it said.
    pub said: SavedDiagnosis,
    /// The experiment that was proposed after it, if one was asked for.
    #[serde(default)]
    pub proposal: Option<SavedProposal>,
}

/// What a diagnosis is of, as SHA-256 in hexadecimal.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct DiagnosedFiles {
    /// Of the model's text.
    pub model_sha256: String,
    /// Of the logs' contents, rows and roles, in no order.
    pub logs_sha256: String,
}

/// The next experiment, as it was proposed.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SavedProposal {
    /// What to do, step by step.
    pub steps: Vec<String>,
    /// All of it as the command `next` prints it.
    pub text: String,
    /// The motion as a file, where one helps.
    pub motion_csv: Option<String>,
}

/// SHA-256 of a model's text, in hexadecimal.
pub fn model_sha256(toml: &str) -> String {
    hex(Sha256::digest(toml))
}

fn logs_sha256(logs: &[SavedLog]) -> String {
    let line = |log: &SavedLog| {
        // Files of sessions before hashes were kept are known by their names.
        let file = if log.sha256.is_empty() {
            &log.file
        } else {
            &log.sha256
        };
        format!("{file} {:?} {}\n", log.rows, log.held_out)
    };
    let mut lines: Vec<String> = logs.iter().map(line).collect();
    lines.sort();
    hex(Sha256::digest(lines.concat()))
}

impl SavedSession {
    /// What a diagnosis of the model of this step would be of.
    pub fn files_of(&self, step: usize) -> Option<DiagnosedFiles> {
        Some(DiagnosedFiles {
            model_sha256: model_sha256(&self.steps.get(step)?.toml),
            logs_sha256: logs_sha256(&self.logs),
        })
    }

    /// Keeps what a diagnosis of these files said, in place of an earlier one of the same.
    pub fn keep_diagnosis(&mut self, of: DiagnosedFiles, said: SavedDiagnosis) {
        self.kept.retain(|kept| kept.of != of);
        self.kept.push(KeptDiagnosis {
            of,
            said,
            proposal: None,
        });
        let surplus = self.kept.len().saturating_sub(MOST);
        self.kept.drain(..surplus);
    }

    /// Puts the diagnosis in force that belongs to the logs: that of the model in force, else the
    /// last one of a model among the steps; none where there is none.
    pub fn recall(&mut self) {
        let found = self.recalled();
        self.diagnosis = found.map(|(step, kept)| SavedDiagnosis {
            step,
            ..kept.said.clone()
        });
    }

    /// The experiment that was proposed after the diagnosis in force.
    pub fn proposal(&self) -> Option<&SavedProposal> {
        self.recalled()?.1.proposal.as_ref()
    }

    fn recalled(&self) -> Option<(usize, &KeptDiagnosis)> {
        let logs = logs_sha256(&self.logs);
        let models: Vec<String> = self.steps.iter().map(|s| model_sha256(&s.toml)).collect();
        let step_of = |kept: &KeptDiagnosis| match &kept.of.model_sha256 {
            own if models.get(self.current) == Some(own) => Some(self.current),
            own => models.iter().rposition(|model| model == own),
        };
        let known = self.kept.iter().filter(|kept| kept.of.logs_sha256 == logs);
        let known: Vec<_> = known.filter_map(|k| Some((step_of(k)?, k))).collect();
        let of_current = known.iter().find(|(step, _)| *step == self.current);
        of_current.or(known.last()).copied()
    }
}
