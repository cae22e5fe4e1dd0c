//! Looks for the corrections that clearly lower the error, one after another.

use super::continuous::{continuous, shift};
use super::correction::{Correction, LogColumn, alternatives, time_units};
use super::drives::drives;
use super::leave_out::without_stalled;
use super::plain_friction::rivals_friction;
use super::rating::ModelReading;
use super::threshold::least;
use super::travel::units_of_travel;
use super::trial::{CorrectionTrial, Effort, Trial, scales_torque_by};
use super::zero::{self, FittedZero};
use crate::fitting::coarsened;
use crate::model::{Column, Model, Unit};
use crate::motion::{Motion, excerpts};
use rayon::prelude::*;
use std::collections::BTreeMap;

/// Joints of a short chain. How errors grow in a reading takes twice as many runs as there are
/// joints, a run goes with their number, and so do the corrections: of a long chain a trial must do
/// with fewer samples and what those runs cost must be spared.
pub(super) const SHORT_CHAIN: usize = 4;

/// Whether a model's chain is long.
pub(super) fn is_long(model: &Model) -> bool {
    model.link_count() > SHORT_CHAIN
}

/// Of so many samples those that a chain as long as the model's is judged on.
pub(super) fn affordable(samples: usize, model: &Model) -> usize {
    let joints = model.link_count().max(SHORT_CHAIN);
    samples * SHORT_CHAIN.pow(3) / joints.pow(3)
}

/// Samples looked at with each correction, and with each of the many values of a continuous one.
pub(super) const SAMPLES: usize = 6000;
const SAMPLES_CONTINUOUS: usize = 2000;
/// Corrections that are judged with fitted start states.
const JUDGED: usize = 6;
/// Units of the same columns among them: of an input that hardly matters each that makes it small
/// does well, and of an angle several counts per turn may.
const UNITS: usize = 2;
/// An error ratio this high, from guessed start states, is not looked at again.
const HOPELESS: f64 = 1.05;
/// The same of a long chain, where it takes much to look again.
const HOPELESS_LONG: f64 = 0.9;
/// Faults that one log may have at once.
const ROUNDS: usize = 3;

/// A fault with its correction, and others that do as well.
#[derive(Debug, Clone, PartialEq)]
pub struct LogFault {
    /// The best correction.
    pub trial: Trial,
    /// Corrections that lower the error as far.
    pub rivals: Vec<Trial>,
    /// Where the best moves a zero, the zero to the end.
    pub zero: Option<FittedZero>,
}

impl LogFault {
    /// With its zero fitted, if it is one.
    fn with_zero(mut self, model: &Model, motions: &[Motion]) -> LogFault {
        self.zero = zero::fitted(&self.trial.correction, model, motions);
        if let (Some(zero), Correction::Offset(_, added)) = (self.zero, &mut self.trial.correction)
        {
            *added = zero.added;
        }
        self
    }
}

/// The faults found, each with those before it mended.
pub fn search(model: &Model, motions: &[Motion]) -> Vec<LogFault> {
    let mut found = Vec::new();
    let (mut model, mut motions) = (model.clone(), motions.to_vec());
    for _ in 0..ROUNDS {
        // A run that failed proves nothing: what the log holds besides is judged.
        let judged = if is_doubtful_time(&model, &motions) {
            motions.clone()
        } else {
            without_stalled(&model, &motions)
        };
        let Some(fault) = fault(&model, &judged) else {
            break;
        };
        let fault = fault.with_zero(&model, &judged);
        let correction = &fault.trial.correction;
        motions = correction.reread(&model, &motions);
        model = correction.applied(&model);
        found.push(fault);
    }
    found
}

