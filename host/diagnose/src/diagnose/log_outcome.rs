//! Many logs, each diagnosed by itself: a line of JSON for each, so that shards and killed runs go
//! on where they were.

use super::conventions::ModelFile;
use super::findings::{Diagnosis, FittedEffect, Verdict};
use super::logs::{LogDiagnosis, diagnose_logs};
use super::options::DiagnoseOptions;
use super::words::headline;
use crate::error::{Error, Place, Result};
use crate::fitting::{FittedValue, Progress};
use crate::log::{LogRequest, LogSet};
use crate::model::Model;
use crate::output::append_file::AppendFile;
use crate::output::number::hex;
use serde::{Deserialize, Serialize};
use sha2::{Digest as _, Sha256};
use std::path::Path;

/// What decides an outcome beside the log: equal where it is equal.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct OutcomeKey {
    /// The log's name.
    pub log: String,
    /// SHA-256 of the log.
    pub sha256: String,
    /// SHA-256 of the model's text, the options and the program's version.
    pub fingerprint: String,
}

/// A value as one log has it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct OutcomeValue {
    /// Address in the model: `coulomb@1.torque_nm`.
    pub path: String,
    /// Unit for people.
    pub unit: String,
    /// The value, in its unit.
    pub value: f64,
    /// Lower end of the 95 % interval; absent where the log does not bound it.
    pub low: Option<f64>,
    /// Upper end.
    pub high: Option<f64>,
}

/// What one log says of the model.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct LogOutcome {
    /// Which log, and under what it was diagnosed.
    #[serde(flatten)]
    pub key: OutcomeKey,
    /// The verdict, as `diagnose` names it; `unreadable` of a log that is refused before.
    pub verdict: String,
    /// The verdict in a sentence, or why the log is refused.
    pub said: String,
    /// Effects of the best explanation: `coulomb@1`.
    pub effects: Vec<String>,
    /// Values of the explanation: those of its effects, and those of the file that are wrong.
    pub values: Vec<OutcomeValue>,
    /// Root-mean-square error of the model as given, rad; absent where it was not simulated.
    pub before_rad: Option<f64>,
    /// Error with the explanation, rad.
    pub after_rad: Option<f64>,
    /// What resolution and noise alone leave, rad.
    pub floor_rad: Option<f64>,
}

impl OutcomeKey {
    /// The key of a log.
    ///
    /// # Errors
    /// A log that cannot be read.
    pub fn of(log: &LogRequest, file: &ModelFile, options: &DiagnoseOptions) -> Result<OutcomeKey> {
        let refused = |error| Error::file(&log.path, "read", error);
        let bytes = std::fs::read(&log.path).map_err(refused)?;
        let version = env!("CARGO_PKG_VERSION");
        let decides = format!("{version}\n{options:?}\n{}", file.text);
        Ok(OutcomeKey {
            log: log.name(),
            sha256: hex(Sha256::digest(&bytes)),
            fingerprint: hex(Sha256::digest(decides.as_bytes())),
        })
    }
}

impl LogOutcome {
    /// Diagnoses the model of `file` from one log, of whose motions the last third judges. A log
    /// that cannot be read is an outcome too.
    pub fn of(
        model: &Model,
        file: ModelFile,
        (log, key): (&LogRequest, OutcomeKey),
        options: &DiagnoseOptions,
        progress: &(dyn Fn(Progress) + Sync),
    ) -> LogOutcome {
        let set = LogSet {
            training: vec![log.clone()],
            held_out: Vec::new(),
        };
        match diagnose_logs(model, file, &set, options, progress) {
            Ok(LogDiagnosis { diagnosis, .. }) => LogOutcome::found(key, &diagnosis),
            Err(error) => LogOutcome {
                key,
                verdict: "unreadable".to_string(),
                said: error.to_string(),
                effects: Vec::new(),
                values: Vec::new(),
                before_rad: None,
                after_rad: None,
                floor_rad: None,
            },
        }
    }

