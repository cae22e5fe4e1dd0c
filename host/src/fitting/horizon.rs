//! For how long a model runs uncorrected, and the windows that follow from it.

use crate::log::Motion;
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

/// Windows as long as the horizon and the motion's own, in which its errors stay small, allow.
pub(super) fn cut(motions: &[Motion], stable: &[Horizon], horizon: Horizon) -> Vec<Window> {
    let mut windows = Vec::new();
    for (motion, (log, stable)) in motions.iter().zip(stable).enumerate() {
        let pieces = match stable.shorter(horizon) {
            Horizon::Whole => 1,
            Horizon::Seconds(seconds) => {
                let most = (log.len() / 5).max(1);
                ((log.duration_s() / seconds).round() as usize).clamp(1, most)
            }
        };
        let edge = |piece: usize| piece * log.len() / pieces;
        windows.extend((0..pieces).map(|piece| Window {
            motion,
            samples: edge(piece)..edge(piece + 1),
        }));
    }
    windows
}
