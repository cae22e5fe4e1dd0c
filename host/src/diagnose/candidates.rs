//! Which effects could be missing, and where.

use crate::effects::{EFFECTS, Needs, Scope};
use crate::fitting::Candidate;
use crate::log::Motion;
use crate::model::{Drive, Model};

/// Every effect of the library and of the model file at every place where it can act on this model and be seen in these motions, except
/// those the model holds and those named in `without`.
pub fn candidates(model: &Model, motions: &[Motion], without: &[String]) -> Vec<Candidate> {
    let mut found = Vec::new();
    for &effect in EFFECTS
        .iter()
        .chain(&model.laws)
        .filter(|e| !without.iter().any(|id| id == e.info().id))
    {
        let info = effect.info();
        let joints: Vec<Option<usize>> = match info.scope {
            Scope::WholeRig => vec![None],
            scope => (0..model.link_count())
                .filter(|&joint| suits(scope, model, motions, joint))
                .map(Some)
                .collect(),
        };
        let at_joints = joints.into_iter().map(|joint| Candidate { effect, joint });
        found.extend(at_joints.filter(|candidate| {
            !candidate.in_model(model) && visible(info.needs, model, motions, candidate.joint)
        }));
    }
    found
}

/// Whether an effect of this scope may act at a joint: on a driven joint only if its drive does
/// something in these motions.
fn suits(scope: Scope, model: &Model, motions: &[Motion], joint: usize) -> bool {
    let drive = &model.joints[joint].drive;
    let varies = |input: &Vec<f64>| input.iter().any(|x| *x != input[0]);
    let drives = |motion: &Motion| {
        motion
            .torque_on
            .as_ref()
            .is_none_or(|on| on.contains(&true))
            && motion.input[joint].as_ref().is_some_and(varies)
    };
    match scope {
        Scope::WholeRig | Scope::AnyJoint => true,
        Scope::PassiveJoint => *drive == Drive::Passive,
        Scope::DrivenJoint => drive.is_driven() && motions.iter().any(drives),
    }
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
