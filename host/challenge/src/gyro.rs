//! A gyro on a link, beside the encoder of its joint, and what a log holds of it.

use super::motion::normal;
use rand_chacha::ChaCha8Rng;

/// The gyro's steps, and the standard deviation of its white noise, rad/s.
pub const STEP_RAD_S: f64 = 0.01;
/// Kinds that are hidden in a gyro: a rig has one where one of them is hidden.
pub const KINDS: [&str; 3] = ["rate_bias", "rate_scale", "rate_lag"];

/// How a gyro reads.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GyroLaw {
    /// Reading at rest, rad/s.
    pub bias_rad_s: f64,
    /// Rate read over true rate.
    pub scale: f64,
    /// Time constant of its filter, s.
    pub lag_s: f64,
}

impl Default for GyroLaw {
    fn default() -> Self {
        GyroLaw {
            bias_rad_s: 0.0,
            scale: 1.0,
            lag_s: 0.0,
        }
    }
}

/// What a gyro remembers: the filtered rate of its link against the world, rad/s.
#[derive(Debug, Clone, Copy, Default)]
pub struct Gyro(f64);

impl Gyro {
    /// Turning steadily at this rate.
    pub fn turning(rate_rad_s: f64) -> Self {
        Gyro(rate_rad_s)
    }

    /// Goes on for `h` seconds, in which the link's rate changes from the first to the second.
    pub fn follow(&mut self, law: GyroLaw, [before, after]: [f64; 2], h: f64) {
        self.0 = if law.lag_s > 0.0 {
            self.0 + (0.5 * (before + after) - self.0) * h / (law.lag_s + h / 2.0)
        } else {
            after
        };
    }

    /// A noisy reading in the gyro's steps, rad/s; never a negative zero.
    pub fn read(self, law: GyroLaw, rng: &mut ChaCha8Rng) -> f64 {
        let rate = law.scale * self.0 + law.bias_rad_s + STEP_RAD_S * normal(rng);
        (rate / STEP_RAD_S).round() * STEP_RAD_S + 0.0
    }
}
