//! Drive/backdrive asymmetry: of the motor's torque a gear loses another share than of the load's.

use super::{EffectInfo, FrictionState, Law, Needs, OnSlide, Parameter, Scope, Site};

/// |k_m tau_m - k_e tau_e|, with motor torque tau_m and outside torque tau_e.
#[derive(Debug)]
pub struct DriveAsymmetry;

pub(super) static INFO: EffectInfo = EffectInfo {
    id: "drive_asymmetry",
    title: "drive/backdrive asymmetry of the gear",
    aliases: &[
        "back-drivability",
        "backdriving",
        "gear efficiency",
        "efficiency",
        "worm gear",
        "self-locking",
        "friction",
    ],
    site: Site::Friction,
    scope: Scope::DrivenJoint,
    needs: Needs::GearLoad,
    on_slide: OnSlide::Same,
    law: "friction = |motor_factor * motor torque - outside_factor * outside torque|, against the \
          motion",
    parameters: &[
        Parameter::of(
            "motor_factor",
            "share of the motor's torque that the gear loses",
        )
        .off(0.0)
        .typical(0.02, 0.3)
        .bounds(0.0, 2.0)
        .starts(&[0.2, 0.05]),
        Parameter::of(
            "outside_factor",
            "share of the outside torque that the gear loses",
        )
        .off(0.0)
        .typical(0.02, 0.3)
        .bounds(0.0, 2.0)
        .starts(&[0.05, 0.2]),
    ],
    looks_like: "lifting a load loses another share of the torque than lowering it; with torque \
                 off the arm swings with less friction, or more, than under its drive",
    confused_with: &[
        "position_friction: lifting and lowering differ over angle too; change the mass",
        "load_friction: the same where both factors are equal; compare a swing with torque off \
         with slow lifting",
        "coulomb: the same at one load; change the mass or the length of the arm",
    ],
    experiment: "lift and lower slowly with two masses, then let the arm swing with torque off",
    reference: "Duclusaud, Passault, Padois, Ly, Extended Friction Models for the Physics \
                Simulation of Servo Actuators, arXiv:2410.08650, model M5",
};

impl Law for DriveAsymmetry {
    fn friction(&self, values: &[f64], at: &FrictionState) -> f64 {
        (values[0] * at.motor_nm - values[1] * at.outside_nm).abs()
    }
}
