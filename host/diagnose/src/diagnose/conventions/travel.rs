//! Joints that travel farther than an arm can, or hardly at all, as their angles are read.

use super::correction::{Correction, LogColumn};
use super::trial::CorrectionTrial;
use crate::model::Unit;
use crate::motion::Motion;

/// Joints that travel further than this are likelier read in a wrong unit, rad.
const DOUBTFUL_RAD: f64 = 30.0;

/// Joints that travel less than this are likelier read in a wrong unit, rad: any model that is
/// linear near its rest predicts so small a motion.
const STILL_RAD: f64 = 0.1;

/// How far the joint moves over all motions, rad.
pub(super) fn travel_rad(motions: &[Motion], joint: usize) -> f64 {
    spread(
        motions
            .iter()
            .map(|motion| motion.position_rad[joint].as_slice()),
    )
}

/// How far its goals lie apart over all motions.
fn goals_apart(motions: &[Motion], joint: usize) -> f64 {
    spread(
        motions
            .iter()
            .filter_map(|motion| motion.input[joint].as_deref()),
    )
}

fn spread<'a>(columns: impl Iterator<Item = &'a [f64]> + Clone) -> f64 {
    let values = || {
        columns
            .clone()
            .flatten()
            .copied()
            .filter(|value| value.is_finite())
    };
    values().fold(f64::NEG_INFINITY, f64::max) - values().fold(f64::INFINITY, f64::min)
}

/// Whether a correction leaves an angle in another unit hardly moving.
pub(super) fn stands_still(bench: &CorrectionTrial, correction: &Correction) -> bool {
    let motions = correction.reread(&bench.model, &bench.motions);
    joints(correction).any(|joint| travel_rad(&motions, joint) < STILL_RAD)
}

/// Whether one of the columns is an angle that travels too far as it is read.
pub(super) fn doubts_travel(motions: &[Motion], columns: &[(LogColumn, Unit)]) -> bool {
    angles(columns).any(|joint| travel_rad(motions, joint) > DOUBTFUL_RAD)
}

/// Of the corrections the units of angles that travel too far; of a goal that does so, too, those
/// of both.
pub(super) fn units_of_travel(corrections: &[Correction], motions: &[Motion]) -> Vec<Correction> {
    let is_calibrated = |joint| corrections.iter().any(|c| c.calibrates() == Some(joint));
    let goes_alone = |joint| !is_calibrated(joint) || goals_apart(motions, joint) <= DOUBTFUL_RAD;
    let wanted = corrections.iter().filter(|correction| {
        let mut doubtful =
            joints(correction).filter(|joint| travel_rad(motions, *joint) > DOUBTFUL_RAD);
        doubtful.any(|joint| correction.calibrates().is_some() || goes_alone(joint))
    });
    wanted.cloned().collect()
}

/// The joints whose angles a correction reads in another unit.
fn joints(correction: &Correction) -> impl Iterator<Item = usize> {
    let columns = match correction {
        Correction::Unit(columns) => columns.as_slice(),
        _ => &[],
    };
    angles(columns)
}

fn angles(columns: &[(LogColumn, Unit)]) -> impl Iterator<Item = usize> {
    columns.iter().filter_map(|(column, _)| match column {
        LogColumn::Position(joint) => Some(*joint),
        _ => None,
    })
}
