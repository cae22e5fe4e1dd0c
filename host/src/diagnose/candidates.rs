//! Which effects could be missing, and where.

use crate::effects::{EFFECTS, Needs, Scope};
use crate::fitting::Candidate;
use crate::log::Motion;
use crate::model::{Drive, Model};

/// Every effect at every place where it can act on this model and be seen in these motions, except those the
/// model holds and those named in `without`.
pub fn candidates(model: &Model, motions: &[Motion], without: &[String]) -> Vec<Candidate> {
    let mut found = Vec::new();
    for &effect in EFFECTS {
        let card = effect.card();
        if without.iter().any(|id| id == card.id) {
            continue;
        }
        let joints: Vec<Option<usize>> = match card.scope {
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
            if !candidate.in_model(model) && visible(card.needs, model, motions, joint) {
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
