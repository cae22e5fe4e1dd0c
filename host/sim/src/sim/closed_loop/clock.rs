//! When the controller is called.

use rand::Rng as _;
use rand_chacha::ChaCha8Rng;

/// Calls the controller every period, more or less.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Clock {
    /// Period between samples, s. The controller takes every period for this one.
    pub period_s: f64,
    /// Largest share of the period by which a sample comes early or late, 0 to 0.45; evenly
    /// distributed.
    pub jitter: f64,
    /// Probability that a command is lost on its way and the one before stays.
    pub loss: f64,
}

impl Clock {
    /// A perfect clock.
    pub fn every(period_s: f64) -> Self {
        Clock {
            period_s,
            jitter: 0.0,
            loss: 0.0,
        }
    }

    /// Time of sample `k`, s.
    #[inline]
    pub(super) fn time_s(&self, k: usize, rng: &mut ChaCha8Rng) -> f64 {
        let late = match self.jitter {
            0.0 => 0.0,
            jitter => jitter * rng.random_range(-1.0..=1.0),
        };
        (k as f64 + late) * self.period_s
    }

    /// Whether this sample's command is lost.
    #[inline]
    pub(super) fn loses(&self, rng: &mut ChaCha8Rng) -> bool {
        self.loss > 0.0 && rng.random::<f64>() < self.loss
    }
}
