//! Torque scale: the torque constant or the gear ratio differs from the data sheet.

use super::{
    AtRest, DriveState, Effect, EffectInfo, Law, Needs, OnSlide, Parameter, Scope, Site, Slope,
    ValueBehind,
};

/// s tau.
#[derive(Debug)]
struct TorqueScale;

static INFO: EffectInfo = EffectInfo {
    id: "torque_scale",
    title: "torque scale",
    aliases: &[
        "torque constant",
        "motor constant",
        "kt",
        "gain",
        "gain error",
        "motor gain",
    ],
    site: Site::Drive,
    scope: Scope::DrivenJoint,
    needs: Needs::Nothing,
    on_slide: OnSlide::Same,
    law: "factor * torque",
    parameters: &[
        Parameter::of("factor", "torque that arrives over torque in the model")
            .off(1.0)
            .typical(0.7, 1.3)
            .bounds(0.05, 10.0)
            .starts(&[0.85, 1.15]),
    ],
    looks_like: "every response to the drive is too strong or too weak by one share, at every \
     speed and in both directions",
    confused_with: &[
        "thermal_drift: both weaken every command; warmth comes with time and goes with rest",
        "mass: a heavier arm answers the drive less too, and one log may not tell; weigh the \
         link, or hold a known added mass",
        "supply_sag: the same at one duty; compare weak and strong commands",
        "supply_sensitivity: the same at one supply; repeat at a second one",
        "speed_limit: a wrong no-load speed also weakens the drive; hold a load at rest, where \
         only the scale remains",
    ],
    experiment: "hold a known mass at a known arm and compare the duty with the model",
    reference: "Siciliano, Sciavicco, Villani, Oriolo, Robotics: Modelling, Planning and Control \
     (2009), chapter 5",
};

/// The effect, by which readings of a drive's torque are tried.
pub static TORQUE_SCALE: Effect = Effect::of(&TorqueScale, &INFO);

impl Law for TorqueScale {
    fn value_behind(&self) -> Option<ValueBehind> {
        Some(ValueBehind::StallTorque)
    }

    fn drive(&self, values: &[f64], torque_nm: f64, _at: &DriveState) -> f64 {
        values[0] * torque_nm
    }

    fn slope(&self, values: &[f64], _at: &AtRest) -> Option<Slope> {
        Some(Slope {
            gain: values[0],
            ..Slope::NONE
        })
    }
}
