//! Motions that a measurement needs, within given limits: excitation for identification.
//!
//! A multisine excites every joint at frequencies of its own, so that one joint's motion can be
//! told from another's (Schroeder 1970; Pintelon & Schoukens 2012, ch. 5); steps show delay and
//! saturation, slow triangles friction and backlash, holds breakaway and sag, and a drop with
//! torque off what friction there is without a drive.

mod goals;
mod limits;
mod multisine;
mod path;
mod table;

pub use goals::{Excitation, ExcitedMotion, JointExtent};
pub use limits::JointLimits;
pub use table::excite;

use serde::Serialize;

/// Kinds of motion, in the order in which they are played.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum ExcitationKind {
    /// Sums of sines, each joint at frequencies of its own.
    Multisine,
    /// Random levels, as fast as the speed limit allows.
    Steps,
    /// To and fro over the whole range, slowly.
    Triangles,
    /// Poses held still.
    Holds,
    /// Raised, then let go: torque off to the end.
    Drop,
}

/// All kinds.
pub const EXCITATION_KINDS: [ExcitationKind; 5] = [
    ExcitationKind::Multisine,
    ExcitationKind::Steps,
    ExcitationKind::Triangles,
    ExcitationKind::Holds,
    ExcitationKind::Drop,
];

impl ExcitationKind {
    /// Its name in options and results.
    pub fn name(self) -> &'static str {
        match self {
            ExcitationKind::Multisine => "multisine",
            ExcitationKind::Steps => "steps",
            ExcitationKind::Triangles => "triangles",
            ExcitationKind::Holds => "holds",
            ExcitationKind::Drop => "drop",
        }
    }
}

/// What to write.
#[derive(Debug, Clone, PartialEq)]
pub struct ExcitePlan {
    /// The joints.
    pub joints: Vec<JointLimits>,
    /// Kinds of motion, each once.
    pub kinds: Vec<ExcitationKind>,
    /// Duration of each kind, s.
    pub each_s: f64,
    /// Samples per second.
    pub hz: f64,
    /// Lowest and highest frequency of the multisine, Hz.
    pub band_hz: (f64, f64),
    /// Seed of phases, levels and poses.
    pub seed: u64,
}

#[cfg(test)]
mod tests;
