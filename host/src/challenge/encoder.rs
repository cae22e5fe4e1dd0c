//! An encoder with play before it and a filter behind it.

use super::physics::Physics;

/// What the encoder remembers, rad.
#[derive(Debug, Clone)]
pub struct Encoder {
    follower: f64,
    lagged: f64,
}

impl Encoder {
    /// In the middle of its play, at rest at `encoded` rad.
    pub fn at_rest(encoded: f64) -> Self {
        Encoder {
            follower: encoded,
            lagged: encoded,
        }
    }

    /// Goes on for `h` seconds, at whose end the axis stands at `encoded` rad.
    pub fn follow(&mut self, physics: &Physics, encoded: f64, h: f64) {
        let half = physics.gap / 2.0;
        let follower = self.follower;
        self.follower = follower.clamp(encoded - half, encoded + half);
        let lag_s = physics.lag_s;
        if lag_s > 0.0 {
            let middle = 0.5 * (follower + self.follower);
            self.lagged += (middle - self.lagged) * h / (lag_s + h / 2.0);
        } else {
            self.lagged = self.follower;
        }
    }

    /// Its value before noise and rounding, rad.
    pub fn sensed(&self) -> f64 {
        self.lagged
    }
}
