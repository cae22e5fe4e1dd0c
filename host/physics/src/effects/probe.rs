//! Free-form terms: bumps of torque, reading or timing that belong to no physical law.
//!
//! What a sum of them gains on held-out motions is what a right term, still unknown, could gain:
//! the measure of how much is left to explain.

use super::{
    DriveState, Effect, EffectInfo, Encoded, JointState, Law, Needs, OnSlide, Parameter, Rig,
    Scope, SenseMemory, Site,
};

/// Which variable a probe bumps on; stored as its index in a probe's second value.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ProbeVariable {
    /// Torque, a bump in speed.
    Speed,
    /// Torque against the motion, a bump in angle.
    FrictionInAngle,
    /// Torque against the motion, growing with the drive's torque.
    FrictionUnderLoad,
    /// Torque, a bump in angle.
    Angle,
    /// Torque, sin(N q); the centre is N.
    SineOfAngle,
    /// Torque, cos(N q); the centre is N.
    CosineOfAngle,
    /// Torque, a bump in the drive's torque.
    DriveTorque,
    /// Drive torque in proportion to supply.
    Supply,
    /// Drive torque falling with speed.
    BackEmf,
    /// The input late by the centre, s.
    Delay,
    /// More inertia.
    Inertia,
    /// More mass.
    Mass,
    /// Gravity turned with the rig.
    Tilt,
    /// Reading, a bump in angle.
    Reading,
    /// Reading, in proportion to speed.
    ReadingLag,
    /// Reading, by the sign of the speed.
    ReadingBacklash,
}

impl ProbeVariable {
    /// Every one, in the order of its index.
    pub const ALL: [ProbeVariable; 16] = [
        ProbeVariable::Speed,
        ProbeVariable::FrictionInAngle,
        ProbeVariable::FrictionUnderLoad,
        ProbeVariable::Angle,
        ProbeVariable::SineOfAngle,
        ProbeVariable::CosineOfAngle,
        ProbeVariable::DriveTorque,
        ProbeVariable::Supply,
        ProbeVariable::BackEmf,
        ProbeVariable::Delay,
        ProbeVariable::Inertia,
        ProbeVariable::Mass,
        ProbeVariable::Tilt,
        ProbeVariable::Reading,
        ProbeVariable::ReadingLag,
        ProbeVariable::ReadingBacklash,
    ];

    /// Index in [`ProbeVariable::ALL`], as a probe's second value.
    pub fn index(self) -> f64 {
        f64::from(self as u8)
    }

    /// What the term depends on, in words.
    pub fn words(self) -> &'static str {
        match self {
            ProbeVariable::Speed => "a torque that depends on speed",
            ProbeVariable::FrictionInAngle => "friction that depends on the angle",
            ProbeVariable::FrictionUnderLoad => "friction that depends on the load",
            ProbeVariable::Angle => "a torque that depends on the angle",
            ProbeVariable::SineOfAngle | ProbeVariable::CosineOfAngle => {
                "a torque that ripples with the angle"
            }
            ProbeVariable::DriveTorque => "a drive torque that is not what it was told",
            ProbeVariable::Supply => "a drive torque that depends on the supply",
            ProbeVariable::BackEmf => "a drive torque that depends on the speed",
            ProbeVariable::Delay => "an input that acts at another time",
            ProbeVariable::Inertia => "an inertia that is off",
            ProbeVariable::Mass => "a mass that is off",
            ProbeVariable::Tilt => "gravity from another direction",
            ProbeVariable::Reading => "a reading that depends on the angle",
            ProbeVariable::ReadingLag => "a reading that depends on the speed",
            ProbeVariable::ReadingBacklash => "a reading that depends on the direction of motion",
        }
    }

    /// The probe whose hook serves this variable.
    pub fn probe(self) -> Effect {
        match self {
            ProbeVariable::Supply | ProbeVariable::BackEmf => DRIVE_PROBE,
            ProbeVariable::Delay => TIMING_PROBE,
            ProbeVariable::Inertia | ProbeVariable::Mass | ProbeVariable::Tilt => BODY_PROBE,
            ProbeVariable::Reading => ENCODER_PROBE,
            ProbeVariable::ReadingLag | ProbeVariable::ReadingBacklash => SENSOR_PROBE,
            _ => JOINT_PROBE,
        }
    }
}

/// A free-form term at one site; values are amplitude, variable, centre, width.
#[derive(Debug)]
struct Probe;

pub(super) static TIMING_PROBE: Effect =
    Effect::of(&Probe, &const { info("timing_probe", Site::Timing) });
