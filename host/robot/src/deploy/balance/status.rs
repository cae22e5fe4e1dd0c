//! What is known of a balanced robot at one moment.

use crate::link::record::RobotSample;
use handstand_shared::message::{Attitude, Condition};
use handstand_shared::plan::Plan;
use std::time::Duration;

/// The newest of everything, and how the robot swayed.
#[derive(Debug, Clone, PartialEq)]
pub struct BalanceStatus {
    /// What the firmware is doing.
    pub condition: Condition,
    /// Since torque came on, s.
    pub balanced_s: f64,
    /// Angle of each driven joint as it was last heard, rad.
    pub joint_rad: [Option<f64>; 2],
    /// Output of each driven joint's servo as it was last heard, a share of full output.
    pub output: [Option<f64>; 2],
    /// The first link's angle from upright, rad; none from a gyro.
    pub lean_rad: Option<f64>,
    /// Its rate, rad/s.
    pub rate_rad_s: Option<f64>,
    /// From the last report but one to the last, s.
    pub report_s: f64,
    /// The longest of it since torque came on, s.
    pub longest_report_s: f64,
    /// The longest time between two attitudes sent since torque came on, s.
    pub longest_attitude_s: f64,
    /// What each servo said last of its supply, V, and of its temperature, degrees Celsius.
    health: Vec<[Option<f64>; 2]>,
    /// Places of the driven joints' servos.
    driven: [Option<usize>; 2],
    reversed: [bool; 2],
    attitude_at: Option<Duration>,
    report_at: Option<Duration>,
    squares: (f64, u64),
}

impl BalanceStatus {
    /// Of the servos `ids`, those of the plan among them; nothing is known yet.
    pub fn new(plan: &Plan, ids: &[u8]) -> Self {
        let place = |id: u8| ids.iter().position(|own| *own == id);
        BalanceStatus {
            condition: Condition::Balance,
            balanced_s: 0.0,
            joint_rad: [None; 2],
            output: [None; 2],
            lean_rad: None,
            rate_rad_s: None,
            report_s: 0.0,
            longest_report_s: 0.0,
            longest_attitude_s: 0.0,
            health: vec![[None; 2]; ids.len()],
            driven: [0, 1].map(|joint| place(plan.joints[joint].id)),
            reversed: [0, 1].map(|joint| plan.joints[joint].reversed),
            attitude_at: None,
            report_at: None,
            squares: (0.0, 0),
        }
    }

    /// Torque is on since now: longest times and swaying count from here.
    pub(super) fn begin(&mut self) {
        (self.longest_report_s, self.longest_attitude_s) = (0.0, 0.0);
        self.squares = (0.0, 0);
    }

    /// An attitude was sent.
    pub(super) fn sent(&mut self, now: Duration, attitude: Attitude) {
        let lean_rad = f64::from(attitude.angle) * Attitude::ANGLE_LSB_RAD;
        self.lean_rad = Some(lean_rad);
        self.rate_rad_s = Some(f64::from(attitude.rate) * Attitude::RATE_LSB_RAD_S);
        if let Some(before) = self.attitude_at.replace(now) {
            let apart_s = now.saturating_sub(before).as_secs_f64();
            self.longest_attitude_s = self.longest_attitude_s.max(apart_s);
        }
        if self.condition == Condition::BalanceArmed {
            self.squares.0 += lean_rad * lean_rad;
            self.squares.1 += 1;
        }
    }

    /// A report arrived.
    pub(super) fn heard(&mut self, now: Duration, condition: Condition, sample: &RobotSample) {
        self.condition = condition;
        if let Some(before) = self.report_at.replace(now) {
            self.report_s = now.saturating_sub(before).as_secs_f64();
            self.longest_report_s = self.longest_report_s.max(self.report_s);
        }
        for (joint, place) in self.driven.into_iter().enumerate() {
            let servo = place.and_then(|place| sample.joints.get(place));
            let sign = if self.reversed[joint] { -1.0 } else { 1.0 };
            let signed = |value: Option<f64>| value.map(|value| sign * value);
            let angle_rad = signed(servo.and_then(|servo| servo.position_rad));
            let output = signed(servo.and_then(|servo| servo.load));
            self.joint_rad[joint] = angle_rad.or(self.joint_rad[joint]);
            self.output[joint] = output.or(self.output[joint]);
        }
        for (health, servo) in self.health.iter_mut().zip(&sample.joints) {
            let said = [servo.supply_v, servo.temperature_celsius];
            health
                .iter_mut()
                .zip(said)
                .for_each(|(own, said)| *own = said.or(*own));
        }
        if self.lean_rad.is_none() {
            self.rate_rad_s = sample.gyro.and_then(|gyro| gyro.rate_rad_s);
        }
    }

    /// The lowest supply that a servo said when it was last asked, V.
    pub fn supply_v(&self) -> Option<f64> {
        self.health
            .iter()
            .filter_map(|[supply, _]| *supply)
            .reduce(f64::min)
    }

    /// The hottest servo, degrees Celsius.
    pub fn hottest_celsius(&self) -> Option<f64> {
        self.health
            .iter()
            .filter_map(|[_, heat]| *heat)
            .reduce(f64::max)
    }

    /// Root mean square of the first link's angle from upright while balancing, rad; none from a
    /// gyro.
    pub fn lean_rms_rad(&self) -> Option<f64> {
        let (sum, count) = self.squares;
        (count > 0).then(|| (sum / count as f64).sqrt())
    }
}
