//! The numbers of links and joints: key, range, and where they are kept.

use super::{Drive, Link};

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
}

impl JointField {
    /// Every one, in the order of a model file.
    pub const ALL: [JointField; 4] = [
        JointField::GainPerRad,
        JointField::GainSPerRad,
        JointField::StallTorque,
        JointField::NoLoadSpeed,
    ];

    /// Key in model files; it ends in the unit.
    pub fn key(self) -> &'static str {
        match self {
            JointField::GainPerRad => "gain_per_rad",
            JointField::GainSPerRad => "gain_s_per_rad",
            JointField::StallTorque => "stall_torque_nm",
            JointField::NoLoadSpeed => "no_load_speed_rad_s",
        }
    }

    pub(super) fn of(self, drive: &mut Drive) -> Option<&mut f64> {
        match (self, drive) {
            (JointField::GainPerRad, Drive::Position { gain_per_rad, .. }) => Some(gain_per_rad),
            (JointField::GainSPerRad, Drive::Speed { gain_s_per_rad, .. }) => Some(gain_s_per_rad),
            (JointField::StallTorque, drive) => Some(&mut drive.motor_mut()?.stall_torque_nm),
            (JointField::NoLoadSpeed, drive) => Some(&mut drive.motor_mut()?.no_load_speed_rad_s),
            _ => None,
        }
    }
}
