//! An encoder whose shaft may slip, with play before it and a filter behind it, and what a log
//! holds of it.

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
    /// For how long it has been followed, s.
    since_s: f64,
    /// Where the log's times are off: the end of every step, s since the beginning, and the value
    /// then, rad.
    trace: Vec<[f64; 2]>,
}

impl Encoder {
    /// In the middle of its play, at rest at `encoded` rad.
    pub fn at_rest(encoded: f64) -> Self {
        Encoder {
            turned: [encoded; 2],
            shaft_rad_s: 0.0,
            follower: encoded,
            lagged: encoded,
            since_s: 0.0,
            trace: vec![[0.0, encoded]],
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
        self.since_s += h;
        if physics.logged_late_s != 0.0 {
            self.trace.push([self.since_s, self.lagged]);
        }
    }

    /// Angle of its shaft, gripped so hard that it follows most accelerations.
    fn gripped(&mut self, physics: &Physics, encoded: f64, h: f64) -> f64 {
        let [before, shaft] = self.turned;
        let speed = (encoded - before) / h;
        let reach = physics.grip_rad_s2 * h;
        self.shaft_rad_s = speed.clamp(self.shaft_rad_s - reach, self.shaft_rad_s + reach);
        let shaft = if self.shaft_rad_s == speed {
            shaft + (encoded - before)
        } else {
            shaft + self.shaft_rad_s * h
        };
        self.turned = [encoded, shaft];
        shaft
    }

    /// Its value before noise and rounding, rad.
    pub fn sensed(&self) -> f64 {
        self.lagged
    }

    /// Its value, rad, that a log whose times are off holds in a row of so many seconds since the
    /// beginning. Before that it was at rest; it must have been followed for as long as the row's
    /// reading is early.
    pub fn logged(&self, physics: &Physics, row_s: f64) -> f64 {
        let taken_s = row_s - physics.logged_late_s;
        let after = self.trace.partition_point(|[end_s, _]| *end_s < taken_s);
        let Some([to_s, to]) = self.trace.get(after) else {
            return self.lagged;
        };
        let Some([from_s, from]) = after.checked_sub(1).map(|before| self.trace[before]) else {
            return *to;
        };
        from + (taken_s - from_s) / (to_s - from_s) * (to - from)
    }
}
