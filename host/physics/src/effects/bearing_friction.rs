//! Load friction of a plain bearing: the weight it carries and the swing press on it.

use super::{EffectInfo, FrictionState, Law, Needs, OnSlide, Parameter, Scope, Site};

/// r F, with r the friction coefficient times the bearing radius and F the force in the bearing.
#[derive(Debug)]
pub struct BearingFriction;

pub(super) static INFO: EffectInfo = EffectInfo {
    id: "bearing_friction",
    title: "load friction of a plain bearing",
    aliases: &[
        "bearing drag",
        "journal bearing",
        "plain bearing",
        "friction circle",
        "friction",
    ],
    site: Site::Friction,
    scope: Scope::PassiveJoint,
    needs: Needs::BearingLoad,
    on_slide: OnSlide::Never,
    law: "friction = radius_m * bearing force, against the motion",
    parameters: &[
        Parameter::of("radius_m", "friction coefficient times bearing radius")
            .off(0.0)
            .typical(1e-5, 0.005)
            .bounds(0.0, 0.05)
            .starts(&[0.001, 0.0001]),
    ],
    looks_like: "a free swing loses more angle per period while it is wide, since the swing itself \
     loads the bearing, and still stops off the bottom",
    confused_with: &[
        "coulomb: the same under one force; add mass at the joint, which loads the bearing \
         without changing the swing",
        "air_drag: both take more from a wide swing; air drag lets the swing fade slowly at the \
         end, the bearing stops it",
    ],
    experiment: "let the chain swing freely from a wide angle until it stops, then repeat with a \
     mass added close to the bearing",
    reference: "Bowden, Tabor, The Friction and Lubrication of Solids (1950)",
};

impl Law for BearingFriction {
    fn friction(&self, values: &[f64], at: &FrictionState) -> f64 {
        values[0] * at.bearing_load_n
    }
}
