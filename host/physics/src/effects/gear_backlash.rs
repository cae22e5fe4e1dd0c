//! Backlash of the gear: motor and joint, each with its inertia, meet at either flank of a gap.

use super::armature::{ROTOR, ROTOR_ON_SLIDE};
use super::{EffectInfo, Gear, Law, Needs, OnSlide, Parameter, Scope, Site, StartUnknown};

/// No torque within the gap; at its ends flanks that push, never pull, and do not rebound.
#[derive(Debug)]
pub struct GearBacklash;

pub(super) static INFO: EffectInfo = EffectInfo {
    id: "gear_backlash",
    title: "backlash of the gear",
    aliases: &[
        "play",
        "gear play",
        "lash",
        "slop",
        "free play",
        "hysteresis",
        "lost motion",
        "dead space",
    ],
    site: Site::Gear,
    scope: Scope::DrivenJoint,
    needs: Needs::Nothing,
    on_slide: OnSlide::Own(&ON_SLIDE),
    law: "no torque while |q_m - q| < gap_rad / 2; at a flank w_m = w until the torque turns; \
     inertia_kg_m2 * d(w_m)/dt = motor - torque",
    parameters: &[
        ROTOR,
        Parameter::of("gap_rad", "free play, from flank to flank")
            .typical(0.005, 0.1)
            .bounds(0.0, 0.5)
            .starts(&[0.03, 0.1]),
    ],
    looks_like: "whenever the torque turns, the arm is free for a moment and then knocked; it \
     rattles about a point of no load",
    confused_with: &[
        "armature: without a gap the motor's inertia is always there; with one it comes and goes",
        "gear_compliance: both let motor and joint part; backlash by the same angle under any \
         load, a spring in proportion to it",
        "backlash: the joint's own reading shows it only where the play lies before the encoder",
        "dead_zone: both leave the arm alone about no command; a dead zone at rest, too, backlash \
         only until the motor is across",
    ],
    experiment: "drive small steps about hanging, where the load turns, and about an angle where \
     gravity holds the gear at one flank: the knocks must be gone there",
    reference: "Nordin, Gutman, Automatica 38 (2002) 1633, section 2",
};

/// At a joint that slides.
static ON_SLIDE: EffectInfo = EffectInfo {
    law: "no force while |q_m - q| < gap_m / 2; at a flank w_m = w until the force turns; \
     inertia_kg * d(w_m)/dt = motor - force",
    parameters: &[
        ROTOR_ON_SLIDE,
        Parameter::of("gap_m", "free play, from flank to flank")
            .typical(0.0002, 0.005)
            .bounds(0.0, 0.1)
            .starts(&[0.001, 0.003]),
    ],
    ..INFO
};

impl Law for GearBacklash {
    fn difference(&self) -> f64 {
        5e-2
    }

    /// Where in its play the motor is.
    fn start_unknown(&self, _values: &[f64]) -> Option<StartUnknown> {
        Some(StartUnknown::Body)
    }

    fn gear(&self, values: &[f64], gear: &mut Gear) {
        gear.inertia_kg_m2 += values[0];
        gear.gap_rad += values[1];
    }
}
