//! Motions for the drives of a model of which there are no logs yet.

use super::candidates::{can_be_moved, experiment, plan};
use super::condition::Condition;
use super::limits::ExperimentLimits;
use super::prediction::predicted_motion;
use crate::error::{Error, Result};
use crate::excite::{Excitation, ExcitationKind, excite};
use crate::model::{Drive, Model};
use crate::motion::Motion;
use crate::output::number::percent;

/// Shares of the ranges that are tried, the widest first.
const WIDTHS: [f64; 6] = [0.85, 0.6, 0.45, 0.3, 0.2, 0.1];

/// Motions that a model stays within its limits on.
#[derive(Debug, Clone, PartialEq)]
pub struct FirstMotions {
    /// Goals of the joints that move; a joint's servo is its number, counted from 1.
    pub excitation: Excitation,
    /// Share of the ranges that they use.
    pub width: f64,
    /// Times, inputs, and what the model predicts.
    pub motion: Motion,
}

/// The widest motions of these kinds, each of `each_s`, on which the model stays within the limits.
///
/// # Errors
/// A model that nothing drives, limits that no motion can be held in, or that the model leaves
/// however small its motions are.
pub fn first_motions(
    model: &Model,
    limits: &ExperimentLimits,
    (kinds, each_s): (&[ExcitationKind], f64),
    band_hz: (f64, f64),
    seed: u64,
) -> Result<FirstMotions> {
    can_be_moved(model)?;
    limits.check(model)?;
    let allowed = limits.catching_up(model);
    let mut refused = None;
    for width in WIDTHS {
        let mut planned = plan(model, limits, width, kinds.to_vec(), seed);
        (planned.each_s, planned.band_hz) = (each_s, band_hz);
        let excitation = match excite(&planned) {
            Ok(excitation) => excitation,
            Err(why) => {
                refused = Some(why);
                continue;
            }
        };
        let asked = experiment(model, (width, &excitation), Condition::default(), limits);
        let motion = predicted_motion(model, &asked);
        let Some(broken) = allowed.broken_by(model, &motion) else {
            return Ok(FirstMotions {
                excitation,
                width,
                motion,
            });
        };
        refused = Some(Error::usage(
            format!(
                "even over {} of the ranges the model {broken}",
                percent(width)
            ),
            remedy(model),
        ));
    }
    Err(refused.unwrap_or_else(|| Error::usage("no motion is asked for", "name kinds of motion")))
}

fn remedy(model: &Model) -> String {
    let clear = if model.is_in_space() {
        "give ranges about a pose that is clear by --angles, one for each joint, another --speed, \
         or where the floor is by --floor"
    } else {
        "give other ranges by --angles, another --speed, or fewer kinds by --motions"
    };
    let mut drives = model.joints.iter().map(|joint| &joint.drive);
    // Torques that were found with a regulator play without one, and small errors grow.
    let takes_torque = |drive: &Drive| matches!(drive, Drive::Torque | Drive::Duty(_));
    if drives.any(takes_torque) {
        return format!(
            "{clear}; torques play in open loop, so that little time and friction in the model \
             help, and servos that take goals are `drive = \"position\"`"
        );
    }
    clear.to_string()
}
