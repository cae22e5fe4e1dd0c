//! Whether `add` and `fit` leave no more than the diagnosis that recommended them, and whether
//! their intervals hold the truth.
//!
//! A rig hides one effect. It is diagnosed with that effect as the only candidate, the effect is
//! added over the windows of the diagnosis, and the values of the true model, up to 30 % off, are
//! fitted over the same. The logs are of equations that are not the library's.

use handstand::challenge::{Bench, READINGS, Readings, read_arm, read_pendulum};
use handstand::diagnose::{DiagnoseOptions, Diagnosis, FittedEffect, diagnose};
use handstand::effects::EFFECTS;
use handstand::fitting::{Candidate, FittedValue, Horizon, Refitted, refit, refit_with};
use handstand::log::{LogRequest, read};
use handstand::model::ParameterPath;
use handstand::motion::{Motion, Split};
use handstand::{Error, Model};
use rayon::prelude::*;
use serde::Serialize;
use std::path::Path;

/// What driven arms hide: friction, inertia, a spring, the drive.
pub const ARM_KINDS: [&str; 5] = [
    "stribeck",
    "armature",
    "cable_spring",
    "air_drag",
    "speed_limit",
];
/// A fit leaves no more than a diagnosis if it leaves no more than this many times it: the last
/// digit that is shown.
const NO_MORE: f64 = 1.001;

/// A rig whose logs are fitted.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct RefitCase {
    /// What a driven arm hides; a pendulum, which hides drag, without.
    pub arm: Option<&'static str>,
    /// How its readings err.
    pub readings: Readings,
    /// Its seed.
    pub seed: u64,
}

impl RefitCase {
    /// So many rigs: pendulums and arms in turn, in every way of reading.
    pub fn all(count: u64) -> Vec<RefitCase> {
        let case = |k: u64| {
            let (pair, kinds) = (k / 2, ARM_KINDS.len() as u64);
            RefitCase {
                arm: (k % 2 == 1).then(|| ARM_KINDS[(pair % kinds) as usize]),
                readings: READINGS[(pair % READINGS.len() as u64) as usize],
                seed: 1 + pair,
            }
        };
        (0..count).map(case).collect()
    }

    /// What it is, in words.
    pub fn name(&self) -> String {
        let rig = match self.arm {
            Some(kind) => format!("arm, {kind}"),
            None => "pendulum, air_drag".to_string(),
        };
        format!("{rig}, {}, seed {}", self.readings.name(), self.seed)
    }

    fn bench(&self) -> Bench {
        match self.arm {
            Some(kind) => read_arm(self.seed, kind, self.readings),
            None => read_pendulum(self.seed, self.readings),
        }
    }
}

/// A fitted value beside the true one.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct TriedValue {
    /// As fitted.
    #[serde(flatten)]
    pub fitted: FittedValue,
    /// As it is.
    pub truth: f64,
    /// Whether the interval holds the truth.
    pub holds: bool,
}

/// A fit beside the diagnosis.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct TriedFit {
    /// Error on the motions fitted, rad.
    pub fitted_rad: f64,
    /// Whether that is no more than the diagnosis leaves of them, where it found the effect.
    pub no_more: Option<bool>,
    /// Its values.
    pub values: Vec<TriedValue>,
}

/// What was found of a case.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct RefitOutcome {
    /// The case.
    pub case: String,
    /// Whether the rig is a pendulum.
    pub is_pendulum: bool,
    /// How its readings err.
    pub readings: &'static str,
    /// Error that the diagnosis leaves of the motions fitted, rad; none where it did not find the
    /// effect.
    pub diagnosed_rad: Option<f64>,
    /// Its values.
    pub diagnosed: Vec<TriedValue>,
    /// The floor, rad.
    pub floor_rad: f64,
    /// Error on the motions fitted that the true model leaves, its start states fitted, rad.
    pub truth_rad: f64,
    /// The effect added.
    pub added: Option<TriedFit>,
    /// The true model, its values off and fitted again.
    pub fitted: Option<TriedFit>,
}

/// Tries every case; failures are told with their case.
pub fn try_refits(
    cases: &[RefitCase],
    done: &(dyn Fn(&RefitOutcome) + Sync),
) -> Vec<Result<RefitOutcome, String>> {
    let tried = cases.par_iter().map(|case| {
        let outcome = try_refit(case).map_err(|error| format!("{}: {error}", case.name()))?;
        done(&outcome);
        Ok(outcome)
    });
    tried.collect()
}

