//! Goals of servos over time: what they ask for, and as a file that `handstand replay` plays.

use super::ExcitationKind;
use super::limits::JointLimits;
use serde::Serialize;
use std::fmt::Write as _;

/// Goals over time.
#[derive(Debug, Clone, PartialEq)]
pub struct Excitation {
    /// Times, s.
    pub time_s: Vec<f64>,
    /// Per sample, per joint, rad.
    pub angle_rad: Vec<Vec<f64>>,
    /// Per sample: whether torque is on.
    pub torque_on: Vec<bool>,
    /// Which motion lies where.
    pub motions: Vec<ExcitedMotion>,
    pub(super) joints: Vec<JointLimits>,
}

/// One motion.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ExcitedMotion {
    /// What it is.
    pub kind: ExcitationKind,
    /// When it begins, s.
    pub begin_s: f64,
    /// When it ends, s.
    pub end_s: f64,
}

/// How far and fast a joint is asked to move.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct JointExtent {
    /// Its servos.
    pub servos: Vec<u8>,
    /// Lowest goal, rad.
    pub lowest_rad: f64,
    /// Highest goal, rad.
    pub highest_rad: f64,
    /// Fastest change of the goal, rad/s.
    pub fastest_rad_s: f64,
}

impl Excitation {
    /// Whole duration, s.
    pub fn seconds(&self) -> f64 {
        self.time_s.last().copied().unwrap_or(0.0)
    }

    /// Whether torque goes off somewhere.
    pub fn drops(&self) -> bool {
        self.torque_on.contains(&false)
    }

    /// How far and fast each joint is asked to move.
    pub fn extents(&self) -> Vec<JointExtent> {
        let extent = |(at, joint): (usize, &JointLimits)| {
            let angles = || self.angle_rad.iter().map(|row| row[at]);
            let times = self.time_s.windows(2).map(|pair| pair[1] - pair[0]);
            let moves = angles().zip(angles().skip(1)).zip(times);
            JointExtent {
                servos: joint.servos.clone(),
                lowest_rad: angles().fold(f64::INFINITY, f64::min),
                highest_rad: angles().fold(f64::NEG_INFINITY, f64::max),
                fastest_rad_s: moves
                    .map(|((a, b), step_s)| (b - a).abs() / step_s)
                    .fold(0.0, f64::max),
            }
        };
        self.joints.iter().enumerate().map(extent).collect()
    }

    /// As `handstand replay` plays it: `time_s`, `goal1_rad` for each servo, `torque_on` where
    /// torque goes off.
    pub fn to_csv(&self) -> String {
        let mut text = String::from("time_s");
        // Writing to a string does not fail.
        for servo in self.joints.iter().flat_map(|joint| &joint.servos) {
            let _ = write!(text, ",goal{servo}_rad");
        }
        text += if self.drops() { ",torque_on\n" } else { "\n" };
        for (k, row) in self.angle_rad.iter().enumerate() {
            let _ = write!(text, "{:.4}", self.time_s[k]);
            for (joint, angle) in self.joints.iter().zip(row) {
                for place in 0..joint.servos.len() {
                    let sign = if place == 0 { 1.0 } else { -1.0 };
                    let _ = write!(text, ",{:.5}", sign * angle + 0.0);
                }
            }
            if self.drops() {
                let _ = write!(text, ",{}", u8::from(self.torque_on[k]));
            }
            text.push('\n');
        }
        text
    }
}