/// The correction that lowers the error most, if it does so clearly.
fn fault(model: &Model, motions: &[Motion]) -> Option<LogFault> {
    let doubtful = time_units(model, spacing_s(motions));
    let mut clear = if doubtful.is_empty() {
        plausible_time(model, motions)
    } else {
        // Few samples: as declared, each may last a thousand integration steps.
        let few = excerpts(motions, affordable(SAMPLES_CONTINUOUS, model));
        let bench = CorrectionTrial::of_doubtful_time(model, few);
        let doubtful = doubtful.into_iter();
        let trials = doubtful.filter_map(|correction| bench.tried(correction, Effort::Guess));
        trials.filter(|trial| trial.ratio() < 1.0).collect()
    };
    let merit = |trial: &Trial| trial.after * likelier(model, trial);
    clear.sort_by(|a, b| merit(a).total_cmp(&merit(b)));
    let mut clear = clear.into_iter();
    let trial = clear.next()?;
    let counts = columns_in_other_units(&trial.correction);
    let rivals = clear.filter(|rival| {
        let alike = counts.is_some() && columns_in_other_units(&rival.correction) == counts;
        let as_good = if alike { ALIKE } else { AS_GOOD };
        merit(rival) < as_good * merit(&trial)
    });
    Some(LogFault {
        rivals: rivals.collect(),
        trial,
        zero: None,
    })
}

/// By what the error that a correction leaves is multiplied before the best is chosen. Where a
/// free number gains but little more, one of a few alternatives is likelier, and so is a unit whose
/// tick is the step that the file says the sensor has.
fn likelier(model: &Model, trial: &Trial) -> f64 {
    match &trial.correction {
        correction if correction.is_continuous() => 1.0 / FREE_NUMBER,
        Correction::Unit(columns) if counts_by_known_steps(model, columns) => 1.0 / ALIKE,
        _ => 1.0,
    }
}

/// Whether a column's new unit is a tick as large as the file's step of that column.
fn counts_by_known_steps(model: &Model, columns: &[(LogColumn, Unit)]) -> bool {
    columns.iter().any(|(quantity, unit)| {
        let step = quantity.column(model).and_then(|column| column.resolution);
        unit.name == "ticks" && step.is_some_and(|step| (step / unit.si - 1.0).abs() < SAME_STEP)
    })
}

/// The columns that a correction reads in other units; none where it does not.
fn columns_in_other_units(correction: &Correction) -> Option<Vec<LogColumn>> {
    match correction {
        Correction::Unit(columns) => Some(columns.iter().map(|(column, _)| *column).collect()),
        _ => None,
    }
}

/// Steps that differ by a smaller share are the same: files write them rounded.
const SAME_STEP: f64 = 1e-3;
/// Units of the same columns whose errors differ by less are the same: a scale of 2 % is what
/// friction that is off by a third does to a joint that gravity does not turn.
const ALIKE: f64 = 2.0;
/// How much less error a free number must leave than an alternative without one.
const FREE_NUMBER: f64 = 0.7;
/// Errors that differ by less are the same.
const AS_GOOD: f64 = 1.15;

fn plausible_time(model: &Model, motions: &[Motion]) -> Vec<Trial> {
    let few = excerpts(motions, affordable(SAMPLES_CONTINUOUS, model));
    let few = ModelReading::new(model.clone(), few);
    let given = &coarsened(model, &few.data);
    let clear = clear_corrections(given, motions, &few.data.motions);
    if !clear.is_empty() || !is_long(model) || model.free.is_empty() {
        return clear;
    }
    // Friction that is off hides a zero of a regulated joint. Of a long chain values are not
    // fitted for each correction, but once.
    let (_, fitted) = few.fitted(Effort::Values);
    clear_corrections(&coarsened(&fitted, &few.data), motions, &few.data.motions)
}

