//! Pre-sliding: before dry friction breaks away, it is a spring.

use super::memory::remembered;
use super::{
    AtRest, EffectInfo, JointState, Law, MemoryCell, Needs, OnSlide, Parameter, Scope, Site, Slope,
    StartUnknown, StepState,
};

/// Dahl's law: -k z, dz/dq = 1 - (k z / f) sgn(dq). It remembers the deflection z and the angle at
/// which it was that; within a step, over which the joint goes one way, the law has a closed form
/// in the angle.
#[derive(Debug)]
pub struct PreSliding;

pub(super) static INFO: EffectInfo = EffectInfo {
    id: "pre_sliding",
    title: "pre-sliding friction",
    aliases: &[
        "Dahl",
        "Dahl model",
        "LuGre",
        "LuGre model",
        "bristle",
        "bristle model",
        "microslip",
        "hysteresis",
        "friction",
    ],
    site: Site::Joint,
    scope: Scope::AnyJoint,
    needs: Needs::Nothing,
    on_slide: OnSlide::Own(&ON_SLIDE),
    law: "torque = -stiffness_nm_rad * z, dz/dq = 1 - stiffness_nm_rad * z / torque_nm * sgn(dq)",
    parameters: &[
        Parameter::of("torque_nm", "friction once it slides")
            .off(0.0)
            .typical(0.005, 0.1)
            .bounds(0.0, 5.0)
            .starts(&[0.02, 0.06]),
        Parameter::of("stiffness_nm_rad", "torque per angle before it slides")
            .typical(0.1, 5.0)
            .bounds(0.01, 500.0)
            .starts(&[1.0, 0.3]),
    ],
    looks_like: "small motions are sprung and come back; after each reversal friction builds up \
     over a fixed angle instead of at once",
    confused_with: &[
        "coulomb: over large angles both are one torque against the motion; move within a degree",
        "cable_spring: both are sprung about a point; the point of pre-sliding moves along with \
         every larger motion",
        "stribeck: both make joints stick; only a spring moves on small pushes",
    ],
    experiment: "push the joint to and fro by less than a degree, then by ten: the width of the \
     loop over angle must stay a fixed angle",
    reference: "Dahl, A Solid Friction Model (1968), TOR-0158(3107-18)-1; Canudas de Wit et al., \
     IEEE TAC 40 (1995) 419",
};

/// At a joint that slides.
static ON_SLIDE: EffectInfo = EffectInfo {
    law: "force = -stiffness_n_m * z, dz/dq = 1 - stiffness_n_m * z / force_n * sgn(dq)",
    parameters: &[
        Parameter::of("force_n", "friction once it slides")
            .off(0.0)
            .typical(0.05, 10.0)
            .bounds(0.0, 1000.0)
            .starts(&[0.5, 5.0]),
        Parameter::of("stiffness_n_m", "force per displacement before it slides")
            .typical(10.0, 10000.0)
            .bounds(0.1, 1e6)
            .starts(&[300.0, 3000.0]),
    ],
    ..INFO
};

/// Speed, rad/s (m/s), well above which a joint that begins in motion is taken to slide.
const SLIDES_AT: f64 = 0.05;

/// How far the contact is bent, and at which angle of the joint.
struct Bent {
    deflection_rad: f64,
    angle_rad: f64,
}
remembered!(Bent {
    deflection_rad,
    angle_rad
});

impl Law for PreSliding {
    fn difference(&self) -> f64 {
        5e-3
    }

    fn remembers(&self) -> bool {
        true
    }

    fn recall(&self, values: &[f64], at: &StepState) -> MemoryCell {
        let speed = at.speed_rad_s;
        Bent {
            deflection_rad: slid(values) * speed / (speed.abs() + SLIDES_AT),
            angle_rad: at.angle_rad,
        }
        .into()
    }

    fn start_unknown(&self, values: &[f64]) -> Option<StartUnknown> {
        Some(StartUnknown::Displacement { most: slid(values) })
    }

    fn recall_unknown(&self, _values: &[f64], unknown: f64, at: &StepState) -> MemoryCell {
        Bent {
            deflection_rad: unknown,
            angle_rad: at.angle_rad,
        }
        .into()
    }

    fn displacement(&self, memory: MemoryCell) -> f64 {
        Bent::from(memory).deflection_rad
    }

    fn remember(&self, values: &[f64], memory: &mut MemoryCell, at: &StepState, _step_s: f64) {
        let angle_rad = at.angle_rad;
        *memory = Bent {
            deflection_rad: deflection(values, (*memory).into(), angle_rad),
            angle_rad,
        }
        .into();
    }

    fn torque(&self, values: &[f64], at: &JointState) -> f64 {
        -values[1] * deflection(values, at.memory.into(), at.angle_rad)
    }

    /// None: what is a spring within a degree holds nothing beyond.
    fn slope(&self, values: &[f64], _at: &AtRest) -> Option<Slope> {
        (values[0] == 0.0).then_some(Slope::NONE)
    }
}

/// Deflection at which it slides.
fn slid(values: &[f64]) -> f64 {
    values[0] / values[1]
}

/// Deflection at an angle, reached without a turn from what is remembered.
fn deflection(values: &[f64], before: Bent, angle_rad: f64) -> f64 {
    let (most, way_rad) = (slid(values), angle_rad - before.angle_rad);
    if most <= 0.0 {
        return 0.0;
    }
    let end = most * way_rad.signum();
    end + (before.deflection_rad - end) * (-way_rad.abs() / most).exp()
}
