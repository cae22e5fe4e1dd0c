//! The numbers of links and joints: key, range, and where they are kept.

use super::{Drive, Joint, Link};
use crate::effects::Axis;

/// Range of a quantity that must be above zero; far wider than any rig on a bench.
pub(super) const POSITIVE: (f64, f64) = (1e-9, 1e3);

/// A link's moment of inertia about its joint, in place of that about its centre of mass.
pub(super) const JOINT_INERTIA: &str = "joint_inertia_kg_m2";

/// A number of a link.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum LinkField {
    /// Joint to next joint, m.
    Length,
    /// Joint to centre of mass, m.
    Com,
    /// Mass, kg.
    Mass,
    /// Moment of inertia about the centre of mass, kg m^2.
    Inertia,
}

impl LinkField {
    /// Every one, in the order of a model file.
    pub const ALL: [LinkField; 4] = [
        LinkField::Length,
        LinkField::Com,
        LinkField::Mass,
        LinkField::Inertia,
    ];

    /// Key in model files; it ends in the unit.
    pub fn key(self) -> &'static str {
        match self {
            LinkField::Length => "length_m",
            LinkField::Com => "com_m",
            LinkField::Mass => "mass_kg",
            LinkField::Inertia => "inertia_kg_m2",
        }
    }

    pub(super) fn bounds(self) -> (f64, f64) {
        match self {
            // A counterweight's centre of mass lies behind its joint.
            LinkField::Com => (-POSITIVE.1, POSITIVE.1),
            LinkField::Length | LinkField::Mass | LinkField::Inertia => POSITIVE,
        }
    }

    pub(super) fn of(self, link: &mut Link) -> &mut f64 {
        match self {
            LinkField::Length => &mut link.length_m,
            LinkField::Com => &mut link.com_m,
            LinkField::Mass => &mut link.mass_kg,
            LinkField::Inertia => &mut link.inertia_kg_m2,
        }
    }
}

/// A number of a joint's drive.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum JointField {
    /// Position drive: duty per rad of error.
    GainPerRad,
    /// Speed drive: duty per rad/s of error.
    GainSPerRad,
    /// Torque at standstill, N m.
    StallTorque,
    /// Speed without load, rad/s.
    NoLoadSpeed,
    /// Position drive of a slide: duty per m of error.
    GainPerM,
    /// Speed drive of a slide: duty per m/s of error.
    GainSPerM,
    /// Force of a slide at standstill, N.
    StallForce,
    /// Speed of a slide without load, m/s.
    NoLoadLinearSpeed,
}

impl JointField {
    /// Every one, in the order of a model file: those of hinges, then those of slides.
    pub const ALL: [JointField; 8] = [
        JointField::GainPerRad,
        JointField::GainSPerRad,
        JointField::StallTorque,
        JointField::NoLoadSpeed,
        JointField::GainPerM,
        JointField::GainSPerM,
        JointField::StallForce,
        JointField::NoLoadLinearSpeed,
    ];

    /// Key in model files; it ends in the unit.
    pub fn key(self) -> &'static str {
        match self {
            JointField::GainPerRad => "gain_per_rad",
            JointField::GainSPerRad => "gain_s_per_rad",
            JointField::StallTorque => "stall_torque_nm",
            JointField::NoLoadSpeed => "no_load_speed_rad_s",
            JointField::GainPerM => "gain_per_m",
            JointField::GainSPerM => "gain_s_per_m",
            JointField::StallForce => "stall_force_n",
            JointField::NoLoadLinearSpeed => "no_load_speed_m_s",
        }
    }

    /// How the joints move that have it.
    pub(super) fn axis(self) -> Axis {
        match self {
            JointField::GainPerRad
            | JointField::GainSPerRad
            | JointField::StallTorque
            | JointField::NoLoadSpeed => Axis::Hinge,
            JointField::GainPerM
            | JointField::GainSPerM
            | JointField::StallForce
            | JointField::NoLoadLinearSpeed => Axis::Slide,
        }
    }

    pub(super) fn of(self, joint: &mut Joint) -> Option<&mut f64> {
        use JointField as F;
        if joint.axis() != self.axis() {
            return None;
        }
        match (self, &mut joint.drive) {
            (F::GainPerRad | F::GainPerM, Drive::Position { gain_per_rad, .. }) => {
                Some(gain_per_rad)
            }
            (F::GainSPerRad | F::GainSPerM, Drive::Speed { gain_s_per_rad, .. }) => {
                Some(gain_s_per_rad)
            }
            (F::StallTorque | F::StallForce, drive) => {
                Some(&mut drive.motor_mut()?.stall_torque_nm)
            }
            (F::NoLoadSpeed | F::NoLoadLinearSpeed, drive) => {
                Some(&mut drive.motor_mut()?.no_load_speed_rad_s)
            }
            _ => None,
        }
    }
}
