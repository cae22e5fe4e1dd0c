//! The calibration of a robot's servos, as LeRobot saves it, and the units that follow from it.
//!
//! `_normalize` of `motors/motors_bus.py` (huggingface/lerobot 0.4.4) makes of a count x, with
//! m = `range_min`, M = `range_max` and R counts per turn:
//!
//! | mode | value | with `drive_mode` |
//! |---|---|---|
//! | `RANGE_M100_100` | 200 (x - m)/(M - m) - 100 | its negative |
//! | `RANGE_0_100` | 100 (x - m)/(M - m) | 100 less it |
//! | `DEGREES` | 360 (x - (m + M)/2)/(R - 1) | the same |
//!
//! `drive_mode` counts on the bus of Feetech alone (`apply_drive_mode`); R is 4096 of the servos of
//! `MODEL_RESOLUTION` but Feetech's SCS, which have 1024.

use super::info::{found, json};
use crate::error::{Error, Place, Result};
use serde_json::Value;
use std::path::Path;

/// Counts per turn of STS3215 and of Dynamixel X.
const COUNTS_PER_TURN: f64 = 4096.0;
/// Degrees per turn as LeRobot scales them: a turn has one count more than it divides by.
pub const DEGREES_PER_TURN: f64 = 360.0 * COUNTS_PER_TURN / (COUNTS_PER_TURN - 1.0);
/// One count, rad.
pub const COUNT_RAD: f64 = std::f64::consts::TAU / COUNTS_PER_TURN;
/// Farthest count: a servo counts some turns.
const FARTHEST: i64 = 1 << 20;

/// What a calibration says of one servo.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct MotorCalibration {
    /// Whether `drive_mode` is 1: the servo counts the other way round.
    pub is_reversed: bool,
    /// Least count of its range.
    pub range_min: i64,
    /// Largest count of its range.
    pub range_max: i64,
}

impl MotorCalibration {
    /// Per cent per turn, where its range is `span` per cent: 200 from -100 to 100.
    pub fn per_turn(&self, span: f64) -> f64 {
        span * COUNTS_PER_TURN / (self.range_max - self.range_min) as f64
    }

    /// Its range, rad.
    pub fn range_rad(&self) -> f64 {
        (self.range_max - self.range_min) as f64 * COUNT_RAD
    }
}

/// A robot's servos by their names.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Calibration {
    motors: Vec<(String, MotorCalibration)>,
}

impl Calibration {
    /// Reads a calibration: an object of a servo each, with `drive_mode`, `range_min`, `range_max`.
    ///
    /// # Errors
    /// What is no JSON, no object of servos, or has other numbers than LeRobot writes.
    pub fn read(file: &Path) -> Result<Calibration> {
        let value = json(file)?;
        let remedy = "give the file that lerobot-calibrate wrote, such as \
                      ~/.cache/huggingface/lerobot/calibration/robots/so_follower/NAME.json";
        let wrong = |what: String| Error::data(Place::file(file), what, remedy);
        let motors = value.as_object().filter(|motors| !motors.is_empty());
        let motors = motors
            .ok_or_else(|| wrong(format!("{}, not an object of servos", found(Some(&value)))))?;
        let motors = motors.iter().map(|(name, motor)| {
            let number = |key: &str, low: i64, high: i64| {
                let number = motor.get(key).and_then(Value::as_i64);
                let number = number.filter(|number| (low..=high).contains(number));
                let what = || format!("{name}.{key}: {}", found(motor.get(key)));
                number.ok_or_else(|| wrong(what()))
            };
            let calibration = MotorCalibration {
                is_reversed: number("drive_mode", 0, 1)? == 1,
                range_min: number("range_min", -FARTHEST, FARTHEST)?,
                range_max: number("range_max", -FARTHEST, FARTHEST)?,
            };
            if calibration.range_min >= calibration.range_max {
                let (low, high) = (calibration.range_min, calibration.range_max);
                return Err(wrong(format!("{name}: a range from {low} to {high}")));
            }
            Ok((name.clone(), calibration))
        });
        Ok(Calibration {
            motors: motors.collect::<Result<_>>()?,
        })
    }

    /// The servo of this name.
    pub fn motor(&self, name: &str) -> Option<MotorCalibration> {
        let mut known = self.motors.iter();
        known.find(|(own, _)| own == name).map(|(_, motor)| *motor)
    }

    /// Names of the servos.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.motors.iter().map(|(name, _)| name.as_str())
    }
}
