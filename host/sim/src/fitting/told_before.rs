//! What a slow drive was told before its log begins: where a fit looks for it first.
//!
//! A drive that had long been told its first input obeys that at once. There the derivative by what
//! it was told is nothing, so a fit would never leave it.

use super::data::FitProblem;
use super::fit::Fit;
use super::residual::residuals;
use crate::model::Drive;
use crate::sim::{HiddenQuantity, HiddenUnknown};

/// Begins each motion with what leaves least: its drives were told the same before, nothing, or, of
/// goals, to stand where they stand.
pub(super) fn begin_as_told(fit: &mut Fit, data: &FitProblem, hidden: &[HiddenUnknown]) {
    let unknowns = hidden.iter().enumerate();
    let slow: Vec<(usize, usize)> = unknowns
        .filter(|(_, unknown)| unknown.quantity == HiddenQuantity::Before { is_slow: true })
        .map(|(at, unknown)| (3 * data.joints() + at, unknown.joint))
        .collect();
    if slow.is_empty() {
        return;
    }
    let standing = |motion, joint| standing(fit, data, motion, joint);
    let nothing = |_, _| -1.0;
    let told: [&dyn Fn(usize, usize) -> f64; 2] = [&nothing, &standing];
    let trials = told.map(|told| {
        let mut starts = fit.window_starts.clone();
        for motion in 0..data.motions.len() {
            for (index, _) in data.windows_of(motion).take(1) {
                for &(at, joint) in &slow {
                    starts[index].unknowns[at] = told(motion, joint);
                }
            }
        }
        let left = residuals(&fit.model, data, &starts);
        (starts, left)
    });
    for (starts, left) in trials {
        for motion in 0..data.motions.len() {
            let windows: Vec<usize> = data.windows_of(motion).map(|(index, _)| index).collect();
            let square = |residuals: &[Vec<f64>]| -> f64 {
                let values = windows.iter().flat_map(|&index| &residuals[index]);
                values.map(|value| value * value).sum()
            };
            if square(&left.windows) < square(&fit.residuals.windows) {
                for &index in &windows {
                    fit.window_starts[index] = starts[index].clone();
                    fit.residuals.windows[index].clone_from(&left.windows[index]);
                }
            }
        }
        fit.simulations += 1;
    }
}

/// What a goal is where the joint stands as its log begins, as a share of the first goal, less 1;
/// the same where the drive has no goals of angle.
fn standing(fit: &Fit, data: &FitProblem, motion: usize, joint: usize) -> f64 {
    let motion = &data.motions[motion];
    let first = |values: &[f64]| values.first().copied().filter(|value| value.is_finite());
    let here = first(&motion.position_rad[joint]);
    let goal = motion.input[joint].as_deref().and_then(first);
    match (&fit.model.joints[joint].drive, here, goal) {
        (Drive::Position { .. }, Some(here), Some(goal)) if goal != 0.0 => {
            (here / goal - 1.0).clamp(-1.0, 1.0)
        }
        _ => 0.0,
    }
}
