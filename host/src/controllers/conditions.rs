//! What the robot does to its controller, one trouble at a time and all at once.

use super::{Known, ServoLag};
use crate::closed_loop::{Actuator, Clock, Conditions, Gyro, Sensor, Velocity};
use handstand_shared::raw::Position;

/// Step of the paper's gyro, rad/s: 10 deg/s.
pub const GYRO_STEP_RAD_S: f64 = 10.0 * std::f64::consts::PI / 180.0;

/// Dead zone as a share of the full range, and by how much of it a robot's own may differ.
pub const DEAD_ZONE: f64 = 0.1;
/// See [`DEAD_ZONE`].
pub const DEAD_ZONE_ERROR: f64 = 0.2;

/// Full range and limit of the torque, N m.
pub const LIMIT_NM: f64 = 2.0;

/// Largest distance of a link's centre of mass from its line, m: four times what the paper gives as the error of its
/// drawings.
pub const ECCENTRIC_M: f64 = 2e-3;

/// A set of troubles.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Condition {
    /// Name on the command line.
    pub id: &'static str,
    /// Name for people.
    pub title: &'static str,
    /// 10-bit angles of all joints.
    pub positions: bool,
    /// The arms' speed to 10 deg/s.
    pub gyro: bool,
    /// A dead zone of 10 % of the full range, within a fifth of that.
    pub dead_zone: bool,
    /// No more than 2 N m.
    pub saturation: bool,
    /// Commands take effect a sample late.
    pub delay: bool,
    /// Centres of mass up to 2 mm beside their lines, unknown.
    pub eccentric: bool,
    /// Torques pass the paper's servo transfer function.
    pub servo: bool,
    /// Masses up to 10 % off, unknown.
    pub masses: bool,
}

const NONE: Condition = Condition {
    id: "ideal",
    title: "ideal",
    positions: false,
    gyro: false,
    dead_zone: false,
    saturation: false,
    delay: false,
    eccentric: false,
    servo: false,
    masses: false,
};

/// Everything the paper found, at once.
const ALL: Condition = Condition {
    id: "all",
    title: "all at once",
    positions: true,
    gyro: true,
    dead_zone: true,
    saturation: true,
    delay: true,
    eccentric: true,
    ..NONE
};

/// In the order of the table.
pub const CONDITIONS: &[Condition] = &[
    NONE,
    Condition {
        id: "positions",
        title: "10-bit angles",
        positions: true,
        ..NONE
    },
    Condition {
        id: "gyro",
        title: "gyro 10 deg/s",
        gyro: true,
        ..NONE
    },
    Condition {
        id: "dead-zone",
        title: "dead zone 10 %",
        dead_zone: true,
        ..NONE
    },
    Condition {
        id: "saturation",
        title: "2 N m",
        saturation: true,
        ..NONE
    },
    Condition {
        id: "delay",
        title: "1 sample late",
        delay: true,
        ..NONE
    },
    Condition {
        id: "eccentric",
        title: "eccentric",
        eccentric: true,
        ..NONE
    },
    Condition {
        id: "servo",
        title: "servo lag",
        servo: true,
        ..NONE
    },
    Condition {
        id: "masses",
        title: "masses 10 %",
        masses: true,
        ..NONE
    },
    ALL,
    Condition {
        id: "all-masses",
        title: "all, masses 10 %",
        masses: true,
        ..ALL
    },
];

/// The condition of this name.
pub fn condition(id: &str) -> Option<&'static Condition> {
    CONDITIONS.iter().find(|condition| condition.id == id)
}

impl Condition {
    /// What a designer is told of it: everything but the truth of one robot.
    pub fn tell(&self, ideal: &Known) -> Known {
        let when = |on: bool, value: f64| if on { value } else { 0.0 };
        Known {
            delay_s: when(self.delay, ideal.period_s),
            dead_zone_nm: when(self.dead_zone, DEAD_ZONE * LIMIT_NM),
            limit_nm: if self.saturation {
                LIMIT_NM
            } else {
                f64::INFINITY
            },
            position_step_rad: when(self.positions, Position::LSB_RAD),
            gyro_step_rad_s: when(self.gyro, GYRO_STEP_RAD_S),
            servo: self.servo.then_some(ServoLag::PAPER),
            ..ideal.clone()
        }
    }

    /// The loop's circumstances for a robot whose dead zone is `dead_zone` of the full range.
    pub fn conditions(&self, known: &Known, dead_zone: f64) -> Conditions {
        Conditions {
            sensor: Sensor {
                position_resolution_rad: known.position_step_rad,
                position_noise_rad: 0.0,
                // Who does without the true speeds does not look at them.
                velocity: Velocity::Direct,
                gyro: Some(Gyro {
                    resolution_rad_s: known.gyro_step_rad_s,
                    noise_rad_s: 0.0,
                }),
            },
            actuator: Actuator {
                full_torque_nm: LIMIT_NM,
                saturates: self.saturation,
                dead_zone: if self.dead_zone { dead_zone } else { 0.0 },
                delay_periods: known.delay_s / known.period_s,
                ..Actuator::IDEAL
            },
            clock: Clock::every(known.period_s),
        }
    }
}
