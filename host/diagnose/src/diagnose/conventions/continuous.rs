//! Corrections with a free number: a zero that lies elsewhere, a column that is shifted in time.

use super::correction::{Correction, LogColumn, is_regulated};
use super::search::is_long;
use super::trial::{CorrectionTrial, Effort, Trial};
use crate::log::LEAST_ROWS;
use crate::model::Model;
use crate::motion::Motion;
use rayon::prelude::*;
use std::f64::consts::{PI, TAU};

/// Zeros tried around a turn.
const ZEROS: usize = 24;
/// A zero this near to the given one may be a tilted base, a bent link or a calibration, which the
/// diagnosis finds, rad.
const LEAST_ZERO_RAD: f64 = 0.25;
/// The same of a servo within an arm of many joints, rad: a base that leans turns every link, and a
/// bent link is another zero to whoever uses the arm. Below, where friction holds a servo decides.
const LEAST_CALIBRATION_RAD: f64 = 0.07;
/// Shifts tried, in steps of a sample or of this, s, on each side.
const SHIFT_STEPS: i32 = 6;
const LEAST_STEP_S: f64 = 0.02;
/// Steps of a refinement, each of which leaves 0.62 of the interval.
const REFINEMENTS: usize = 7;

/// Whether a zero lies so far from the given one that a wrong one is likelier than anything else.
pub(super) fn is_far(model: &Model, zero: &Correction, added: f64) -> bool {
    let is_within = zero.calibrates().is_some_and(|joint| joint > 0);
    let least = if is_within && is_long(model) {
        LEAST_CALIBRATION_RAD
    } else {
        LEAST_ZERO_RAD
    };
    added.abs() > least
}

/// The best zero of each joint's angle, and the best shift of each column against the others.
pub(super) fn continuous(bench: &CorrectionTrial) -> Vec<Correction> {
    let model = &bench.model;
    let mut found = Vec::new();
    for joint in 0..model.link_count() {
        let position = LogColumn::Position(joint);
        if position.column(model).is_some() {
            if is_regulated(model, joint) {
                found.extend(zero(bench, &[position, LogColumn::Input(joint)]));
            }
            found.extend(zero(bench, &[position]));
        }
    }
    let joints = 0..model.link_count();
    let inputs = joints.clone().map(LogColumn::Input);
    let several = model.link_count() > 1;
    let positions = joints.filter(|_| several).map(LogColumn::Position);
    let columns = inputs
        .chain(positions)
        .filter(|column| bench.varies(*column));
    found.extend(columns.filter_map(|column| shift(bench, column)));
    found
}

fn zero(bench: &CorrectionTrial, columns: &[LogColumn]) -> Option<Correction> {
    let step = TAU / ZEROS as f64;
    let added = (1..ZEROS).map(|i| step * i as f64 - if 2 * i > ZEROS { TAU } else { 0.0 });
    let best = best(bench, added.collect(), step, |added| {
        Correction::Offset(columns.to_vec(), added)
    })?;
    let Correction::Offset(_, added) = best.correction else {
        return None;
    };
    let off = (added + PI).rem_euclid(TAU) - PI;
    is_far(&bench.model, &best.correction, off).then_some(best.correction)
}

/// The best shift of a column in time, if one lowers the error.
pub(super) fn shift(bench: &CorrectionTrial, quantity: LogColumn) -> Option<Correction> {
    let given = quantity.column(&bench.model)?.shift_s;
    let samples: usize = bench.motions.iter().map(|m| m.len()).sum();
    let seconds: f64 = bench.motions.iter().map(|m| m.duration_s()).sum();
    let step = LEAST_STEP_S.max(seconds / samples.max(1) as f64);
    // A refinement goes one step further than the shift that it refines.
    let leaves_samples = |i: &i32| {
        let moved_s = step * f64::from(i.abs() + 1);
        bench.motions.iter().all(|motion| spares(motion, moved_s))
    };
    let steps = (-SHIFT_STEPS..=SHIFT_STEPS).filter(|i| *i != 0 && leaves_samples(i));
    let shifts = steps.map(|i| given + step * f64::from(i)).collect();
    let best = best(bench, shifts, step, |shift_s| {
        Correction::Shift(quantity, shift_s)
    })?;
    Some(best.correction)
}

/// Whether a motion that loses so many seconds at either end is still one.
fn spares(motion: &Motion, seconds: f64) -> bool {
    let Some(last_s) = motion.time_s.last() else {
        return false;
    };
    let kept = motion.time_s.iter().filter(|t| **t <= last_s - seconds);
    kept.count() >= LEAST_ROWS
}

/// The best of some values, refined within a step of it by golden section.
fn best(
    bench: &CorrectionTrial,
    values: Vec<f64>,
    step: f64,
    correction: impl Fn(f64) -> Correction + Sync,
) -> Option<Trial> {
    let tried = |value: f64| bench.tried(correction(value), Effort::Guess);
    let by_ratio = |a: &(f64, Trial), b: &(f64, Trial)| a.1.ratio().total_cmp(&b.1.ratio());
    let trials = values
        .into_par_iter()
        .filter_map(|value| Some((value, tried(value)?)));
    let (middle, mut found) = trials.min_by(by_ratio)?;
    if found.ratio() >= 1.0 {
        return None;
    }
    let golden = 0.5 * (5.0_f64.sqrt() - 1.0);
    let (mut low, mut high) = (middle - step, middle + step);
    for _ in 0..REFINEMENTS {
        let (a, b) = (high - golden * (high - low), low + golden * (high - low));
        let (first, second) = rayon::join(|| tried(a), || tried(b));
        let (first, second) = (first?, second?);
        if first.ratio() < second.ratio() {
            high = b
        } else {
            low = a
        }
        for trial in [first, second] {
            if trial.ratio() < found.ratio() {
                found = trial;
            }
        }
    }
    Some(found)
}

#[cfg(test)]
mod tests {
    use super::*;
    use handstand_model::fixture::{columns, model, motion, position_drive};

    #[test]
    fn a_motion_shorter_than_every_shift_is_shifted_by_none() {
        let mut short = motion("short", 800);
        short.time_s.iter_mut().for_each(|t| *t *= 1e-5);
        let bench = CorrectionTrial::new(&model(position_drive(), columns()), vec![short]);
        let shifts = continuous(&bench).into_iter();
        let shifts = shifts.filter(|correction| matches!(correction, Correction::Shift(..)));
        assert_eq!(shifts.collect::<Vec<_>>(), []);
    }
}
