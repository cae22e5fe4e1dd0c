//! For how long a model runs uncorrected, and the windows that follow from it.

use std::ops::Range;

/// How long the model runs at most before it starts again from a state fitted to the measurement.
/// Where start errors grow fast, it starts again earlier.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Horizon {
    /// From the first sample of a motion to the last where that motion is stable: free run.
    Whole,
    /// Windows of about this many seconds, or shorter: multiple shooting.
    Seconds(f64),
}

impl Horizon {
    /// Length of a window, s; absent for whole motions.
    pub fn seconds(self) -> Option<f64> {
        match self {
            Horizon::Whole => None,
            Horizon::Seconds(seconds) => Some(seconds),
        }
    }

    /// Windows of this many seconds; whole motions without.
    pub fn from_seconds(seconds: Option<f64>) -> Self {
        seconds.map_or(Horizon::Whole, Horizon::Seconds)
    }

    /// The longer of two.
    pub(super) fn longer(self, other: Horizon) -> Self {
        let seconds = self.seconds().zip(other.seconds());
        Horizon::from_seconds(seconds.map(|(own, others)| own.max(others)))
    }

    /// The shorter of two.
    pub fn shorter(self, other: Horizon) -> Self {
        let seconds = [self, other].into_iter().filter_map(Horizon::seconds);
        Horizon::from_seconds(seconds.min_by(f64::total_cmp))
    }
}

/// A stretch of one motion that is simulated without a restart.
#[derive(Debug, Clone, PartialEq)]
pub struct Window {
    /// Index of the motion.
    pub motion: usize,
    /// Its samples.
    pub samples: Range<usize>,
}
