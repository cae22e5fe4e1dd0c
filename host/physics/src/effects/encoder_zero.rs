//! Encoder zero: the reading is off by a constant.

use super::{AtRest, EffectInfo, Law, Needs, OnSlide, Parameter, Scope, Site, Slope};

/// q + o.
#[derive(Debug)]
pub struct EncoderZero;

pub(super) static INFO: EffectInfo = EffectInfo {
    id: "encoder_zero",
    title: "encoder zero",
    aliases: &[
        "encoder offset",
        "zero offset",
        "calibration offset",
        "homing error",
        "sensor offset",
        "offset",
        "bias",
    ],
    site: Site::Encoder,
    scope: Scope::AnyJoint,
    needs: Needs::Nothing,
    on_slide: OnSlide::Own(&ON_SLIDE),
    law: "reading = q + offset_rad",
    parameters: &[Parameter::of("offset_rad", "reading at true angle zero")
        .off(0.0)
        .typical(-0.1, 0.1)
        .bounds(-3.2, 3.2)
        .starts(&[0.02, -0.02])],
    looks_like: "a constant error of the angle; the torque of gravity peaks at the wrong reading",
    confused_with: &[
        "grip_slip: a zero that is off is off from the beginning and stays so",
        "torque_offset: near hanging both move the point of rest; far from it gravity tells",
        "com_angle: both shift the angle at which gravity vanishes; in a chain an encoder offset \
         turns the outer links too",
        "base_tilt: both shift the angle at which gravity vanishes; a tilt changes its sign at \
         the joint when the rig is turned",
        "encoder_scale: the same at one angle; read at two stops far apart",
        "direction_asymmetry: both leave a torque of one sign; the asymmetry is gone at rest",
    ],
    experiment: "move against a stop at a known angle, then turn the rig by 180 degrees and repeat",
    reference: "Mooring, Roth, Driels, Fundamentals of Manipulator Calibration (1991)",
};

/// At a joint that slides.
static ON_SLIDE: EffectInfo = EffectInfo {
    law: "reading = q + offset_m",
    parameters: &[
        Parameter::of("offset_m", "reading at true displacement zero")
            .off(0.0)
            .typical(-0.05, 0.05)
            .bounds(-10.0, 10.0)
            .starts(&[0.01, -0.01]),
    ],
    ..INFO
};

impl Law for EncoderZero {
    fn encode(&self, values: &[f64], angle_rad: f64) -> f64 {
        angle_rad + values[0]
    }

    fn slope(&self, _values: &[f64], _at: &AtRest) -> Option<Slope> {
        Some(Slope::NONE)
    }
}
