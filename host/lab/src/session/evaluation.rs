//! The model of a step run along the session's motions, kept while it may be asked for again.

use super::LabSession;
use super::data::model_file;
use super::saved::{SavedLog, SavedSession};
use crate::compare::{Comparison, FailingSamples, ModelRun};
use crate::error::Result;
use crate::fitting::{FitProblem, Horizon};
use crate::model::{JointColumns, MeasuredSignal, Model};
use crate::output::number::{given, short};
use serde::Serialize;
use std::sync::{Arc, MutexGuard, OnceLock, PoisonError};

/// How many are kept: those of the steps and of some window lengths.
const KEPT: usize = 24;

/// A model run along all motions, as `handstand compare` runs it.
#[derive(Debug)]
pub struct SessionEvaluation {
    /// The run.
    pub run: ModelRun,
    /// Motions that are fitted; those after them are held out.
    pub fitted: usize,
    at_its_horizon: OnceLock<Comparison>,
    comparison: OnceLock<Comparison>,
    failing: OnceLock<Vec<FailingSamples>>,
    name: String,
}

impl SessionEvaluation {
    fn of(run: ModelRun, fitted: usize, name: String) -> SessionEvaluation {
        SessionEvaluation {
            run,
            fitted,
            at_its_horizon: OnceLock::new(),
            comparison: OnceLock::new(),
            failing: OnceLock::new(),
            name,
        }
    }

    /// The same model and motions in windows of another length.
    fn at(&self, horizon: Horizon) -> SessionEvaluation {
        let data = self.run.data.recut(horizon);
        let run = ModelRun::new(self.run.model.clone(), data, horizon);
        SessionEvaluation::of(run, self.fitted, self.name.clone())
    }

    /// The same in a fraction of the time, for a slider that moves: start states are fitted
    /// roughly.
    pub fn roughly_at(&self, horizon: Horizon) -> SessionEvaluation {
        let data = self.run.data.recut(horizon);
        let run = ModelRun::roughly(self.run.model.clone(), data, horizon);
        SessionEvaluation::of(run, self.fitted, self.name.clone())
    }

    /// The comparison without the errors over shorter runs, made when it is first asked for.
    pub fn at_its_horizon(&self) -> &Comparison {
        self.at_its_horizon
            .get_or_init(|| self.run.at_its_horizon(&self.name))
    }

    /// The comparison, made when it is first asked for.
    pub fn comparison(&self) -> &Comparison {
        self.comparison
            .get_or_init(|| self.run.comparison(&self.name))
    }

    /// The conditions under which the model fails, with their samples.
    pub fn failing(&self) -> &[FailingSamples] {
        self.failing.get_or_init(|| self.run.failing())
    }

    /// Root-mean-square error, all joints and motions together, rad or rad/s.
    pub fn rms(&self) -> f64 {
        pooled_rms(&self.run)
    }

    /// What noise and resolution alone leave, rad or rad/s.
    pub fn floor(&self) -> f64 {
        self.run.data.floor()
    }

    /// What the errors are of.
    pub fn quantity(&self) -> MeasuredSignal {
        self.run.data.quantity()
    }

    /// The unit in which people read a joint's values.
    pub fn shown(&self, joint: usize) -> ShownUnit {
        ShownUnit::of(
            self.run.data.signals[joint],
            self.run.model.log.joints[joint].in_degrees(),
        )
    }

    /// The unit in which people read the errors of all joints together.
    pub fn shown_error(&self) -> ShownUnit {
        ShownUnit::of_errors(self.quantity(), &self.run.model)
    }

    /// An error of all joints together as people read it.
    pub fn in_words(&self, error: f64) -> String {
        self.shown_error().error_words(error)
    }

    /// How long the model ran: "over whole motions", "over 0.25 s".
    pub fn over(&self) -> String {
        over(self.run.horizon)
    }

    /// Whether a motion is held out.
    pub fn is_held_out(&self, motion: usize) -> bool {
        motion >= self.fitted
    }
}

/// How long models run, in words.
pub fn over(horizon: Horizon) -> String {
    match horizon {
        Horizon::Whole => "over whole motions".into(),
        Horizon::Seconds(seconds) => format!("over {} s", given(seconds)),
    }
}

/// The unit in which people read values: degrees where the log has degrees.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct ShownUnit {
    /// Of values.
    pub unit: &'static str,
    /// How many of them one SI unit is.
    pub per_si: f64,
    /// Of errors.
    pub error_unit: &'static str,
    /// How many of those one SI unit is.
    pub error_per_si: f64,
}

impl ShownUnit {
    /// The unit of the errors of all joints together.
    pub fn of_errors(quantity: MeasuredSignal, model: &Model) -> ShownUnit {
        ShownUnit::of(quantity, in_degrees(model))
    }

