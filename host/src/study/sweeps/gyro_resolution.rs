//! How coarse the rate sensor may be.

use crate::closed_loop::Gyro;
use crate::study::{Case, Sweep, SweepCard};

/// Smallest step of the arms' speed; the paper's gyro has 10 deg/s.
#[derive(Debug)]
pub struct GyroResolution;

static CARD: SweepCard = SweepCard {
    id: "gyro-resolution",
    title: "gyro resolution",
    unit: "deg/s",
    meaning: "Smallest step of the arms' speed; the paper's gyro has 10 deg/s.",
    levels: &[0.0, 1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0],
    bounds: (0.0, 10000.0),
};

impl Sweep for GyroResolution {
    fn card(&self) -> &'static SweepCard {
        &CARD
    }

    fn set(&self, level: f64, case: &mut Case) {
        let noise_rad_s = case
            .conditions
            .sensor
            .gyro
            .map_or(0.0, |gyro| gyro.noise_rad_s);
        case.conditions.sensor.gyro = Some(Gyro {
            resolution_rad_s: level.to_radians(),
            noise_rad_s,
        });
    }
}
