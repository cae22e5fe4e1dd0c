//! Gear compliance: the motor turns its joint through a spring.

use super::armature::{ROTOR, ROTOR_ON_SLIDE};
use super::{EffectInfo, Gear, Law, Needs, OnSlide, Parameter, Scope, Site, StartUnknown};

/// k (q_m - q) + c (w_m - w) on the joint, and its reaction on a motor of inertia J, both as seen
/// at the joint; c by the damping ratio c / (2 sqrt(k J)).
#[derive(Debug)]
pub struct GearCompliance;

/// Damping of the spring, as a share of what lets the motor settle without ringing.
const DAMPING: Parameter = Parameter::of(
    "damping_ratio",
    "damping, as a share of what lets the motor settle without ringing",
)
.typical(0.02, 0.3)
.bounds(0.0, 0.7)
.starts(&[0.15]);

pub(super) static INFO: EffectInfo = EffectInfo {
    id: "gear_compliance",
    title: "compliance of the gear",
    aliases: &[
        "compliance",
        "elasticity",
        "elastic",
        "flex",
        "flexibility",
        "flexible joint",
        "joint elasticity",
        "joint flexibility",
        "series elasticity",
        "gear stiffness",
        "stiffness",
        "torsional spring",
        "spring",
        "wind-up",
        "belt stretch",
    ],
    site: Site::Gear,
    scope: Scope::DrivenJoint,
    needs: Needs::Nothing,
    on_slide: OnSlide::Own(&ON_SLIDE),
    law: "torque = stiffness_nm_rad * (q_m - q) + c * (w_m - w), c = 2 * damping_ratio * \
     sqrt(stiffness_nm_rad * inertia_kg_m2); inertia_kg_m2 * d(w_m)/dt = motor - torque",
    parameters: &[
        ROTOR,
        Parameter::of(
            "stiffness_nm_rad",
            "torque per angle by which the motor is ahead of the joint",
        )
        .typical(0.5, 50.0)
        .bounds(0.05, 5000.0)
        .starts(&[1.0, 4.0]),
        DAMPING,
    ],
    looks_like: "after a step of the drive the arm rings at a frequency that gravity does not \
     make, and it starts late; slow motions are right",
    confused_with: &[
        "drive_lag: both answer late; only a spring rings",
        "armature: a stiff gear is an inertia alone; only a spring rings and answers fast \
         commands late",
        "gear_backlash: both let motor and joint part; a spring parts in proportion to the load, \
         backlash by the same angle under any load",
        "delay: both answer late; a delay does not ring",
        "base_compliance: both ring; a gear rings at its own joint, a base at all of them, with \
         torque off as well",
    ],
    experiment: "drive a chirp through the resonance with two loads: its frequency must fall with \
     the heavier one; then swing with torque off",
    reference: "Spong, ASME J. Dyn. Syst. Meas. Control 109 (1987) 310",
};

/// At a joint that slides.
static ON_SLIDE: EffectInfo = EffectInfo {
    law: "force = stiffness_n_m * (q_m - q) + c * (w_m - w), c = 2 * damping_ratio * \
     sqrt(stiffness_n_m * inertia_kg); inertia_kg * d(w_m)/dt = motor - force",
    parameters: &[
        ROTOR_ON_SLIDE,
        Parameter::of(
            "stiffness_n_m",
            "force per displacement by which the motor is ahead of the joint",
        )
        .typical(50.0, 50_000.0)
        .bounds(1.0, 1e7)
        .starts(&[100.0, 1000.0]),
        DAMPING,
    ],
    ..INFO
};

impl Law for GearCompliance {
    fn difference(&self) -> f64 {
        2e-3
    }

    /// How far the gear is wound up.
    fn start_unknown(&self, _values: &[f64]) -> Option<StartUnknown> {
        Some(StartUnknown::Body)
    }

    fn gear(&self, values: &[f64], gear: &mut Gear) {
        gear.inertia_kg_m2 += values[0];
        gear.stiffness_nm_rad = values[1];
        gear.damping_ratio = values[2];
    }
}
