//! Which effects could be missing, and where.

use crate::effects::{EFFECTS, Effect, Needs, SMOOTH_DIFFERENCE, Scope};
use crate::log::Motion;
use crate::model::{Drive, EffectInstance, Model, ParameterPath};
use std::fmt;

/// An effect of the library at a joint, or on the whole rig.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Candidate {
    /// The effect.
    pub effect: &'static dyn Effect,
    /// Joint index from 0; `None` for the whole rig.
    pub joint: Option<usize>,
}

impl fmt::Display for Candidate {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.joint {
            Some(joint) => write!(f, "{}@{}", self.effect.info().id, joint + 1),
            None => write!(f, "{}", self.effect.info().id),
        }
    }
}

impl Candidate {
    /// Whether the model holds it already.
    pub fn in_model(&self, model: &Model) -> bool {
        model.has_effect(self.effect.info().id, self.joint)
    }

    /// Whether its law jumps, so that the squared error over its values is full of steps and false valleys.
    pub fn jumps(&self) -> bool {
        self.effect.difference() > SMOOTH_DIFFERENCE
    }

    /// The effect with these values, to be added to a model.
    pub fn instance(&self, values: &[f64]) -> EffectInstance {
        EffectInstance {
            effect: self.effect,
            joint: self.joint,
            values: values.to_vec(),
        }
    }

    /// Addresses of its values.
    pub fn paths(&self) -> impl Iterator<Item = ParameterPath> + '_ {
        let info = self.effect.info();
        (0..info.parameters.len()).map(move |parameter| ParameterPath::Effect {
            id: info.id,
            joint: self.joint,
            parameter,
        })
    }

    /// Every combination of the parameters' start values.
    pub fn starts(&self) -> Vec<Vec<f64>> {
        let mut combinations = vec![Vec::new()];
        for parameter in self.effect.info().parameters {
            combinations = combinations
                .iter()
                .flat_map(|head: &Vec<f64>| {
                    parameter.starts.iter().map(move |start| {
                        let mut next = head.clone();
                        next.push(*start);
                        next
                    })
                })
                .collect();
        }
        combinations
    }
}

/// Every effect at every place where it can act on this model and be seen in these motions, except those the
/// model holds and those named in `without`.
pub fn candidates(model: &Model, motions: &[Motion], without: &[String]) -> Vec<Candidate> {
    let mut found = Vec::new();
    for &effect in EFFECTS {
        let info = effect.info();
        if without.iter().any(|id| id == info.id) {
            continue;
        }
        let joints: Vec<Option<usize>> = match info.scope {
            Scope::WholeRig => vec![None],
            Scope::AnyJoint => (0..model.link_count()).map(Some).collect(),
            Scope::DrivenJoint => driven(model, motions),
            Scope::PassiveJoint => (0..model.link_count())
                .filter(|&joint| model.joints[joint].drive == Drive::Passive)
                .map(Some)
                .collect(),
        };
        for joint in joints {
            let candidate = Candidate { effect, joint };
            if !candidate.in_model(model) && visible(info.needs, model, motions, joint) {
                found.push(candidate);
            }
        }
    }
    found
}

/// Joints whose drive does something in these motions.
fn driven(model: &Model, motions: &[Motion]) -> Vec<Option<usize>> {
    (0..model.link_count())
        .filter(|&joint| {
            model.joints[joint].drive.is_driven()
                && motions.iter().any(|m| {
                    m.torque_on.as_ref().is_none_or(|on| on.contains(&true))
                        && m.input[joint]
                            .as_ref()
                            .is_some_and(|input| input.iter().any(|x| *x != input[0]))
                })
        })
        .map(Some)
        .collect()
}

fn visible(needs: Needs, model: &Model, motions: &[Motion], joint: Option<usize>) -> bool {
    match needs {
        Needs::Nothing | Needs::GearLoad | Needs::BearingLoad => true,
        Needs::Supply => {
            let nominal = joint.and_then(|j| model.joints[j].drive.motor()?.nominal_supply_v);
            let logged = motions.iter().filter_map(|m| m.supply_v.as_ref()).flatten();
            let (low, high) = logged.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| {
                (low.min(*v), high.max(*v))
            });
            // A supply that moves by less than 2 % teaches nothing.
            nominal.is_some_and(|nominal| high - low > 0.02 * nominal)
        }
    }
}