    fn of(signal: MeasuredSignal, degrees: bool) -> ShownUnit {
        let unit = match signal {
            MeasuredSignal::Angle if degrees => "deg",
            MeasuredSignal::Rate if degrees => "deg/s",
            _ => {
                return ShownUnit {
                    unit: signal.unit(),
                    per_si: 1.0,
                    error_unit: signal.milli(),
                    error_per_si: 1e3,
                };
            }
        };
        let per_si = 1f64.to_degrees();
        ShownUnit {
            unit,
            per_si,
            error_unit: unit,
            error_per_si: per_si,
        }
    }

    /// A number with its unit.
    pub fn error_words(&self, error: f64) -> String {
        format!("{} {}", short(self.error_per_si * error), self.error_unit)
    }
}

/// Whether all joints are logged in degrees.
pub fn in_degrees(model: &Model) -> bool {
    model.log.joints.iter().all(JointColumns::in_degrees)
}

/// Root-mean-square error over the joints whose errors count together, as the bars of a report
/// have it.
pub fn pooled_rms(run: &ModelRun) -> f64 {
    let joints = run.joint_rms().into_iter().enumerate();
    let counted = joints.filter(|(joint, _)| run.data.counts(*joint));
    let squares: Vec<f64> = counted.map(|(_, rms)| rms * rms).collect();
    (squares.iter().sum::<f64>() / squares.len().max(1) as f64).sqrt()
}

/// What an evaluation depends on.
#[derive(Debug, Clone, PartialEq)]
struct EvaluationKey {
    toml: String,
    logs: Vec<SavedLog>,
    horizon: Horizon,
}

/// The last evaluations.
#[derive(Debug, Default)]
pub(super) struct Evaluations(Vec<(EvaluationKey, Arc<SessionEvaluation>)>);

impl LabSession {
    /// The step's model along the session's motions; nothing without model or logs.
    ///
    /// # Errors
    /// Logs that cannot be read.
    pub fn evaluation(
        &self,
        saved: &SavedSession,
        step: usize,
    ) -> Result<Option<Arc<SessionEvaluation>>> {
        let Some(wanted) = wanted(saved, step) else {
            return Ok(None);
        };
        if let Some(found) = self.kept(&wanted) {
            return Ok(Some(found));
        }
        let making = self.evaluating.lock();
        let _making = making.unwrap_or_else(PoisonError::into_inner);
        if let Some(found) = self.kept(&wanted) {
            return Ok(Some(found));
        }
        let made = match self.kept_at_another_horizon(&wanted) {
            Some(known) => known.at(wanted.horizon),
            None => self.evaluate(saved, &wanted.toml, step)?,
        };
        let made = Arc::new(made);
        let mut known = self.known();
        known.0.insert(0, (wanted, made.clone()));
        known.0.truncate(KEPT);
        Ok(Some(made))
    }

    /// The evaluation of the step in force, if it was made already: pages that only mention it
    /// do not wait for it.
    pub fn known_evaluation(&self, saved: &SavedSession) -> Option<Arc<SessionEvaluation>> {
        self.kept(&wanted(saved, saved.current)?)
    }

    fn kept(&self, wanted: &EvaluationKey) -> Option<Arc<SessionEvaluation>> {
        let known = self.known();
        let found = known.0.iter().find(|(key, _)| key == wanted);
        found.map(|(_, evaluation)| evaluation.clone())
    }

    /// An evaluation of the same model and logs, whose motions need not be read again.
    fn kept_at_another_horizon(&self, wanted: &EvaluationKey) -> Option<Arc<SessionEvaluation>> {
        let known = self.known();
        let same = |key: &EvaluationKey| key.toml == wanted.toml && key.logs == wanted.logs;
        let found = known.0.iter().find(|(key, _)| same(key));
        found.map(|(_, evaluation)| evaluation.clone())
    }

    fn known(&self) -> MutexGuard<'_, Evaluations> {
        self.evaluations
            .lock()
            .unwrap_or_else(PoisonError::into_inner)
    }

    fn evaluate(&self, saved: &SavedSession, toml: &str, step: usize) -> Result<SessionEvaluation> {
        let model = Model::parse(toml, &self.model_path(step))?;
        let split = match self.take_motions(saved, &model) {
            Some(split) => split,
            None => self.split(saved, &model)?,
        };
        let fitted = split.training.len();
        let motions = [split.training, split.held_out].concat();
        let horizon = saved.horizon();
        let data = FitProblem::new(&model, motions, horizon);
        let run = ModelRun::new(model, data, horizon);
        Ok(SessionEvaluation::of(
            run,
            fitted,
            model_file(step).display().to_string(),
        ))
    }
}

fn wanted(saved: &SavedSession, step: usize) -> Option<EvaluationKey> {
    let step = saved.steps.get(step).filter(|_| !saved.logs.is_empty())?;
    Some(EvaluationKey {
        toml: step.toml.clone(),
        logs: saved.logs.clone(),
        horizon: saved.horizon(),
    })
}