/// The corrections that clearly lower the error of a model with these values.
fn clear_corrections(model: &Model, motions: &[Motion], few: &[Motion]) -> Vec<Trial> {
    let bench = CorrectionTrial::new(model, excerpts(motions, affordable(SAMPLES, model)));
    let mut corrections = alternatives(model, motions);
    // A joint that whirls as it is read spoils every other comparison, and takes long to run.
    let clear = judged(&bench, units_of_travel(&corrections, motions));
    if !clear.is_empty() {
        return clear;
    }
    let few = CorrectionTrial::new(model, few.to_vec());
    if is_long(model) {
        // What a wrong value or friction may do as well takes fits of all values to tell.
        corrections.retain(|c| strength_of(c).is_none() && rivals_friction(c).is_none());
    } else {
        corrections.extend(drives(&few));
    }
    corrections.extend(continuous(&few));
    judged(&bench, corrections)
}

/// Those of the corrections that clearly lower the error.
fn judged(bench: &CorrectionTrial, corrections: Vec<Correction>) -> Vec<Trial> {
    let is_long = is_long(&bench.model);
    let hopeless = if is_long { HOPELESS_LONG } else { HOPELESS };
    let screened = corrections.into_par_iter();
    let mut screened: Vec<Trial> = screened
        .filter_map(|correction| bench.tried(correction, Effort::Guess))
        .filter(|trial| trial.ratio() < hopeless)
        .collect();
    let merit = |trial: &Trial| trial.ratio() * likelier(&bench.model, trial);
    screened.sort_by(|a, b| merit(a).total_cmp(&merit(b)));
    let refitted = most_promising(screened)
        .into_par_iter()
        .filter_map(|trial| {
            // The file's free values are a start: each reading is judged with those that suit it.
            let fitted = if is_long {
                Effort::Starts
            } else {
                Effort::Values
            };
            bench.tried(trial.correction, fitted)
        });
    let refitted: Vec<Trial> = refitted.collect();
    let is_allowed = |trial: &&Trial| {
        let is_another_drive = matches!(trial.correction, Correction::Drive(..));
        let suits = trial.ratio() < MOST_OF_ANOTHER_DRIVE || trial.after < LITTLE;
        let does_as_given = || {
            let given = bench.tried(trial.correction.clone(), Effort::Starts);
            given.is_some_and(|given| given.ratio() < 1.0)
        };
        least(bench, &trial.correction).allows(trial)
            && (!is_another_drive || suits)
            && (is_long || does_as_given())
    };
    let allowed = refitted.par_iter().filter(is_allowed).cloned();
    let mut judged: Vec<Trial> = allowed.collect();
    let (mut off, mut rubbing) = (BTreeMap::new(), BTreeMap::new());
    judged.retain(|trial| beats_a_wrong_value(bench, trial, &mut off));
    judged.retain(|trial| beats_friction(bench, trial, &mut rubbing));
    judged.retain(|trial| beats_a_delay(bench, trial));
    let also = better_calibrations(&judged, &refitted);
    judged.extend(also);
    judged
}

/// Other calibrations, of the trials, that leave less in all joints together than one which shows
/// in its own joint alone: mirrored at its base, an arm moves as if its last joint were reversed,
/// and what one servo's zero does another's may do in part.
fn better_calibrations(judged: &[Trial], refitted: &[Trial]) -> Vec<Trial> {
    let alone = judged.iter().filter(|trial| trial.own.is_some());
    let Some(most) = alone.map(|trial| trial.after).max_by(f64::total_cmp) else {
        return Vec::new();
    };
    let others = refitted.iter().filter(|other| {
        let calibrates = other.correction.calibrates().is_some();
        calibrates && other.after < most && !judged.contains(other)
    });
    others.cloned().collect()
}

/// The first of the sorted trials, of units of the same columns no more than a few.
fn most_promising(sorted: Vec<Trial>) -> Vec<Trial> {
    let mut kept: Vec<Trial> = Vec::new();
    for trial in sorted {
        let own = columns_in_other_units(&trial.correction);
        let alike = kept
            .iter()
            .filter(|kept| columns_in_other_units(&kept.correction) == own);
        let alike = alike.count();
        if own.is_none() || alike < UNITS {
            kept.push(trial);
        }
    }
    kept.truncate(JUDGED);
    kept
}