    fn found(key: OutcomeKey, diagnosis: &Diagnosis) -> LogOutcome {
        let finite = |rad: f64| rad.is_finite().then_some(rad);
        let value = |fitted: &FittedValue| OutcomeValue {
            path: fitted.path.clone(),
            unit: fitted.unit.clone(),
            value: fitted.value,
            low: finite(fitted.low),
            high: finite(fitted.high),
        };
        let effects = diagnosis.effects.iter();
        let wrong = diagnosis.wrong_values.iter().map(|wrong| &wrong.fitted);
        let values = effects.clone().flat_map(|effect| &effect.parameters);
        let was_simulated = diagnosis.verdict != Verdict::Unfit;
        let error = |rad: f64| finite(rad).filter(|_| was_simulated);
        let said = if was_simulated {
            headline(diagnosis)
        } else {
            diagnosis.summary.join(" ")
        };
        LogOutcome {
            key,
            verdict: diagnosis.verdict.name().to_string(),
            said,
            effects: effects.map(FittedEffect::address).collect(),
            values: values.chain(wrong).map(value).collect(),
            before_rad: error(diagnosis.error.before_rad),
            after_rad: error(diagnosis.error.after_rad),
            floor_rad: error(diagnosis.error.floor_rad),
        }
    }

    /// Whether the log could be read and learned from.
    pub fn is_usable(&self) -> bool {
        !["unreadable", "unfit"].contains(&self.verdict.as_str())
    }
}

/// A file of outcomes, to which this program alone appends.
#[derive(Debug)]
pub struct OutcomeFile {
    file: AppendFile,
    path: std::path::PathBuf,
}

impl OutcomeFile {
    /// Opens or begins a file. A line that a crash tore is cut off.
    ///
    /// # Errors
    /// A file that another program writes, and what the system refuses.
    pub fn open(path: &Path) -> Result<OutcomeFile> {
        let Some((mut file, bytes)) = AppendFile::open(path)? else {
            return Err(Error::usage(
                format!("another program writes {}", path.display()),
                "let it end, or give this one another shard or folder",
            ));
        };
        let whole = bytes.iter().rposition(|byte| *byte == b'\n');
        file.cut(whole.map_or(0, |end| end + 1) as u64)?;
        Ok(OutcomeFile {
            file,
            path: path.to_path_buf(),
        })
    }

    /// Appends an outcome, which is on the disk when this returns.
    ///
    /// # Errors
    /// What the system refuses.
    pub fn append(&mut self, outcome: &LogOutcome) -> Result<()> {
        let line = serde_json::to_string(outcome)
            .map_err(|error| Error::file(&self.path, "write", error.into()))?;
        self.file.append(&(line + "\n"))
    }
}

/// The outcomes in all `.jsonl` files of a folder, in the order of the files' names; none where
/// there is no folder. A torn last line is passed over.
///
/// # Errors
/// Lines that are no outcomes, and what the system refuses.
pub fn outcomes_in(folder: &Path) -> Result<Vec<LogOutcome>> {
    let refused = |error| Error::file(folder, "read", error);
    if !folder.exists() {
        return Ok(Vec::new());
    }
    let mut files = Vec::new();
    for entry in std::fs::read_dir(folder).map_err(refused)? {
        let path = entry.map_err(refused)?.path();
        if path.extension().is_some_and(|ending| ending == "jsonl") {
            files.push(path);
        }
    }
    files.sort();
    let mut outcomes = Vec::new();
    for path in files {
        let text = std::fs::read_to_string(&path).map_err(|e| Error::file(&path, "read", e))?;
        let whole = &text[..text.rfind('\n').map_or(0, |end| end + 1)];
        for (number, line) in whole.lines().enumerate() {
            outcomes.push(serde_json::from_str(line).map_err(|error| {
                let place = Place::at(&path, number + 1, error.column());
                let remedy = "name a folder that `diagnose --each` wrote, or take this file away";
                Error::data(place, format!("no outcome of a log: {error}"), remedy)
            })?);
        }
    }
    Ok(outcomes)
}
