//! Effects that a linear model leaves out.

use crate::effects::{Effect, Site};
use std::fmt;

/// An effect without a derivative at the operating point: the linear model does without it, the
/// robot does not.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OmittedEffect {
    /// The effect.
    pub effect: Effect,
    /// Its joint, counted from 0; none for the whole rig.
    pub joint: Option<usize>,
    /// What keeps it from having a derivative.
    pub why: NonSmooth,
}

/// What keeps an effect from having a derivative at the operating point.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum NonSmooth {
    /// Friction changes its sign with the speed.
    JumpsAtStandstill,
    /// Small commands have no effect.
    DeadAtZero,
    /// The torque is at its limit.
    AtLimit,
    /// The motor turns apart from the joint: a state of its own.
    OwnState,
    /// The base moves: a state of its own.
    BaseMoves,
    /// The reading depends on the past.
    Memory,
    /// The effect states no derivative.
    Unstated,
}

impl OmittedEffect {
    pub(super) fn new(effect: Effect, joint: Option<usize>) -> OmittedEffect {
        let why = match effect.info().site {
            Site::Friction => NonSmooth::JumpsAtStandstill,
            Site::Command => NonSmooth::DeadAtZero,
            Site::Drive => NonSmooth::AtLimit,
            Site::Gear => NonSmooth::OwnState,
            Site::Sensor => NonSmooth::Memory,
            Site::Body => NonSmooth::BaseMoves,
            Site::Timing | Site::Joint | Site::Encoder | Site::Rate => NonSmooth::Unstated,
        };
        OmittedEffect { effect, joint, why }
    }
}

impl fmt::Display for NonSmooth {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            NonSmooth::JumpsAtStandstill => "its torque jumps at standstill",
            NonSmooth::DeadAtZero => "it has no derivative at small commands",
            NonSmooth::AtLimit => "the pose takes all of the torque that it leaves",
            NonSmooth::OwnState => {
                "its motor turns apart from the joint; its inertia is in the design"
            }
            NonSmooth::BaseMoves => "the design stands on a base that does not move",
            NonSmooth::Memory => "its reading depends on the past",
            NonSmooth::Unstated => "it states no derivative",
        })
    }
}
