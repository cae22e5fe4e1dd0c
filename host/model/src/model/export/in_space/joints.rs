//! Damping, friction, springs, rotors and limits of a robot's joints, as a model has them.

use super::edits::Edits;
use super::{Pair, Source, is_near, rounded};
use crate::model::export::carried::value;
use crate::model::export::xml::number;

/// Writes what acts on the joints.
pub(super) fn write(edits: &mut Edits, source: &Source, models: &Pair) {
    for joint in 0..models.own.joints.len() {
        match source.format {
            "urdf" => urdf(edits, source, models, joint),
            _ => mjcf(edits, source, models, joint),
        }
    }
}

/// A value of a joint's effect where it is another than the file's; 0 of an effect that is not
/// there.
pub(super) fn changed(models: &Pair, id: &str, joint: usize, index: usize) -> Option<f64> {
    let file = models.file(joint);
    let (own, file) = (
        value(models.own, id, joint, index).unwrap_or(0.0),
        value(file, id, joint, index).unwrap_or(0.0),
    );
    (!is_near(own, file)).then_some(own)
}

fn urdf(edits: &mut Edits, source: &Source, models: &Pair, joint: usize) {
    let element = source.element(source.found.joints[joint].at);
    let of = |id: &str| changed(models, id, joint, 0).map(number);
    let values = [("damping", of("viscous")), ("friction", of("coulomb"))];
    let values = values
        .iter()
        .filter_map(|(key, value)| Some((key, value.as_ref()?)));
    match element.first("dynamics") {
        Some(dynamics) => values.for_each(|(key, value)| edits.set(&dynamics.node, key, value)),
        None => {
            let written: Vec<String> = values
                .map(|(key, value)| format!(" {key}=\"{value}\""))
                .collect();
            if !written.is_empty() {
                edits.insert(&element.node, &format!("<dynamics{}/>", written.concat()));
            }
        }
    }
    let limit = of("torque_saturation").filter(|limit| limit != "0.0");
    if let (Some(effort), Some(limit)) = (limit, element.first("limit")) {
        edits.set(&limit.node, "effort", &effort);
    }
}

fn mjcf(edits: &mut Edits, source: &Source, models: &Pair, joint: usize) {
    let element = source.element(source.found.joints[joint].at);
    let slides = source.found.tree.links[joint].slides;
    let degrees = (source.compiler.as_ref()).is_some_and(|own| own.degrees) && !slides;
    let place = |rad: f64| {
        if degrees {
            rounded(rad.to_degrees())
        } else {
            rad
        }
    };
    for (key, id, index) in [
        ("damping", "viscous", 0),
        ("frictionloss", "coulomb", 0),
        ("armature", "armature", 0),
        ("stiffness", "cable_spring", 0),
        ("springref", "cable_spring", 1),
    ] {
        if let Some(own) = changed(models, id, joint, index) {
            let own = if key == "springref" { place(own) } else { own };
            edits.set_first(&element.node, key, &number(own));
        }
    }
}
