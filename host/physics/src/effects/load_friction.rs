//! Load friction: what the gear transmits presses its teeth together.

use super::{EffectInfo, FrictionState, Law, Needs, OnSlide, Parameter, Scope, Site};

/// k |tau_m - tau_e|, with motor torque tau_m and outside torque tau_e.
#[derive(Debug)]
pub struct LoadFriction;

pub(super) static INFO: EffectInfo = EffectInfo {
    id: "load_friction",
    title: "load-dependent friction of the gear",
    aliases: &[
        "gear friction",
        "gear efficiency",
        "efficiency",
        "load-dependent friction",
        "mesh friction",
        "friction",
    ],
    site: Site::Friction,
    scope: Scope::DrivenJoint,
    needs: Needs::GearLoad,
    on_slide: OnSlide::Same,
    law: "friction = factor * gear load, against the motion",
    parameters: &[
        Parameter::of("factor", "friction over the torque the gear transmits")
            .off(0.0)
            .typical(0.02, 0.3)
            .bounds(0.0, 2.0)
            .starts(&[0.05, 0.2]),
    ],
    looks_like: "the resistance grows where the arm is held level and falls where it hangs; a \
     heavier load sticks harder",
    confused_with: &[
        "position_friction: gravity loads the gear more the farther the arm is raised; change the \
         mass",
        "drive_asymmetry: the same where both of its factors are equal; compare a swing with torque \
         off with slow lifting",
        "coulomb: the same at one load; change the mass or the length of the arm",
        "air_drag: fast motion loads the gear too; repeat slowly, where only load friction \
         remains",
    ],
    experiment: "lift and lower slowly with two masses, and compare the width between lifting and \
     lowering",
    reference: "Duclusaud, Passault, Padois, Ly, Extended Friction Models for the Physics \
     Simulation of Servo Actuators, arXiv:2410.08650, model M3",
};

impl Law for LoadFriction {
    fn friction(&self, values: &[f64], at: &FrictionState) -> f64 {
        values[0] * at.gear_load_nm
    }
}
