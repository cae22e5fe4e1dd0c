//! Stiction and Stribeck friction: more resistance at rest than in motion.

use super::{EffectInfo, FrictionState, Law, Needs, OnSlide, Parameter, Scope, Site};

/// tau_x exp(-|w| / w_s), on top of the sliding friction.
///
/// Bo and Pavelescu measured exponents of |w| / w_s between 0.5 and 1; here it is fixed at 1, since
/// motion this slow is too rare in a log to tell them apart.
#[derive(Debug)]
pub struct Stribeck;

pub(super) static INFO: EffectInfo = EffectInfo {
    id: "stribeck",
    title: "stiction and Stribeck friction",
    aliases: &[
        "stiction",
        "static friction",
        "breakaway",
        "breakaway torque",
        "break-away friction",
        "stick-slip",
        "Stribeck effect",
        "friction",
    ],
    site: Site::Friction,
    scope: Scope::AnyJoint,
    needs: Needs::Nothing,
    on_slide: OnSlide::Own(&ON_SLIDE),
    law: "friction = excess_nm * exp(-|w| / speed_rad_s), against the motion",
    parameters: &[
        Parameter::of("excess_nm", "breakaway torque above the sliding friction")
            .off(0.0)
            .typical(0.005, 0.2)
            .bounds(0.0, 10.0)
            .starts(&[0.02, 0.1]),
        Parameter::of(
            "speed_rad_s",
            "Stribeck speed, at which 37 % of the excess is left",
        )
        .typical(0.05, 0.8)
        .bounds(0.005, 10.0)
        .starts(&[0.15, 0.6]),
    ],
    looks_like: "the arm sticks, then jumps; the residual torque is a spike at each reversal that \
     fades as the speed grows",
    confused_with: &[
        "pre_sliding: both make joints stick; only a spring moves on small pushes",
        "coulomb: both jump at reversal; Coulomb friction stays at every speed",
        "dead_zone: both leave small commands without motion; a dead zone is gone with the torque \
         off",
        "backlash: both halt the reading at reversal; backlash halts it over a fixed angle, \
         stiction until a fixed torque",
    ],
    experiment: "move slowly at several constant speeds from 0.05 rad/s up, and note the torque at \
     which the resting arm breaks away",
    reference: "Bo, Pavelescu, Wear 82 (1982) 277; Armstrong-Helouvry, Dupont, Canudas de Wit, \
     Automatica 30 (1994) 1083",
};

/// At a joint that slides.
static ON_SLIDE: EffectInfo = EffectInfo {
    law: "friction = excess_n * exp(-|w| / speed_m_s), against the motion",
    parameters: &[
        Parameter::of("excess_n", "breakaway force above the sliding friction")
            .off(0.0)
            .typical(0.05, 10.0)
            .bounds(0.0, 1000.0)
            .starts(&[0.5, 5.0]),
        Parameter::of(
            "speed_m_s",
            "Stribeck speed, at which 37 % of the excess is left",
        )
        .typical(0.005, 0.2)
        .bounds(0.0005, 5.0)
        .starts(&[0.02, 0.1]),
    ],
    ..INFO
};

impl Law for Stribeck {
    fn difference(&self) -> f64 {
        5e-3
    }

    fn friction(&self, values: &[f64], at: &FrictionState) -> f64 {
        let [excess_nm, stribeck_rad_s] = values else {
            return 0.0;
        };
        excess_nm * (-at.speed_rad_s / stribeck_rad_s).exp()
    }
}
