//! A servo's mode, which says what its moving speed is.

use handstand_shared::message::ArmLimits;
use handstand_shared::raw::Signed;

/// Angle limits other than 0 make a joint, both 0 a wheel that turns without end.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum ServoMode {
    /// It was not asked, or its answer was lost.
    Unknown,
    /// The moving speed limits its speed on the way to a goal; 0 is
    /// [`MovingSpeed::UNLIMITED`](handstand_shared::raw::MovingSpeed::UNLIMITED).
    Joint,
    /// The moving speed is its command.
    Wheel,
}

impl ServoMode {
    /// The code of the moving speed it is armed with: a limit, or standstill. None of an unknown
    /// mode: the code of standstill would lift the limit of a joint.
    pub fn moving_speed(self, limits: ArmLimits) -> Option<u16> {
        match self {
            ServoMode::Unknown => None,
            ServoMode::Joint => Some(limits.speed.0),
            ServoMode::Wheel => Some(Signed::new(0).0),
        }
    }
}