/// Diagnoses, adds and fits.
///
/// # Errors
/// Files that cannot be written or are refused.
pub fn try_refit(case: &RefitCase) -> Result<RefitOutcome, Error> {
    let bench = case.bench();
    let hidden = &bench.effects[0];
    let dir = tempfile::tempdir().map_err(|error| Error::file("the logs", "make", error))?;
    let file = dir.path().join("model.toml");
    let model = Model::parse(&bench.model_toml, &file)?;
    let truth = Model::parse(&bench.true_model_toml, &file)?;
    let split = split(&bench, &model, dir.path())?;
    let others = EFFECTS.iter().map(|effect| effect.info().id);
    let options = DiagnoseOptions {
        without: others
            .filter(|id| *id != hidden.kind)
            .map(String::from)
            .collect(),
        most_effects: 1,
        ..DiagnoseOptions::default()
    };
    let (training, held_out) = (split.training.clone(), split.held_out.clone());
    let diagnosis = diagnose(&model, training, held_out, &options, &|_| {});
    let name = format!("{}@1", hidden.kind);
    let found_it = diagnosis.effects.len() == 1 && diagnosis.effects[0].address() == name;
    let diagnosed_rad = found_it.then(|| fitted_rad(&diagnosis, &split));
    let horizon = Some(Horizon::from_seconds(diagnosis.horizon_s));
    let tried = |refitted: Refitted| TriedFit {
        fitted_rad: refitted.fitted_rad[1],
        no_more: diagnosed_rad.map(|rad| refitted.fitted_rad[1] <= NO_MORE * rad),
        values: beside(&refitted.values, &truth),
    };
    let candidate = Candidate::named(&name, &model)?;
    let added = refit_with(&model, &[candidate], &split, horizon, &|_| {});
    let free: Vec<ParameterPath> =
        { model.free.iter().copied().chain(candidate.paths()) }.collect();
    let off = values_off(&truth, &model, &free);
    let fitted = refit(&off, &free, &split, horizon, &|_| {});
    let as_true = refit_errors(&truth, &split, horizon);
    Ok(RefitOutcome {
        case: case.name(),
        is_pendulum: case.arm.is_none(),
        readings: case.readings.name(),
        diagnosed_rad,
        diagnosed: if found_it {
            beside(&stated(&diagnosis), &truth)
        } else {
            Vec::new()
        },
        floor_rad: diagnosis.error.floor_rad,
        truth_rad: as_true,
        added: added.ok().map(tried),
        fitted: fitted.ok().map(tried),
    })
}

/// The motions, as the bench divides them.
fn split(bench: &Bench, model: &Model, dir: &Path) -> Result<Split, Error> {
    let mut split = Split::default();
    for log in &bench.logs {
        let path = dir.join(&log.name);
        std::fs::write(&path, &log.csv).map_err(|error| Error::file(&path, "write", error))?;
        let motions: Vec<Motion> = read(&[LogRequest::whole(path)], &model.log)?;
        if log.held_out {
            split.held_out.extend(motions)
        } else {
            split.training.extend(motions)
        }
    }
    Ok(split)
}

/// Error of a diagnosis on the motions fitted, rad.
fn fitted_rad(diagnosis: &Diagnosis, split: &Split) -> f64 {
    let motions = diagnosis.motions.iter().filter(|motion| !motion.held_out);
    let (mut squares, mut samples) = (0.0, 0.0);
    for (motion, log) in motions.zip(&split.training) {
        squares += log.len() as f64 * motion.after_rad.powi(2);
        samples += log.len() as f64;
    }
    (squares / samples).sqrt()
}

/// Error of a model as it is on the motions fitted, rad.
fn refit_errors(model: &Model, split: &Split, horizon: Option<Horizon>) -> f64 {
    let horizon = horizon.unwrap_or(Horizon::Whole);
    let data = handstand::fitting::FitProblem::new(model, split.training.clone(), horizon);
    handstand::fitting::fit_start_states(model, &data).rms(&data)
}

/// All values that a diagnosis states.
fn stated(diagnosis: &Diagnosis) -> Vec<FittedValue> {
    let own = |effect: &FittedEffect| effect.parameters.clone();
    let added = diagnosis.effects.iter().flat_map(own);
    diagnosis.base.iter().cloned().chain(added).collect()
}

/// Fitted values beside the true ones.
fn beside(values: &[FittedValue], truth: &Model) -> Vec<TriedValue> {
    let tried = values.iter().filter_map(|fitted| {
        let path: ParameterPath = fitted.path.parse().ok()?;
        let truth = path.get(truth)?;
        Some(TriedValue {
            holds: (fitted.low..=fitted.high).contains(&truth),
            fitted: fitted.clone(),
            truth,
        })
    });
    tried.collect()
}

/// The true model with the values that the owner believes in, and those of what is hidden 25 % off,
/// the other way from one value to the next.
fn values_off(truth: &Model, believed: &Model, free: &[ParameterPath]) -> Model {
    let mut off = truth.clone();
    for (k, path) in free.iter().enumerate() {
        let value = match (path.get(believed), path.get(truth)) {
            (Some(believed), _) => believed,
            (None, Some(truth)) if k % 2 == 0 => 1.25 * truth,
            (None, truth) => 0.75 * truth.unwrap_or_default(),
        };
        let (low, high) = path.bounds(&off);
        let known = path.set(&mut off, value.clamp(low, high));
        debug_assert!(known, "a free value is one of the true model's");
    }
    off
}
