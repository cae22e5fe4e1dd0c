//! What the controller gets to see.

use super::random::normal;
use rand_chacha::ChaCha8Rng;

/// Joint encoders, and what tells the speeds.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sensor {
    /// Smallest step of an angle, rad; 0 reads exactly. The AX-12 has 300 deg / 1024. The pose lies on a step.
    pub position_resolution_rad: f64,
    /// Standard deviation of an angle's noise, rad, before it is rounded.
    pub position_noise_rad: f64,
    /// Where speeds come from.
    pub velocity: Velocity,
    /// A rate sensor on the first link; it tells that joint's speed instead.
    pub gyro: Option<Gyro>,
}

/// Where a joint's speed comes from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Velocity {
    /// The true speed.
    Direct,
    /// (angle(k) - angle(k - 1)) / period of the angles as read: the paper's estimate. 0 at the first sample.
    Difference,
}

/// A rate sensor.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Gyro {
    /// Smallest step, rad/s; 0 reads exactly. The paper's has 10 deg/s.
    pub resolution_rad_s: f64,
    /// Standard deviation of its noise, rad/s, before it is rounded.
    pub noise_rad_s: f64,
}

impl Sensor {
    /// Reads everything exactly.
    pub const EXACT: Sensor = Sensor {
        position_resolution_rad: 0.0,
        position_noise_rad: 0.0,
        velocity: Velocity::Direct,
        gyro: None,
    };

    /// Reads angles and speeds. `seen_rad` holds the reading before and takes the new one; `first` says there is none.
    #[inline]
    #[expect(
        clippy::too_many_arguments,
        reason = "the truth, the readings, and the odds"
    )]
    pub(super) fn read(
        &self,
        period_s: f64,
        first: bool,
        angle_rad: &[f64],
        speed_rad_s: &[f64],
        seen_rad: &mut [f64],
        seen_rad_s: &mut [f64],
        rng: &mut ChaCha8Rng,
    ) {
        let truth = angle_rad.iter().zip(speed_rad_s);
        for ((&angle, &speed), (seen, seen_speed)) in
            truth.zip(seen_rad.iter_mut().zip(seen_rad_s.iter_mut()))
        {
            let noisy = angle + noise(self.position_noise_rad, rng);
            let reading = rounded(noisy, self.position_resolution_rad);
            *seen_speed = match self.velocity {
                Velocity::Direct => speed,
                Velocity::Difference if first => 0.0,
                Velocity::Difference => (reading - *seen) / period_s,
            };
            *seen = reading;
        }
        if let (Some(gyro), Some(seen), Some(speed)) =
            (self.gyro, seen_rad_s.first_mut(), speed_rad_s.first())
        {
            *seen = rounded(speed + noise(gyro.noise_rad_s, rng), gyro.resolution_rad_s);
        }
    }
}

#[inline]
fn noise(deviation: f64, rng: &mut ChaCha8Rng) -> f64 {
    if deviation == 0.0 {
        return 0.0;
    }
    deviation * normal(rng)
}

#[inline]
fn rounded(value: f64, step: f64) -> f64 {
    if step == 0.0 {
        return value;
    }
    (value / step).round() * step
}
