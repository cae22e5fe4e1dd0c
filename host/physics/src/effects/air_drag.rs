//! Air drag: resistance in proportion to the square of speed.

use super::{AtRest, EffectInfo, JointState, Law, Needs, OnSlide, Parameter, Scope, Site, Slope};

/// -c w |w|.
#[derive(Debug)]
pub struct AirDrag;

pub(super) static INFO: EffectInfo = EffectInfo {
    id: "air_drag",
    title: "air drag",
    aliases: &[
        "drag",
        "aerodynamic drag",
        "air resistance",
        "quadratic drag",
        "quadratic damping",
        "fluid drag",
        "windage",
        "wind",
        "wind resistance",
        "damping",
    ],
    site: Site::Joint,
    scope: Scope::AnyJoint,
    needs: Needs::Nothing,
    on_slide: OnSlide::Own(&ON_SLIDE),
    law: "torque = -coefficient_nm_s2_rad2 * w * |w|",
    parameters: &[
        Parameter::of("coefficient_nm_s2_rad2", "resistance per square of speed")
            .off(0.0)
            .typical(0.0001, 0.005)
            .bounds(0.0, 1.0)
            .starts(&[0.001, 0.0001]),
    ],
    looks_like: "wide swings shrink fast and narrow ones hardly; the residual torque is a parabola \
     over speed with the sign of the speed",
    confused_with: &[
        "viscous: both grow with speed; viscous friction keeps its share in slow motion",
        "load_friction: fast motion loads the gear too; repeat slowly, where only load friction \
         remains",
        "bearing_friction: both take more from a wide swing; the bearing also stops the last \
         narrow swings",
    ],
    experiment: "let the arm swing freely from a wide angle, bare and with a light card that \
     catches the air",
    reference: "Nelson, Olsson, American Journal of Physics 54 (1986) 112",
};

/// At a joint that slides.
static ON_SLIDE: EffectInfo = EffectInfo {
    law: "force = -coefficient_n_s2_m2 * w * |w|",
    parameters: &[
        Parameter::of("coefficient_n_s2_m2", "resistance per square of speed")
            .off(0.0)
            .typical(0.005, 1.0)
            .bounds(0.0, 1000.0)
            .starts(&[0.1, 0.01]),
    ],
    ..INFO
};

impl Law for AirDrag {
    fn torque(&self, values: &[f64], at: &JointState) -> f64 {
        -values[0] * at.speed_rad_s * at.speed_rad_s.abs()
    }

    fn slope(&self, _values: &[f64], _at: &AtRest) -> Option<Slope> {
        // The square of the speed has no slope at rest.
        Some(Slope::NONE)
    }
}
