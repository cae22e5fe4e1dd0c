//! What plain friction explains that the model lacks, and what no input at all explains.
//!
//! A drive whose friction takes most of its torque moves as if its input were small: a unit that
//! makes it small, or another drive, then lowers the error of a model without friction. Such a
//! correction says nothing unless it does better than friction does.

use super::correction::{Correction, LogColumn};
use super::rating::ModelReading;
use super::trial::Effort;
use crate::effects::EFFECTS;
use crate::fitting::Candidate;
use crate::model::{Model, effect_on};
use crate::motion::Motion;
use rayon::prelude::*;

/// Whether it changes how strong, or of which sign, a joint's input is, or how far the joint
/// moves: what friction or its lack may look like.
pub(super) fn rivals_friction(correction: &Correction) -> Option<usize> {
    match correction {
        // The drive moves as before.
        _ if correction.calibrates().is_some() => None,
        Correction::Drive(joint, ..) => Some(*joint),
        Correction::Unit(columns) => columns.iter().find_map(|(column, _)| joint_of(*column)),
        Correction::Reverse(columns) => match columns.as_slice() {
            [LogColumn::Input(joint)] => Some(*joint),
            _ => None,
        },
        _ => None,
    }
}

fn joint_of(column: LogColumn) -> Option<usize> {
    match column {
        LogColumn::Time => None,
        LogColumn::Position(joint)
        | LogColumn::Velocity(joint)
        | LogColumn::Rate(joint)
        | LogColumn::Input(joint) => Some(joint),
    }
}

/// The least share left by the model as given with viscous and Coulomb friction at a joint, and by
/// it without the joint's input, over the share that the model leaves.
pub(super) fn left_by_friction(reading: &ModelReading, joint: usize) -> Option<f64> {
    let before = reading.rated(Effort::Values).share()?.max(1e-12);
    let rubbing = with_friction(&reading.model, joint).into_par_iter();
    let rubbing = rubbing.filter_map(|model| {
        let reading = reading.read_as(&model, reading.data.motions.clone());
        reading.rated(Effort::ValuesToTheEnd).share()
    });
    let still = || {
        let motions = reading.data.motions.iter();
        let motions = motions.map(|motion| without_input(motion, joint)).collect();
        let reading = reading.read_as(&reading.model, motions);
        reading.rated(Effort::Values).share()
    };
    let left = rubbing.chain(rayon::iter::once(()).filter_map(|()| still()));
    let least = left.min_by(f64::total_cmp)?;
    Some(least / before)
}

/// The model with friction where it has none of the kind, from each pair of start values, and the
/// friction free.
fn with_friction(model: &Model, joint: usize) -> Vec<Model> {
    let mut models = vec![model.clone()];
    for id in ["viscous", "coulomb"] {
        if model.has_effect(id, Some(joint)) {
            continue;
        }
        let effect = EFFECTS.iter().find(|effect| effect.info().id == id);
        let Some(effect) = effect.and_then(|e| effect_on(*e, Some(joint), &model.joints)) else {
            continue;
        };
        let candidate = Candidate {
            effect,
            joint: Some(joint),
        };
        let starts = candidate.starts();
        models = models
            .iter()
            .flat_map(|model| starts.iter().map(move |values| (model, values)))
            .map(|(model, values)| {
                let mut model = model.clone();
                model.effects.push(candidate.instance(values));
                model.free.extend(candidate.paths());
                model
            })
            .collect();
    }
    models
}

/// The motion with a joint whose drive gives nothing.
fn without_input(motion: &Motion, joint: usize) -> Motion {
    let mut motion = motion.clone();
    motion.input[joint]
        .iter_mut()
        .flatten()
        .for_each(|u| *u = 0.0);
    motion
}
