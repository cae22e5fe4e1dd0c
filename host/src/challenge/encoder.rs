//! An encoder whose shaft may slip, with play before it and a filter behind it.

use super::physics::Physics;

/// What the encoder remembers, rad.
#[derive(Debug, Clone)]
pub struct Encoder {
    /// What turns its shaft, and the shaft, rad.
    turned: [f64; 2],
    /// Speed of the shaft, rad/s.
    shaft_rad_s: f64,
    follower: f64,
    lagged: f64,
}

impl Encoder {
    /// In the middle of its play, at rest at `encoded` rad.
    pub fn at_rest(encoded: f64) -> Self {
        Encoder {
            turned: [encoded; 2],
            shaft_rad_s: 0.0,
            follower: encoded,
            lagged: encoded,
        }
    }

    /// Goes on for `h` seconds, at whose end the axis stands at `encoded` rad.
    pub fn follow(&mut self, physics: &Physics, encoded: f64, h: f64) {
        let encoded = self.gripped(physics, encoded, h);
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

    /// Angle of its shaft, gripped so hard that it follows most accelerations.
    fn gripped(&mut self, physics: &Physics, encoded: f64, h: f64) -> f64 {
        let [before, shaft] = self.turned;
        let speed = (encoded - before) / h;
        let reach = physics.grip_rad_s2 * h;
        self.shaft_rad_s = speed.clamp(self.shaft_rad_s - reach, self.shaft_rad_s + reach);
        let shaft = match self.shaft_rad_s == speed {
            true => shaft + (encoded - before),
            false => shaft + self.shaft_rad_s * h,
        };
        self.turned = [encoded, shaft];
        shaft
    }

    /// Its value before noise and rounding, rad.
    pub fn sensed(&self) -> f64 {
        self.lagged
    }
}
