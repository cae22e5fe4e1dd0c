//! When the CM-5 reads and acts in a period of its law, and how well its sensors tell.

use crate::sim::closed_loop::GYRO_STEP_RAD_S;
use handstand_shared::observer::{INPUTS, READINGS};
use handstand_shared::raw::Position;

/// When things happen in a period, and how well the readings tell.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BoardTiming {
    /// From the law's moment until its inputs act, s.
    pub effect_s: f64,
    /// Delay of each drive beside it, s.
    pub drive_delay_s: [f64; INPUTS],
    /// Time constant with which a servo's torque follows its input, s; 0: at once.
    pub lag_s: f64,
    /// Time constant of the filter that the encoder of each driven joint is read through, s; 0:
    /// none. Only where torques follow at once: else the states it takes are the torques'.
    pub sensor_lag_s: [f64; INPUTS],
    /// Age of each reading at the law's moment, s: the angles, then the first link's rate.
    pub age_s: [f64; READINGS],
    /// Standard deviation of each reading, in SI; infinite for one that there is not. Without the
    /// first link's angle its rate is a gyro's, whose offset is estimated.
    pub deviation: [f64; READINGS],
}

/// Deviation assumed of an exact angle, rad: that of its step and more, for the model is not exact.
const EXACT_RAD: f64 = 1e-4;

/// Standard deviation of what is rounded to a step of 1: 1 / sqrt(12).
pub(super) const ROUNDED: f64 = 0.288_675_134_594_812_9;

impl BoardTiming {
    /// The law on the CM-5 between 18 servos with return delay 0, its moment being the end of the
    /// last answer, which is the hip's after the shoulder's. Ages and effect were measured by
    /// `cargo xtask bench-firmware --only "age of readings"`. The host says the first link's
    /// attitude every period, as it hears a report. Its rate counts no more than a gyro's of 10
    /// deg/s: trusted more, what the linear model makes of one so old fells the robot from 2 deg.
    /// The torque follows at once.
    pub const HOST_ATTITUDE: BoardTiming = BoardTiming {
        effect_s: 0.7e-3,
        drive_delay_s: [0.0; INPUTS],
        lag_s: 0.0,
        sensor_lag_s: [0.0; INPUTS],
        age_s: [8.5e-3, 0.4e-3, 0.2e-3, 8.5e-3],
        deviation: [
            EXACT_RAD,
            Position::LSB_RAD * ROUNDED,
            Position::LSB_RAD * ROUNDED,
            GYRO_STEP_RAD_S * ROUNDED,
        ],
    };

    /// Time constant of the paper's servo, s: that of the pole pair of its equation 2.
    pub const SERVO_LAG_S: f64 = 0.034;

    /// The same with a gyro of this step on the CM-5, rad/s per code, read at the law's moment;
    /// nothing tells the first link's angle.
    pub const fn gyro(step_rad_s: f64) -> BoardTiming {
        let [_, shoulder_s, hip_s, _] = BoardTiming::HOST_ATTITUDE.age_s;
        let [_, shoulder_rad, hip_rad, _] = BoardTiming::HOST_ATTITUDE.deviation;
        BoardTiming {
            age_s: [0.0, shoulder_s, hip_s, 0.1e-3],
            deviation: [f64::INFINITY, shoulder_rad, hip_rad, step_rad_s * ROUNDED],
            ..BoardTiming::HOST_ATTITUDE
        }
    }

    /// The paper's gyro.
    pub const GYRO: BoardTiming = BoardTiming::gyro(GYRO_STEP_RAD_S);

    /// The same with servos of this lag, s.
    #[must_use]
    pub const fn with_lag(self, lag_s: f64) -> BoardTiming {
        BoardTiming { lag_s, ..self }
    }

    /// From the law's moment until each input acts, s.
    pub fn effects_s(&self) -> [f64; INPUTS] {
        self.drive_delay_s.map(|delay_s| self.effect_s + delay_s)
    }

    /// The same of the latest.
    pub fn latest_effect_s(&self) -> f64 {
        self.effects_s().into_iter().fold(0.0, f64::max)
    }

    /// Whether the reading of a driven joint is a filter's, which has a state of its own.
    pub(super) fn is_filtered(&self, place: usize) -> bool {
        self.lag_s <= 0.0 && self.sensor_lag_s[place] > 0.0
    }

    /// Whether nothing measures the first link's angle.
    pub(super) fn is_gyro(&self) -> bool {
        self.deviation[0].is_infinite()
    }
}
