//! Non-idealities of the robot, one at a time and all at once.

use super::case::Case;
use super::quantity::Uncertain;
use crate::controllers::ServoLag;
use crate::sim::closed_loop::{Drives, Sensor, Velocity};

/// By how much of its dead zone a robot's own may differ.
const DEAD_ZONE_ERROR: f64 = 0.2;

/// Largest error of a link's mass, a share of it.
const MASS_ERROR: f64 = 0.1;

/// Largest distance of a link's centre of mass from its line, m: four times what the paper gives as
/// the error of its drawings.
const ECCENTRIC_M: f64 = 2e-3;

/// A set of non-idealities.
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
    /// Puts the case under the condition; the designer knows the nominal values. What is drawn for
    /// every robot comes back.
    pub fn apply(&self, case: &mut Case) -> Vec<Uncertain> {
        let drives = Drives {
            saturates: self.saturation,
            dead_zone: if self.dead_zone {
                Drives::PAPER.dead_zone
            } else {
                0.0
            },
            delay_periods: if self.delay { 1.0 } else { 0.0 },
            ..Drives::IDEAL
        };
        let sensor = Sensor {
            position_resolution_rad: match self.positions {
                true => Sensor::PAPER.position_resolution_rad,
                false => 0.0,
            },
            // Controllers that estimate the speeds do not look at them.
            velocity: Velocity::Direct,
            gyro: Sensor::PAPER.gyro.filter(|_| self.gyro),
            ..Sensor::EXACT
        };
        (case.drives, case.sensor) = (drives, sensor);
        (case.control.drives, case.control.sensor) = (drives, sensor);
        case.servo = self.servo.then_some(ServoLag::PAPER);
        let spreads = [
            (self.masses, "mass", MASS_ERROR),
            (self.eccentric, "com-aside", ECCENTRIC_M),
            (
                self.dead_zone,
                "dead-zone",
                DEAD_ZONE_ERROR * drives.dead_zone,
            ),
        ];
        let links = case.robot.link_count();
        spreads
            .iter()
            .filter(|(on, ..)| *on)
            .flat_map(|(_, id, size)| Uncertain::uniform(id, *size, links))
            .collect()
    }
}