pub(super) static DRIVE_PROBE: Effect =
    Effect::of(&Probe, &const { info("drive_probe", Site::Drive) });
pub(super) static JOINT_PROBE: Effect =
    Effect::of(&Probe, &const { info("joint_probe", Site::Joint) });
pub(super) static BODY_PROBE: Effect =
    Effect::of(&Probe, &const { info("body_probe", Site::Body) });
pub(super) static ENCODER_PROBE: Effect =
    Effect::of(&Probe, &const { info("encoder_probe", Site::Encoder) });
pub(super) static SENSOR_PROBE: Effect =
    Effect::of(&Probe, &const { info("sensor_probe", Site::Sensor) });

const fn info(id: &'static str, site: Site) -> EffectInfo {
    EffectInfo {
        id,
        title: "free-form term",
        aliases: &[],
        site,
        scope: Scope::AnyJoint,
        needs: Needs::Nothing,
        on_slide: OnSlide::Same,
        law: "amplitude * bump((variable - centre) / width)",
        parameters: PARAMETERS,
        looks_like: "whatever is left",
        confused_with: &[],
        experiment: "none",
        reference: "radial-basis regression of a residual",
    }
}

const PARAMETERS: &[Parameter] = &[
    value("amplitude", 1.0),
    value("variable", 0.0),
    value("centre", 0.0),
    value("width", 1.0),
];

const fn value(key: &'static str, typical: f64) -> Parameter {
    Parameter {
        key,
        unit: "",
        meaning: "of the free-form term",
        off: Some(0.0),
        typical: (0.0, typical),
        bounds: (f64::NEG_INFINITY, f64::INFINITY),
        starts: &[0.0],
    }
}

fn variable(values: &[f64]) -> ProbeVariable {
    ProbeVariable::ALL[values[1] as usize]
}

/// A triangle of unit height, one at the centre and zero a width away.
fn bump(x: f64, values: &[f64]) -> f64 {
    (1.0 - ((x - values[2]) / values[3]).abs()).max(0.0)
}

impl Law for Probe {
    fn delay_s(&self, values: &[f64]) -> f64 {
        values[0].max(0.0)
    }

    fn drive(&self, values: &[f64], torque_nm: f64, at: &DriveState) -> f64 {
        torque_nm
            + values[0]
                * match variable(values) {
                    ProbeVariable::Supply => torque_nm * (at.supply_ratio - 1.0),
                    _ => -at.full_torque_nm * at.speed_rad_s,
                }
    }

    fn torque(&self, values: &[f64], at: &JointState) -> f64 {
        values[0]
            * match variable(values) {
                ProbeVariable::FrictionInAngle => {
                    -at.speed_rad_s.signum() * bump(at.angle_rad, values)
                }
                ProbeVariable::FrictionUnderLoad => -at.speed_rad_s.signum() * at.drive_nm.abs(),
                ProbeVariable::Angle => bump(at.angle_rad, values),
                ProbeVariable::SineOfAngle => (values[2] * at.angle_rad).sin(),
                ProbeVariable::CosineOfAngle => (values[2] * at.angle_rad).cos(),
                ProbeVariable::DriveTorque => bump(at.drive_nm, values),
                _ => bump(at.speed_rad_s, values),
            }
    }

    fn body(&self, values: &[f64], joint: usize, rig: &mut Rig) {
        match variable(values) {
            ProbeVariable::Inertia => rig.add_armature(joint, values[0]),
            ProbeVariable::Mass => *rig.mass_kg(joint) += values[0],
            _ => rig.gravity_turn_rad += if rig.turned { -values[0] } else { values[0] },
        }
    }

    fn encode(&self, values: &[f64], angle_rad: f64) -> f64 {
        match variable(values) {
            ProbeVariable::Reading => angle_rad + values[0] * bump(angle_rad, values),
            _ => angle_rad,
        }
    }

    fn sense(
        &self,
        values: &[f64],
        memory: &mut Option<SenseMemory>,
        encoded: Encoded,
        step_s: f64,
    ) -> f64 {
        let angle_rad = encoded.angle_rad;
        let before = memory.map_or(angle_rad, |m| m.encoded);
        *memory = Some(SenseMemory::reads(angle_rad, angle_rad));
        let moved = angle_rad - before;
        if moved == 0.0 || step_s == 0.0 {
            return angle_rad;
        }
        angle_rad
            + values[0]
                * match variable(values) {
                    ProbeVariable::ReadingLag => moved / step_s,
                    ProbeVariable::ReadingBacklash => moved.signum(),
                    _ => 0.0,
                }
    }
}
