//! Mass: the link is heavier or lighter than in the model.

use super::{EffectInfo, Law, Needs, OnSlide, Parameter, Rig, Scope, Site, ValueBehind};

/// m + dm at the same centre of mass, with the inertia about it in the same proportion.
///
/// At least 1 % of the mass is left, however much is taken away; a link without mass gains no
/// inertia of its own.
#[derive(Debug)]
pub struct Mass;

/// Smallest share of the mass that is left; a chain without inertia cannot be solved.
const LEAST_SHARE: f64 = 0.01;

pub(super) static INFO: EffectInfo = EffectInfo {
    id: "mass",
    title: "mass or payload",
    aliases: &[
        "payload",
        "added mass",
        "load mass",
        "inertial parameters",
        "weight",
    ],
    site: Site::Body,
    scope: Scope::AnyJoint,
    needs: Needs::Nothing,
    on_slide: OnSlide::Same,
    law: "mass + added_kg; the inertia about the centre of mass grows in the same proportion",
    parameters: &[Parameter::of(
        "added_kg",
        "mass missing in the model; below zero: too much in it",
    )
    .off(0.0)
    .typical(-0.1, 0.3)
    .bounds(-1.0, 5.0)
    .starts(&[0.05, -0.05])],
    looks_like: "gravity and inertia are wrong by the same share: the arm holds at another duty, \
     but swings freely with the right period",
    confused_with: &[
        "armature: both make the arm sluggish; armature adds no gravity: hold still first",
        "encoder_scale: both make gravity look wrong over the angle; a scale also changes the \
         angle between two stops",
        "torque_scale: a weaker drive answers less too, and one log may not tell; weigh the link, \
         or hold a known added mass",
        "cable_spring: near hanging, a spring is like gravity; turn the rig or add a mass, which \
         leaves the cable alone",
    ],
    experiment: "hold still at several angles, then swing freely, then repeat with a known mass \
     added",
    reference: "An, Atkeson, Hollerbach, Model-Based Control of a Robot Manipulator (1988)",
};

impl Law for Mass {
    fn value_behind(&self) -> Option<ValueBehind> {
        Some(ValueBehind::LinkMass)
    }

    fn body(&self, values: &[f64], joint: usize, rig: &mut Rig) {
        let mass_kg = *rig.mass_kg(joint);
        if mass_kg > 0.0 {
            rig.scale_mass(joint, (1.0 + values[0] / mass_kg).max(LEAST_SHARE));
        } else {
            *rig.mass_kg(joint) = values[0].max(0.0);
        }
    }
}
