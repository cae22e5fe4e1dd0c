//! Sensors of a loop: resolution, noise, how speeds are had.

use super::random::normal;
use handstand_shared::raw::Position;
use rand_chacha::ChaCha8Rng;

/// Step of the paper's gyro, rad/s: 10 deg/s.
pub const GYRO_STEP_RAD_S: f64 = 10.0 * std::f64::consts::PI / 180.0;

/// Joint encoders, and where the speeds come from.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sensor {
    /// Smallest step of an angle, rad; 0 reads exactly. The AX-12 has 300 deg / 1024. The pose lies
    /// on a step.
    pub position_resolution_rad: f64,
    /// Standard deviation of an angle's noise, rad, before it is rounded.
    pub position_noise_rad: f64,
    /// Where speeds come from.
    pub velocity: Velocity,
    /// A rate sensor on the first link; it gives that joint's speed instead.
    pub gyro: Option<Gyro>,
}

/// Where a joint's speed comes from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Velocity {
    /// The true speed.
    Direct,
    /// (angle(k) - angle(k - 1)) / period of the angles as read: the paper's estimate. 0 at the
    /// first sample.
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
    /// 10-bit angles, speeds of the driven joints from their differences, a 10 deg/s gyro on the
    /// arms: the paper's.
    pub const PAPER: Sensor = Sensor {
        position_resolution_rad: Position::LSB_RAD,
        position_noise_rad: 0.0,
        velocity: Velocity::Difference,
        gyro: Some(Gyro {
            resolution_rad_s: GYRO_STEP_RAD_S,
            noise_rad_s: 0.0,
        }),
    };

    /// Reads everything exactly.
    pub const EXACT: Sensor = Sensor {
        position_resolution_rad: 0.0,
        position_noise_rad: 0.0,
        velocity: Velocity::Direct,
        gyro: None,
    };

    /// Measures what the encoders read: `angle_rad` and `speed_rad_s`, and `gyro_rad_s` of the
    /// first link. `measured_rad` holds the measurement before and takes the new one; `first` says
    /// there is none.
    #[inline]
    #[expect(
        clippy::too_many_arguments,
        reason = "readings, measurements, and the random numbers"
    )]
    pub(super) fn read(
        &self,
        period_s: f64,
        first: bool,
        angle_rad: &[f64],
        speed_rad_s: &[f64],
        gyro_rad_s: f64,
        measured_rad: &mut [f64],
        measured_rad_s: &mut [f64],
        rng: &mut ChaCha8Rng,
    ) {
        let readings = angle_rad.iter().zip(speed_rad_s);
        let measurements = measured_rad.iter_mut().zip(measured_rad_s.iter_mut());
        for ((&angle, &speed), (before, measured_speed)) in readings.zip(measurements) {
            let noisy = angle + noise(self.position_noise_rad, rng);
            let reading = rounded(noisy, self.position_resolution_rad);
            *measured_speed = match self.velocity {
                Velocity::Direct => speed,
                Velocity::Difference if first => 0.0,
                Velocity::Difference => (reading - *before) / period_s,
            };
            *before = reading;
        }
        if let (Some(gyro), Some(measured)) = (self.gyro, measured_rad_s.first_mut()) {
            let noisy = gyro_rad_s + noise(gyro.noise_rad_s, rng);
            *measured = rounded(noisy, gyro.resolution_rad_s);
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
