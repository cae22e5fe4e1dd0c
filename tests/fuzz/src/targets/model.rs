//! Model files: reading them, and writing values and effects into them.

use super::text;
use handstand::effects::EFFECTS;
use handstand::model::edit::{add_effect, set_values};
use handstand::model::import::{ImportPlan, JointDrives};
use handstand::model::shapes::read_stl;
use handstand::model::{EffectInstance, Model};
use std::path::Path;

pub(crate) fn parse(bytes: &[u8]) {
    if let Some(text) = text(bytes) {
        let _ = Model::parse(text, Path::new("model.toml"));
    }
}

/// Sets every free value and adds an effect, which one the bytes decide: what is written is read
/// back.
pub(crate) fn edit(bytes: &[u8]) {
    let path = Path::new("model.toml");
    let Some(text) = text(bytes) else {
        return;
    };
    let Ok(model) = Model::parse(text, path) else {
        return;
    };
    let values = model.free.iter().filter_map(|p| Some((*p, p.get(&model)?)));
    let values: Vec<_> = values.collect();
    if let Ok(written) = set_values(text, path, &values) {
        let again = Model::parse(&written, path).expect("what was written is a model");
        for (parameter, value) in values {
            let again = parameter.get(&again).expect("the parameter is there");
            let close = (again - value).abs() <= 1e-5 * value.abs() || again == value;
            assert!(close, "{parameter}: {again} for {value}");
        }
    }
    let sum: usize = bytes.iter().map(|byte| usize::from(*byte)).sum();
    let effect = EFFECTS[sum % EFFECTS.len()];
    let instance = EffectInstance {
        effect,
        joint: (!sum.is_multiple_of(3)).then_some(0),
        values: (effect.info().parameters.iter())
            .map(|p| p.starts[0])
            .collect(),
    };
    if let Ok(written) = add_effect(text, path, &instance, None) {
        let again = Model::parse(&written, path).expect("what was written is a model");
        assert_eq!(again.effects.len(), model.effects.len() + 1);
    }
}

/// A robot's mesh: its triangles have corners, also where it is thinned.
pub(crate) fn mesh(bytes: &[u8]) {
    let Ok(mesh) = read_stl(bytes) else {
        return;
    };
    for mesh in [mesh.thinned(mesh.triangles.len() / 2), mesh] {
        let corners = mesh.corners_m.len();
        let of = |corner: &u32| (*corner as usize) < corners;
        assert!(mesh.triangles.as_flattened().iter().all(of));
        assert!(
            mesh.corners_m
                .as_flattened()
                .iter()
                .all(|own| own.is_finite())
        );
    }
}

/// A robot of another simulator: whatever it says, the model that comes of it is one.
pub(crate) fn import(bytes: &[u8]) {
    let Some(text) = text(bytes) else {
        return;
    };
    let plan = ImportPlan {
        joints: Vec::new(),
        drives: match bytes.len() % 3 {
            0 => JointDrives::OfFile,
            1 => JointDrives::OrTorque,
            _ => JointDrives::All("position"),
        },
        space: None,
    };
    let in_space = ImportPlan {
        space: Some(Default::default()),
        ..plan.clone()
    };
    let _ = handstand::model::import::import(text, Path::new("robot.xml"), &in_space);
    if let Ok(imported) = handstand::model::import::import(text, Path::new("robot.xml"), &plan) {
        let model = Model::parse(&imported.toml, Path::new("imported.toml"));
        assert_eq!(
            model.map(|model| model.link_count()).ok(),
            Some(imported.joints.len())
        );
    }
}
