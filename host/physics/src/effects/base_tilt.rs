//! Base tilt: the rig does not stand plumb.

use super::{EffectInfo, Law, Needs, OnSlide, Parameter, Rig, Scope, Site};

/// Gravity turned by b in the plane of the rig, counter-clockwise; by -b where the rig stands
/// turned by 180 degrees about the vertical.
#[derive(Debug)]
pub struct BaseTilt;

pub(super) static INFO: EffectInfo = EffectInfo {
    id: "base_tilt",
    title: "base tilt",
    aliases: &[
        "tilt",
        "gravity direction",
        "level",
        "levelling",
        "mounting angle",
        "inclination",
    ],
    site: Site::Body,
    scope: Scope::WholeRig,
    needs: Needs::Nothing,
    on_slide: OnSlide::Same,
    law: "gravity turned by angle_rad in the plane of the rig",
    parameters: &[
        Parameter::of("angle_rad", "tilt of the base, counter-clockwise")
            .off(0.0)
            .typical(-0.05, 0.05)
            .bounds(-1.6, 1.6)
            .starts(&[0.02, -0.02]),
    ],
    looks_like: "a static error with the same phase in the world on every link",
    confused_with: &[
        "com_angle: both shift the angle at which gravity vanishes; a centre of mass keeps its \
         side of the body when the rig is turned, and belongs to one link",
        "encoder_zero: both shift the angle at which gravity vanishes; an offset keeps its sign \
         at the joint when the rig is turned",
    ],
    experiment: "repeat a slow motion with the rig turned by 180 degrees about the vertical: the \
     error of a tilt changes sides",
    reference: "Mooring, Roth, Driels, Fundamentals of Manipulator Calibration (1991)",
};

impl Law for BaseTilt {
    fn acts_in_space(&self) -> bool {
        false
    }

    fn body(&self, values: &[f64], _joint: usize, rig: &mut Rig) {
        rig.gravity_turn_rad += if rig.turned { -values[0] } else { values[0] };
    }
}
