//! Looks for the corrections that clearly lower the error, one after another.

use super::continuous::{LEAST_ZERO_RAD, continuous};
use super::correction::{Correction, LogColumn, alternatives, time_units, travel_rad};
use super::drives::drives;
use super::leave_out::without_stalled;
use super::plain_friction::rivals_friction;
use super::rating::ModelReading;
use super::trial::{CorrectionTrial, Effort, Trial, scales_torque_by};
use crate::fitting::coarsened;
use crate::model::{Model, Unit};
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
/// Units of one input among them: where it hardly matters, each that makes it small does well.
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
    // Where a free number gains but little more, one of a few alternatives is likelier.
    let merit = |trial: &Trial| {
        if trial.correction.is_continuous() {
            trial.after / FREE_NUMBER
        } else {
            trial.after
        }
    };
    clear.sort_by(|a, b| merit(a).total_cmp(&merit(b)));
    let mut clear = clear.into_iter();
    let trial = clear.next()?;
    let rivals = clear.filter(|rival| merit(rival) < AS_GOOD * merit(&trial));
    Some(LogFault {
        rivals: rivals.collect(),
        trial,
    })
}

/// How much less error a free number must leave than an alternative without one.
const FREE_NUMBER: f64 = 0.7;
/// Errors that differ by less are the same.
const AS_GOOD: f64 = 1.15;

fn plausible_time(model: &Model, motions: &[Motion]) -> Vec<Trial> {
    let samples = |most: usize| excerpts(motions, affordable(most, model));
    let few = ModelReading::new(model.clone(), samples(SAMPLES_CONTINUOUS));
    let all = samples(SAMPLES);
    let model = &coarsened(model, &few.data);
    let bench = CorrectionTrial::new(model, all);
    let few = CorrectionTrial::new(model, few.data.motions);
    let mut corrections = alternatives(model, motions);
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
    screened.sort_by(|a, b| a.ratio().total_cmp(&b.ratio()));
    let judged = most_promising(screened).into_par_iter();
    let judged = judged.filter_map(|trial| {
        // The file's free values are a start: each reading is judged with those that suit it.
        let fitted = if is_long {
            Effort::Starts
        } else {
            Effort::Values
        };
        let refitted = bench.tried(trial.correction.clone(), fitted)?;
        let is_another_drive = matches!(refitted.correction, Correction::Drive(..));
        let suits = refitted.ratio() < MOST_OF_ANOTHER_DRIVE || refitted.after < LITTLE;
        if !least(bench, &refitted.correction).allows(&refitted) || is_another_drive && !suits {
            return None;
        }
        let does_as_given = is_long
            || bench
                .tried(trial.correction, Effort::Starts)
                .is_some_and(|given| given.ratio() < 1.0);
        does_as_given.then_some(refitted)
    });
    let mut judged: Vec<Trial> = judged.collect();
    let (mut off, mut rubbing) = (BTreeMap::new(), BTreeMap::new());
    judged.retain(|trial| beats_a_wrong_value(bench, trial, &mut off));
    judged.retain(|trial| beats_friction(bench, trial, &mut rubbing));
    judged
}

/// The first of the sorted trials, of units of one input no more than a few.
fn most_promising(sorted: Vec<Trial>) -> Vec<Trial> {
    let units = |trial: &Trial| match &trial.correction {
        Correction::Unit(columns) => match columns.as_slice() {
            [(input @ LogColumn::Input(_), _)] => Some(*input),
            _ => None,
        },
        _ => None,
    };
    let mut kept: Vec<Trial> = Vec::new();
    for trial in sorted {
        let own = units(&trial);
        let alike = kept.iter().filter(|kept| units(kept) == own).count();
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

/// What a correction must do to be believed.
struct CorrectionThreshold {
    ratio: f64,
    better: f64,
}

/// Share that a correction may leave where it raises the error in rad.
const MOST_WHERE_LARGER: f64 = 0.15;

impl CorrectionThreshold {
    fn allows(&self, trial: &Trial) -> bool {
        // In another unit every error in rad may be larger, but then little of the motion is left.
        let most = if trial.after_rad > trial.before_rad {
            MOST_WHERE_LARGER
        } else {
            1.0
        };
        trial.ratio() < self.ratio && trial.better >= self.better && trial.after < most
    }
}

/// What it must do: alternatives without a free number less than zeros and shifts, which
/// effects of the rig (a tilt, a delay) look like.
fn least(bench: &CorrectionTrial, correction: &Correction) -> CorrectionThreshold {
    let strict = CorrectionThreshold {
        ratio: 0.6,
        better: 0.75,
    };
    let never = CorrectionThreshold {
        ratio: 0.0,
        better: 1.0,
    };
    match correction {
        Correction::Offset(quantity, offset) => {
            let given = quantity
                .column(&bench.model)
                .map_or(0.0, |column| column.offset);
            if (offset - given).abs() > LEAST_ZERO_RAD {
                strict
            } else {
                never
            }
        }
        // A drive that acts late, whatever delays it, is an effect of the library.
        Correction::Shift(LogColumn::Input(_), shift_s) if *shift_s > 0.0 => never,
        Correction::Shift(_, shift_s) => {
            if shift_s.abs() > 0.008 {
                strict
            } else {
                never
            }
        }
        Correction::Unit(columns) if stands_still(bench, correction, columns) => never,
        // Many turns of an arm are reason enough to doubt a unit.
        Correction::Unit(columns) if doubts_travel(bench, columns) => CorrectionThreshold {
            ratio: 0.97,
            better: 0.5,
        },
        _ => CorrectionThreshold {
            ratio: 0.8,
            better: 0.7,
        },
    }
}

/// Joints that travel further than this are likelier read in a wrong unit, rad.
const DOUBTFUL_RAD: f64 = 30.0;

/// Joints that travel less than this are likelier read in a wrong unit, rad: any model that is
/// linear near its rest predicts so small a motion.
const STILL_RAD: f64 = 0.1;

/// Whether one of the columns is an angle that hardly moves as the correction reads it.
fn stands_still(
    bench: &CorrectionTrial,
    correction: &Correction,
    columns: &[(LogColumn, Unit)],
) -> bool {
    let motions = correction.reread(&bench.model, &bench.motions);
    columns.iter().any(|(quantity, _)| match quantity {
        LogColumn::Position(joint) => travel_rad(&motions, *joint) < STILL_RAD,
        _ => false,
    })
}

/// Whether one of the columns is an angle that travels too far as it is read.
fn doubts_travel(bench: &CorrectionTrial, columns: &[(LogColumn, Unit)]) -> bool {
    columns.iter().any(|(quantity, _)| match quantity {
        LogColumn::Position(joint) => travel_rad(&bench.motions, *joint) > DOUBTFUL_RAD,
        _ => false,
    })
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
