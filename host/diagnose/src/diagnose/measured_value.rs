//! Values of the file whose measurement says that an effect is not missing.

use crate::effects::{Axis, Effect, ValueBehind};
use crate::fitting::Candidate;
use crate::model::{JointField, LinkField, Model, ParameterPath};

/// The values that an effect changes and does nothing else: the stall torque of a torque scale, the
/// link's mass of a mass; at all driven joints one for each. Measured on the rig, they hold the
/// effect. None for other effects.
pub fn values_behind(candidate: &Candidate, model: &Model) -> Vec<ParameterPath> {
    let joints = match candidate.joint {
        Some(joint) => vec![joint],
        None => model.driven_joints(),
    };
    let behind = |joint: usize| value_behind(candidate.effect, joint, model);
    joints.into_iter().filter_map(behind).collect()
}

fn value_behind(effect: Effect, index: usize, model: &Model) -> Option<ParameterPath> {
    let joint = |field| ParameterPath::Joint { index, field };
    let path = match (effect.value_behind()?, model.joints.get(index)?.axis()) {
        (ValueBehind::StallTorque, Axis::Hinge) => joint(JointField::StallTorque),
        (ValueBehind::StallTorque, Axis::Slide) => joint(JointField::StallForce),
        (ValueBehind::LinkMass, _) => ParameterPath::Link {
            index,
            field: LinkField::Mass,
        },
    };
    path.get(model).map(|_| path)
}

/// Whether values that are known to be right leave nothing for a candidate to change.
pub(super) fn is_ruled_out(candidate: &Candidate, known: &[ParameterPath], model: &Model) -> bool {
    let behind = values_behind(candidate, model);
    !behind.is_empty() && behind.iter().all(|path| known.contains(path))
}

#[cfg(test)]
mod tests {
    use super::is_ruled_out;
    use crate::fitting::Candidate;
    use crate::model::Model;
    use std::path::Path;

    fn rules_out(known: &[&str], candidate: &str) -> bool {
        let link = "[[link]]\nlength_m = 0.1\ncom_m = 0.05\nmass_kg = 0.2\ninertia_kg_m2 = 1e-4\n";
        let joint = "[[joint]]\ndrive = \"duty\"\nstall_torque_nm = 1.0\nnominal_supply_v = 9.8\n";
        let columns = "[[log.joint]]\nposition = { column = \"q\", unit = \"rad\" }\n\
                       input = { column = \"u\", unit = \"1\" }\n";
        let text = format!(
            "[rig]\nname = \"two\"\nangle_zero = \"hanging\"\n{}{}\
             [log]\ntime = {{ column = \"t\", unit = \"s\" }}\n{}",
            link.repeat(2),
            joint.repeat(2),
            columns.repeat(2)
        );
        let model = Model::parse(&text, Path::new("two.toml")).unwrap();
        let known: Vec<_> = known.iter().map(|path| path.parse().unwrap()).collect();
        let candidate = Candidate::named(candidate, &model).unwrap();
        is_ruled_out(&candidate, &known, &model)
    }

    #[test]
    fn a_measured_stall_torque_leaves_no_torque_scale_at_its_joint() {
        assert!(rules_out(&["joint2.stall_torque_nm"], "torque_scale@2"));
        assert!(!rules_out(&["joint2.stall_torque_nm"], "torque_scale@1"));
        assert!(!rules_out(&["joint2.stall_torque_nm"], "speed_limit@2"));
    }

    #[test]
    fn a_weighed_link_leaves_no_mass_at_its_joint() {
        assert!(rules_out(&["link1.mass_kg"], "mass@1"));
        assert!(!rules_out(&["link1.mass_kg"], "mass@2"));
        assert!(!rules_out(&["link1.com_m"], "mass@1"));
    }

    #[test]
    fn twins_are_ruled_out_when_all_are_measured() {
        let one = ["joint1.stall_torque_nm"];
        assert!(!rules_out(&one, "torque_scale@all"));
        let both = [one[0], "joint2.stall_torque_nm"];
        assert!(rules_out(&both, "torque_scale@all"));
    }

    #[test]
    fn the_whole_rig_is_never_ruled_out() {
        assert!(!rules_out(&["link1.mass_kg", "link2.mass_kg"], "base_tilt"));
    }
}