/// What the file's own motor lacks (a limit of its speed, a protection) may make another drive
/// look better. The right one leaves at most this share of the error, or this share of the motion.
const MOST_OF_ANOTHER_DRIVE: f64 = 0.42;
const LITTLE: f64 = 0.08;

const BEATS: f64 = 0.999;

/// The joint of which a correction changes how strong the input is.
fn strength_of(correction: &Correction) -> Option<usize> {
    match correction {
        Correction::Drive(joint, ..) => Some(*joint),
        Correction::Unit(columns) => match columns.as_slice() {
            [(LogColumn::Input(joint), _)] => Some(*joint),
            _ => None,
        },
        _ => None,
    }
}

/// Whether what only changes how strong an input is leaves less than one wrong value of
/// the file does: a mass, a stall torque, a gear, which diagnosis finds. `off` holds what one
/// value leaves for the joints that were asked for. What does the same but for rounding does not
/// beat it.
fn beats_a_wrong_value(
    bench: &CorrectionTrial,
    trial: &Trial,
    off: &mut BTreeMap<usize, Option<f64>>,
) -> bool {
    let Some(joint) = strength_of(&trial.correction) else {
        return true;
    };
    let fitted = off
        .entry(joint)
        .or_insert_with(|| bench.with_one_value_off(joint));
    // A fit may not get as far as the correction does.
    let scaled = scales_torque_by(&trial.correction, &bench.model)
        .and_then(|factor| bench.with_torques_scaled(joint, factor));
    let off = fitted.iter().copied().chain(scaled);
    let least = off.fold(f64::INFINITY, f64::min);
    trial.ratio() < BEATS * least
}

/// Whether a correction leaves less than plain friction at its joint does, which the model may
/// lack, and less than no input at all. `rubbing` holds what they leave for the joints that were
/// asked for.
fn beats_friction(
    bench: &CorrectionTrial,
    trial: &Trial,
    rubbing: &mut BTreeMap<usize, Option<f64>>,
) -> bool {
    let Some(joint) = rivals_friction(&trial.correction) else {
        return true;
    };
    let left = rubbing
        .entry(joint)
        .or_insert_with(|| bench.with_plain_friction(joint));
    left.is_none_or(|left| trial.ratio() < BEATS * left)
}

/// Whether an angle that was read earlier than its rows say leaves less than an input that acts
/// later: of one joint of several the two differ by what joints do to each other, and an input that
/// acts late is an effect of the drive.
fn beats_a_delay(bench: &CorrectionTrial, trial: &Trial) -> bool {
    let Correction::Shift(angle @ LogColumn::Position(joint), shift_s) = trial.correction else {
        return true;
    };
    let is_earlier = |given: &Column| shift_s < given.shift_s;
    if !angle.column(&bench.model).is_some_and(is_earlier) {
        return true;
    }
    let late = shift(bench, LogColumn::Input(joint));
    let late = late.and_then(|late| bench.tried(late, Effort::Starts));
    late.is_none_or(|late| AS_GOOD * trial.ratio() < late.ratio())
}

/// Whether samples lie so far apart, or so close, that the unit of time must be wrong.
pub(super) fn is_doubtful_time(model: &Model, motions: &[Motion]) -> bool {
    !time_units(model, spacing_s(motions)).is_empty()
}

/// Median time from sample to sample, s.
fn spacing_s(motions: &[Motion]) -> f64 {
    let steps = motions.iter().flat_map(|motion| motion.time_s.windows(2));
    let mut steps: Vec<f64> = steps.map(|pair| pair[1] - pair[0]).collect();
    if steps.is_empty() {
        return 0.0;
    }
    let middle = steps.len() / 2;
    *steps.select_nth_unstable_by(middle, f64::total_cmp).1
}

#[cfg(test)]
mod tests;
