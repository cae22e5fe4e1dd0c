//! Coulomb friction: the same resistance at every speed, and a hold at rest.

use super::{EffectInfo, FrictionState, Law, Needs, OnSlide, Parameter, Scope, Site};

/// tau_f = -tau_c sgn(w); at rest the joint is held up to tau_c.
#[derive(Debug)]
pub struct Coulomb;

pub(super) static INFO: EffectInfo = EffectInfo {
    id: "coulomb",
    title: "Coulomb friction",
    aliases: &[
        "dry friction",
        "kinetic friction",
        "sliding friction",
        "static friction",
        "frictionloss",
        "friction",
    ],
    site: Site::Friction,
    scope: Scope::AnyJoint,
    needs: Needs::Nothing,
    on_slide: OnSlide::Own(&ON_SLIDE),
    law: "friction = torque_nm * sgn(w), against the motion; at rest it holds up to torque_nm",
    parameters: &[
        Parameter::of("torque_nm", "friction torque, the same at every speed")
            .off(0.0)
            .typical(0.005, 0.2)
            .bounds(0.0, 10.0)
            .starts(&[0.02, 0.1]),
    ],
    looks_like: "the residual torque is a square wave in step with the sign of the speed; a free \
     swing loses the same angle every half period (straight envelope) and stops off the bottom",
    confused_with: &[
        "pre_sliding: over large angles both are one torque; within a degree only one is sprung",
        "position_friction: both oppose the motion; compare the width of the loop over angle",
        "drive_asymmetry: the same at one load; change the mass or the length of the arm",
        "dead_zone: both swallow small commands; with the torque off only friction remains",
        "stribeck: both jump at reversal; Stribeck's part fades as speed grows",
        "load_friction: the same at one load; change the mass or the arm's length",
        "bearing_friction: the same under one force; add mass at the joint, which loads the \
         bearing alone",
    ],
    experiment: "let the arm swing freely with the torque off, or move it slowly up and down at \
     two constant speeds",
    reference: "Armstrong-Helouvry, Dupont, Canudas de Wit, Automatica 30 (1994) 1083",
};

/// At a joint that slides.
static ON_SLIDE: EffectInfo = EffectInfo {
    law: "friction = force_n * sgn(w), against the motion; at rest it holds up to force_n",
    parameters: &[
        Parameter::of("force_n", "friction force, the same at every speed")
            .off(0.0)
            .typical(0.05, 10.0)
            .bounds(0.0, 1000.0)
            .starts(&[0.5, 5.0]),
    ],
    ..INFO
};

impl Law for Coulomb {
    fn friction(&self, values: &[f64], _at: &FrictionState) -> f64 {
        values[0]
    }

    fn friction_is_constant(&self) -> bool {
        true
    }
}
