//! Encoder scale: the reading stretches the angle.

use super::{AtRest, EffectInfo, Law, Needs, OnSlide, Parameter, Scope, Site, Slope};

/// s q.
#[derive(Debug)]
pub struct EncoderScale;

pub(super) static INFO: EffectInfo = EffectInfo {
    id: "encoder_scale",
    title: "encoder scale",
    aliases: &[
        "encoder gain",
        "sensor gain",
        "scale factor",
        "potentiometer gain",
        "gain",
        "gain error",
    ],
    site: Site::Encoder,
    scope: Scope::AnyJoint,
    needs: Needs::Nothing,
    on_slide: OnSlide::Same,
    law: "reading = factor * q",
    parameters: &[Parameter::of("factor", "angle read over true angle")
        .off(1.0)
        .typical(0.95, 1.05)
        .bounds(0.5, 2.0)
        .starts(&[0.98, 1.02])],
    looks_like: "an error in proportion to the angle from the encoder's zero, the same at rest and \
     in motion",
    confused_with: &[
        "mass: both make gravity look wrong over the angle; mass leaves the angle between two \
         stops alone",
        "armature: both change the acceleration that is read; armature leaves the angle between \
         two stops alone",
        "encoder_zero: the same at one angle; read at two stops far apart",
        "cogging: both make the torque wrong over the angle; a ripple leaves the angle between \
         two stops alone",
    ],
    experiment: "move between two stops at a known angle from each other",
    reference: "Mooring, Roth, Driels, Fundamentals of Manipulator Calibration (1991)",
};

impl Law for EncoderScale {
    fn encode(&self, values: &[f64], angle_rad: f64) -> f64 {
        values[0] * angle_rad
    }

    fn slope(&self, values: &[f64], _at: &AtRest) -> Option<Slope> {
        Some(Slope {
            gain: values[0],
            ..Slope::NONE
        })
    }
}
