//! The arm of a seed, and how one of its joints is written.

use crate::hidden::mujoco_script;
use handstand::Model;
use handstand::log::{LogRequest, read};
use handstand::motion::Motion;
use serde::{Deserialize, Serialize};
use std::path::Path;

/// An arm.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ConventionCase {
    /// Its seed.
    pub seed: u64,
    /// Whether one joint's log follows another convention.
    pub is_spoiled: bool,
}

/// How a joint's angle and goal are written: factor times angle plus offset.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Convention {
    /// `sign`, `zero` or `unit`.
    pub kind: String,
    /// Joint counted from 1.
    pub joint: usize,
    /// What is written of a radian.
    pub factor: f64,
    /// What is written of angle 0.
    pub offset: f64,
}

/// The files of a case, read.
pub(super) struct Read {
    /// What its owner believes: friction up to 30 % off.
    pub model: Model,
    /// As the model reads the log to learn from, and the one held out.
    pub motions: [Vec<Motion>; 2],
    pub convention: Option<Convention>,
}

#[derive(Deserialize)]
struct TruthFile {
    fit: Vec<String>,
    held_out: Vec<String>,
    convention: Option<Convention>,
}

impl ConventionCase {
    /// Writes the files of the arm that this URDF describes into a folder, and reads them.
    pub(super) fn read(self, urdf: &Path, dir: &Path) -> Result<Read, String> {
        let urdf = urdf.to_string_lossy();
        let convention = if self.is_spoiled { "any" } else { "file" };
        let words = ["--urdf", &urdf, "--convention", convention];
        let truth: TruthFile = mujoco_script("hidden_space.py", dir, self.seed, &words)?;
        let told = |error: handstand::Error| error.to_string();
        let model = Model::load(&dir.join("nominal.toml")).map_err(told)?;
        let motions = |logs: &[String]| {
            let requests = logs.iter().map(|log| LogRequest::whole(dir.join(log)));
            read(&requests.collect::<Vec<_>>(), &model.log).map_err(told)
        };
        let motions = [motions(&truth.fit)?, motions(&truth.held_out)?];
        Ok(Read {
            model,
            motions,
            convention: truth.convention,
        })
    }
}

impl Convention {
    /// The motions as the file's convention writes them.
    pub(super) fn undone(&self, motions: &[Motion]) -> Vec<Motion> {
        let mut motions = motions.to_vec();
        for motion in &mut motions {
            let joint = self.joint - 1;
            let goals = motion.input[joint].iter_mut().flatten();
            for value in motion.position_rad[joint].iter_mut().chain(goals) {
                *value = (*value - self.offset) / self.factor;
            }
        }
        motions
    }
}
