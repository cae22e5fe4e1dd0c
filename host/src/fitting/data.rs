//! Motions cut into windows, with the weight of each joint's residual.

use super::noise::noise_rad;
use crate::log::Motion;
use crate::model::Model;
use std::ops::Range;

/// How long the model runs before it starts again from a state fitted to the measurement.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Horizon {
    /// From the first sample of a motion to the last: free run.
    Whole,
    /// Windows of about this many seconds: multiple shooting.
    Seconds(f64),
}

/// A stretch of one motion that is simulated without a restart.
#[derive(Debug, Clone, PartialEq)]
pub struct Window {
    /// Index of the motion.
    pub motion: usize,
    /// Its samples.
    pub samples: Range<usize>,
}

/// Measured motions ready to be fitted.
#[derive(Debug, Clone)]
pub struct Data {
    /// The motions.
    pub motions: Vec<Motion>,
    /// Windows in the order of motions and time.
    pub windows: Vec<Window>,
    /// Per joint: standard deviation of the measurement, rad, by which residuals are divided.
    pub sigma_rad: Vec<f64>,
}

impl Data {
    /// Cuts motions into windows; the noise is found from the motions and the declared resolution.
    pub fn new(model: &Model, motions: Vec<Motion>, horizon: Horizon) -> Data {
        let sigma_rad = (0..model.link_count())
            .map(|joint| noise_rad(&motions, joint, model.log.joints[joint].position.resolution))
            .collect();
        let windows = cut(&motions, horizon);
        Data {
            motions,
            windows,
            sigma_rad,
        }
    }

    /// The same motions and weights cut at another horizon.
    pub fn recut(&self, horizon: Horizon) -> Data {
        Data {
            motions: self.motions.clone(),
            windows: cut(&self.motions, horizon),
            sigma_rad: self.sigma_rad.clone(),
        }
    }

    /// One of the motions, cut as it is here.
    pub fn only(&self, motion: usize) -> Data {
        let windows = self.windows.iter().filter(|w| w.motion == motion);
        Data {
            motions: vec![self.motions[motion].clone()],
            windows: windows
                .map(|w| Window {
                    motion: 0,
                    samples: w.samples.clone(),
                })
                .collect(),
            sigma_rad: self.sigma_rad.clone(),
        }
    }

    /// Number of samples in all windows.
    pub fn samples(&self) -> usize {
        self.windows.iter().map(|w| w.samples.len()).sum()
    }
}

fn cut(motions: &[Motion], horizon: Horizon) -> Vec<Window> {
    let mut windows = Vec::new();
    for (motion, log) in motions.iter().enumerate() {
        let pieces = match horizon {
            Horizon::Whole => 1,
            Horizon::Seconds(seconds) => {
                let most = (log.len() / 5).max(1);
                ((log.duration_s() / seconds).round() as usize).clamp(1, most)
            }
        };
        let edge = |piece: usize| piece * log.len() / pieces;
        for piece in 0..pieces {
            windows.push(Window {
                motion,
                samples: edge(piece)..edge(piece + 1),
            });
        }
    }
    windows
}
