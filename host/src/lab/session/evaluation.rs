//! The model of a step run along the session's motions, kept while it may be asked for again.

use super::Session;
use super::data::model_file;
use super::saved::{SavedLog, SavedSession};
use crate::compare::{Comparison, FailingSamples, ModelRun};
use crate::error::Result;
use crate::fitting::{FitData, Horizon};
use crate::model::Model;
use std::path::Path;
use std::sync::{Arc, OnceLock, PoisonError};

/// How many are kept.
const KEPT: usize = 6;

/// A model run along all motions, as `handstand compare` runs it.
#[derive(Debug)]
pub struct Evaluation {
    /// The run.
    pub run: ModelRun,
    /// Motions that are fitted; those after them are held out.
    pub fitted: usize,
    comparison: OnceLock<Comparison>,
    failing: OnceLock<Vec<FailingSamples>>,
    name: String,
}

impl Evaluation {
    /// The comparison, made when it is first asked for.
    pub fn comparison(&self) -> &Comparison {
        self.comparison
            .get_or_init(|| self.run.comparison(&self.name))
    }

    /// The conditions under which the model fails, with their samples.
    pub fn failing(&self) -> &[FailingSamples] {
        self.failing.get_or_init(|| self.run.failing())
    }

    /// Root-mean-square error, rad, all joints and motions together.
    pub fn rms_rad(&self) -> f64 {
        pooled(&self.run.rms_rad())
    }

    /// What noise and resolution alone leave, rad.
    pub fn floor_rad(&self) -> f64 {
        self.run.data.floor_rad()
    }

    /// Whether a motion is held out.
    pub fn is_held_out(&self, motion: usize) -> bool {
        motion >= self.fitted
    }
}

/// Root-mean-square over the joints, which share their samples.
pub fn pooled(rms_rad: &[f64]) -> f64 {
    let squares: f64 = rms_rad.iter().map(|rms| rms * rms).sum();
    (squares / rms_rad.len().max(1) as f64).sqrt()
}

/// What an evaluation depends on.
#[derive(Debug, Clone, PartialEq)]
struct Wanted {
    toml: String,
    logs: Vec<SavedLog>,
    horizon_s: Option<f64>,
}

/// The last evaluations.
#[derive(Debug, Default)]
pub(super) struct Evaluations(Vec<(Wanted, Arc<Evaluation>)>);

impl Session {
    /// The step's model along the session's motions; nothing without model or logs.
    ///
    /// # Errors
    /// Logs that cannot be read.
    pub fn evaluation(&self, saved: &SavedSession, step: usize) -> Result<Option<Arc<Evaluation>>> {
        let Some(toml) = saved.steps.get(step).map(|step| step.toml.clone()) else {
            return Ok(None);
        };
        if saved.logs.is_empty() {
            return Ok(None);
        }
        let wanted = Wanted {
            toml,
            logs: saved.logs.clone(),
            horizon_s: saved.horizon_s,
        };
        let known = || {
            self.evaluations
                .lock()
                .unwrap_or_else(PoisonError::into_inner)
        };
        if let Some((_, found)) = known().0.iter().find(|(key, _)| *key == wanted) {
            return Ok(Some(found.clone()));
        }
        let file = model_file(step);
        let made = Arc::new(self.evaluate(saved, &wanted.toml, &file)?);
        let mut known = known();
        known.0.insert(0, (wanted, made.clone()));
        known.0.truncate(KEPT);
        Ok(Some(made))
    }

    fn evaluate(&self, saved: &SavedSession, toml: &str, file: &Path) -> Result<Evaluation> {
        let model = Model::parse(toml, file)?;
        let split = self.split(saved, &model)?;
        let fitted = split.training.len();
        let motions = [split.training, split.held_out].concat();
        let horizon = Horizon::from_seconds(saved.horizon_s);
        let data = FitData::new(&model, motions, horizon);
        Ok(Evaluation {
            run: ModelRun::new(model, data, horizon),
            fitted,
            comparison: OnceLock::new(),
            failing: OnceLock::new(),
            name: file.display().to_string(),
        })
    }
}
