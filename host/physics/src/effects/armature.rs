//! Armature: the rotor, seen through the gear, adds inertia without weight.

use super::{EffectInfo, Law, Needs, OnSlide, Parameter, Rig, Scope, Site};

/// J + N^2 J_r at the joint, with gear ratio N and rotor inertia J_r.
#[derive(Debug)]
pub struct Armature;

/// Inertia of the rotor as seen at the joint.
pub(super) const ROTOR: Parameter = Parameter::of(
    "inertia_kg_m2",
    "rotor inertia times the square of the gear ratio",
)
.off(0.0)
.typical(0.0005, 0.02)
.bounds(0.0, 1.0)
.starts(&[0.002, 0.01]);

/// The same at a joint that slides.
pub(super) const ROTOR_ON_SLIDE: Parameter = Parameter::of(
    "inertia_kg",
    "rotor inertia over the square of the displacement per turn in rad",
)
.off(0.0)
.typical(0.01, 1.0)
.bounds(0.0, 100.0)
.starts(&[0.05, 0.3]);

pub(super) static INFO: EffectInfo = EffectInfo {
    id: "armature",
    title: "armature inertia",
    aliases: &[
        "rotor inertia",
        "rotor",
        "motor inertia",
        "reflected inertia",
        "gear inertia",
        "inertia",
        "added inertia",
    ],
    site: Site::Body,
    scope: Scope::DrivenJoint,
    needs: Needs::Nothing,
    on_slide: OnSlide::Own(&ON_SLIDE),
    law: "inertia at the joint + inertia_kg_m2, without weight",
    parameters: &[ROTOR],
    looks_like: "the arm starts and stops late, yet holds still at the right duty; a free swing is \
     slower than the model says",
    confused_with: &[
        "gear_backlash: with a gap the motor's inertia comes and goes as the load turns",
        "gear_compliance: a stiff gear is an inertia alone; only a spring rings and answers fast \
         commands late",
        "base_compliance: both change how fast the arm swings, not how it hangs; a base that gives \
         swings on by itself, in all joints at once",
        "mass: both make the arm sluggish; mass also adds gravity: hold still first",
        "encoder_scale: both change the acceleration that is read; a scale also changes the angle \
         between two stops",
    ],
    experiment: "hold still at several angles, then swing freely with and without the motor in \
     gear",
    reference: "Siciliano, Sciavicco, Villani, Oriolo, Robotics: Modelling, Planning and Control \
     (2009), chapter 7",
};

/// At a joint that slides.
static ON_SLIDE: EffectInfo = EffectInfo {
    law: "mass along the slide + inertia_kg, without weight",
    parameters: &[ROTOR_ON_SLIDE],
    ..INFO
};

impl Law for Armature {
    fn comes_with_servo(&self) -> Option<bool> {
        Some(true)
    }

    fn body(&self, values: &[f64], joint: usize, rig: &mut Rig) {
        rig.add_armature(joint, values[0]);
    }
}
