//! A round of a challenge: an arm with a hidden effect, to be named.

use super::LabSession;
use crate::challenge::{ChallengeScore, Hidden, generate, score, write};
use crate::diagnose::whole_error_rad;
use crate::error::{Error, Result};
use rand::RngCore as _;
use serde::{Deserialize, Serialize};

/// Folder of the challenge's files.
const FOLDER: &str = "challenge";

/// A round.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Round {
    /// Seed of the bench.
    pub seed: u64,
    /// How it ended.
    pub result: Option<RoundResult>,
}

/// How a round ended.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct RoundResult {
    /// The hidden effect; nothing where none was.
    pub hidden: Option<String>,
    /// Effects that the model had been given.
    pub added: Vec<String>,
    /// Whether exactly the hidden effect was added.
    pub solved: bool,
    /// Key, true value and estimate.
    pub values: Vec<(String, f64, Option<f64>)>,
    /// Error on the last log of the model as it was given, rad.
    pub nominal_error_rad: f64,
    /// The same of the model handed in.
    pub error_rad: f64,
    /// The same of the truth.
    pub true_error_rad: f64,
}

impl From<ChallengeScore> for RoundResult {
    fn from(score: ChallengeScore) -> Self {
        let values = score.values.into_iter();
        RoundResult {
            hidden: score.hidden,
            added: score.added,
            solved: score.solved,
            values: values.map(|v| (v.key, v.true_value, v.estimate)).collect(),
            nominal_error_rad: score.nominal_error_rad,
            error_rad: score.error_rad,
            true_error_rad: score.true_error_rad,
        }
    }
}

impl LabSession {
    /// Begins a round with a bench of this seed; a random one without.
    ///
    /// # Errors
    /// The system's refusal.
    pub fn begin_round(&self, seed: Option<u64>) -> Result<()> {
        // Short enough to be typed after `handstand challenge new --seed`.
        let seed = seed.unwrap_or_else(|| u64::from(rand::rng().next_u32()));
        let made = generate(seed, Hidden::Random);
        write(&made, &self.folder().join(FOLDER))?;
        self.bring_bench(&made.model_toml, &made.logs)?;
        self.change(|saved| {
            saved.round = Some(Round { seed, result: None });
            Ok(())
        })
    }

    /// Hands in the model in force, and opens the answer.
    ///
    /// # Errors
    /// There is no round, or it is over.
    pub fn hand_in(&self) -> Result<()> {
        let saved = self.saved();
        let (Some(model), Some(Round { result: None, .. })) = (self.model(&saved)?, &saved.round)
        else {
            return Err(Error::usage("no round is open", "begin one"));
        };
        let result = score(&self.folder().join(FOLDER), &model, whole_error_rad)?;
        self.change(|saved| {
            if let Some(round) = &mut saved.round {
                round.result = Some(result.into());
            }
            Ok(())
        })
    }
}
