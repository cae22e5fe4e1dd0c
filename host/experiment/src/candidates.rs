//! The experiments that are simulated: every kind of motion, alone and all together, wide and
//! narrow, under every condition.

use super::condition::{Condition, payload_at_m};
use super::inputs::{Goals, asked};
use super::limits::ExperimentLimits;
use crate::error::{Error, Result};
use crate::excite::{
    EXCITATION_KINDS, Excitation, ExcitationKind, ExcitePlan, JointLimits, excite,
};
use crate::model::Model;
use crate::motion::Motion;
use rayon::prelude::*;

/// Shares of the ranges that motions use. The limits are for what the rig does: goals stay inside.
const WIDTHS: [f64; 3] = [0.85, 0.6, 0.3];
/// Share of the fastest speed that goals use.
const SPEED: f64 = 0.7;
/// No servo reaches more, rad and rad/s: see [`JointLimits::check`].
const SERVO: (f64, f64) = (2.6, 6.18);
/// Seconds for rests between the kinds of a motion.
const RESTS_S: f64 = 0.5;
/// Band of multisines, Hz, as far as the rate of samples allows.
const BAND_HZ: (f64, f64) = (0.2, 3.0);

/// An experiment: inputs over time, under a condition.
#[derive(Debug, Clone)]
pub(super) struct Experiment {
    pub kinds: Vec<ExcitationKind>,
    /// Share of the ranges that its goals use.
    pub width: f64,
    pub condition: Condition,
    /// Angles at which it begins at rest, rad in the log's convention.
    pub start_rad: Vec<f64>,
    /// Times and inputs; nothing is measured yet.
    pub motion: Motion,
}

impl Experiment {
    /// What it asks of a person and of the rig, the least first.
    pub fn effort(&self) -> (usize, usize) {
        (self.condition.changes(), self.kinds.len())
    }
}

/// Whether a motion can be asked of a rig.
///
/// # Errors
/// None of its joints is driven.
pub fn can_be_moved(model: &Model) -> Result<()> {
    if !model.driven_joints().is_empty() {
        return Ok(());
    }
    Err(Error::usage(
        format!(
            "no joint of `{}` is driven, so no motion can be asked of it",
            model.name
        ),
        "let it swing by hand from other angles, or with a known mass on the last link",
    ))
}

/// All experiments within the limits; `model` is the explanation that tracks the goals.
///
/// # Errors
/// Limits that no motion can be held in; as [`can_be_moved`].
pub(super) fn experiments(
    model: &Model,
    limits: &ExperimentLimits,
    added_kg: f64,
    seed: u64,
) -> Result<Vec<Experiment>> {
    can_be_moved(model)?;
    limits.check(model)?;
    let mut planned: Vec<(f64, Excitation)> = Vec::new();
    let mut refused = None;
    for width in WIDTHS {
        let singles = EXCITATION_KINDS.map(|kind| vec![kind]);
        for kinds in singles.into_iter().chain([EXCITATION_KINDS.to_vec()]) {
            match excite(&plan(model, limits, width, kinds, seed)) {
                Ok(excitation) => planned.push((width, excitation)),
                Err(why) => refused = Some(why),
            }
        }
    }
    if let (true, Some(why)) = (planned.is_empty(), refused) {
        return Err(why);
    }
    let conditions = Condition::all(model, added_kg);
    let pairs = planned.iter().flat_map(|planned| {
        let conditions = conditions.iter();
        conditions.map(move |condition| (planned, *condition))
    });
    let pairs: Vec<(&(f64, Excitation), Condition)> = pairs.collect();
    let all = pairs
        .into_par_iter()
        .map(|((width, excitation), condition)| {
            experiment(model, (*width, excitation), condition, limits)
        });
    Ok(all.collect())
}

/// These goals as inputs of the model's drives, under a condition.
pub(super) fn experiment(
    model: &Model,
    (width, excitation): (f64, &Excitation),
    condition: Condition,
    limits: &ExperimentLimits,
) -> Experiment {
    let goals = Goals {
        excitation,
        condition,
    };
    let (motion, start_rad) = asked(model, &goals, limits);
    let kinds = excitation.motions.iter().map(|motion| motion.kind);
    Experiment {
        kinds: kinds.collect(),
        width,
        condition,
        start_rad,
        motion,
    }
}

/// A plan for the driven joints that may move. The servos' numbers only keep them apart.
pub(super) fn plan(
    model: &Model,
    limits: &ExperimentLimits,
    width: f64,
    kinds: Vec<ExcitationKind>,
    seed: u64,
) -> ExcitePlan {
    let joints = limits.moved(model).into_iter().map(|joint| {
        let (low, high) = (limits.low_rad[joint], limits.high_rad[joint]);
        let (middle, half) = (0.5 * (low + high), 0.5 * width * (high - low));
        JointLimits {
            servos: vec![joint as u8 + 1],
            low_rad: (middle - half).max(-SERVO.0),
            high_rad: (middle + half).min(SERVO.0),
            speed_rad_s: (SPEED * limits.speed_rad_s[joint]).min(SERVO.1),
        }
    });
    let count = kinds.len() as f64;
    let rests = RESTS_S * (count + 1.0);
    ExcitePlan {
        joints: joints.collect(),
        each_s: (limits.seconds - rests) / count,
        kinds,
        hz: limits.hz,
        band_hz: (BAND_HZ.0, BAND_HZ.1.min(0.1 * limits.hz)),
        seed,
    }
}

/// A model whose payload sits where an experiment bolts it on.
pub(super) fn with_payload_place(model: &Model) -> Model {
    let mut model = model.clone();
    model.log.payload_at_m = payload_at_m(&model);
    model
}
