//! One case diagnosed within a limit of time, and as long as it takes.

use super::case::Case;
use super::said::said;
use super::trial::motions;
use handstand::Model;
use handstand::diagnose::{DiagnoseOptions, diagnose};
use handstand::fitting::Progress;
use handstand::report::diagnosis_json;
use serde::{Deserialize, Serialize};
use std::sync::{Mutex, PoisonError};
use std::time::Instant;

/// A case with both answers.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Within {
    /// Kinds of the effects it hides.
    pub hidden: Vec<String>,
    /// Its seed.
    pub seed: u64,
    /// The limit, s.
    pub limit_s: f64,
    /// The answer within the limit.
    pub limited: Timed,
    /// The answer of the whole search.
    pub whole: Timed,
}

/// An answer and how long it took.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Timed {
    /// The verdict, in its own word.
    pub verdict: String,
    /// Effects and values of the best explanation.
    pub set: Vec<String>,
    /// How the search ended.
    pub ended: String,
    /// What was left out, in words.
    pub left_out: Vec<String>,
    /// Error on the motions held out with it, rad.
    pub after_rad: f64,
    /// Seconds on the clock.
    pub seconds: f64,
    /// What it did, and the second at which it began that.
    pub stages: Vec<(String, f64)>,
}

impl Within {
    /// Whether both say the same.
    pub fn agrees(&self) -> bool {
        self.limited.verdict == self.whole.verdict
    }

    /// Seconds by which the answer within the limit came late; below 0 where it came before.
    pub fn late_s(&self) -> f64 {
        self.limited.seconds - self.limit_s
    }
}

/// Diagnoses a case within a limit, then with none.
///
/// # Errors
/// Logs that cannot be made, and files that cannot be written or are refused.
pub fn try_within(case: &Case, limit_s: f64) -> Result<Within, String> {
    let passing = tempfile::tempdir().map_err(|error| error.to_string())?;
    let files = case.write(passing.path())?;
    let timed = |within_s: Option<f64>| -> handstand::Result<Timed> {
        let begun = Instant::now();
        let model = Model::load(&files.nominal)?;
        let (fit, held_out) = (
            motions(&model, &files.fit)?,
            motions(&model, &files.held_out)?,
        );
        let options = DiagnoseOptions {
            without: case.without(),
            within_s,
            ..DiagnoseOptions::default()
        };
        let stages: Mutex<Vec<(String, f64)>> = Mutex::default();
        let heard = |progress: Progress| {
            let mut stages = stages.lock().unwrap_or_else(PoisonError::into_inner);
            if stages.last().is_none_or(|(what, _)| *what != progress.what) {
                stages.push((progress.what.into_owned(), begun.elapsed().as_secs_f64()));
            }
        };
        let json = diagnosis_json(&diagnose(&model, fit, held_out, &options, &heard));
        let seconds = begun.elapsed().as_secs_f64();
        let said = said(&json);
        let text = |value: &serde_json::Value| value.as_str().unwrap_or_default().to_string();
        let left_out = json["left_out"].as_array().into_iter().flatten();
        Ok(Timed {
            verdict: said.verdict,
            set: said.sets.into_iter().next().unwrap_or_default(),
            ended: text(&json["search_ended"]),
            left_out: left_out.map(text).collect(),
            after_rad: json["error"]["after_rad"].as_f64().unwrap_or(f64::NAN),
            seconds,
            stages: stages.into_inner().unwrap_or_else(PoisonError::into_inner),
        })
    };
    let refused = |error: handstand::Error| error.to_string();
    Ok(Within {
        hidden: case.hidden.iter().map(ToString::to_string).collect(),
        seed: case.seed,
        limit_s,
        limited: timed(Some(limit_s)).map_err(refused)?,
        whole: timed(None).map_err(refused)?,
    })
}
