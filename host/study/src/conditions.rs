//! Non-idealities of the robot, one at a time and all at once.

use super::case::Case;
use super::quantity::Uncertain;
use crate::sim::closed_loop::{Drives, Sensor, Velocity};
use crate::synth::controllers::ServoLag;

/// By how much of its dead zone a robot's own may differ.
const DEAD_ZONE_ERROR: f64 = 0.2;

/// Largest error of a link's mass, a share of it.
const MASS_ERROR: f64 = 0.1;

/// Largest distance of a link's centre of mass from its line, m: four times what the paper gives as
/// the error of its drawings.
const ECCENTRIC_M: f64 = 2e-3;

/// A way in which a robot is not ideal.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum NonIdeality {
    /// 10-bit angles of all joints.
    Positions,
    /// The arms' speed to 10 deg/s.
    Gyro,
    /// A dead zone of 10 % of the full range, within a fifth of that.
    DeadZone,
    /// No more than 2 N m.
    Saturation,
    /// Commands take effect a sample late.
    Delay,
    /// Centres of mass up to 2 mm beside their lines, unknown.
    Eccentric,
    /// Torques pass the paper's servo transfer function.
    Servo,
    /// Masses up to 10 % off, unknown.
    Masses,
}

use NonIdeality::{DeadZone, Delay, Eccentric, Gyro, Masses, Positions, Saturation, Servo};

/// A set of non-idealities.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct LoopCondition {
    /// Name on the command line.
    pub id: &'static str,
    /// Name for people.
    pub title: &'static str,
    /// What acts.
    pub non_idealities: &'static [NonIdeality],
}

/// Everything the paper found, at once.
const ALL: &[NonIdeality] = &[Positions, Gyro, DeadZone, Saturation, Delay, Eccentric];
const ALL_AND_MASSES: &[NonIdeality] = &[
    Positions, Gyro, DeadZone, Saturation, Delay, Eccentric, Masses,
];

/// The conditions there are.
pub const CONDITIONS: &[LoopCondition] = &[
    set("ideal", "ideal", &[]),
    set("positions", "10-bit angles", &[Positions]),
    set("gyro", "gyro 10 deg/s", &[Gyro]),
    set("dead-zone", "dead zone 10 %", &[DeadZone]),
    set("saturation", "2 N m", &[Saturation]),
    set("delay", "1 sample late", &[Delay]),
    set("eccentric", "eccentric", &[Eccentric]),
    set("servo", "servo lag", &[Servo]),
    set("masses", "masses 10 %", &[Masses]),
    set("all", "all at once", ALL),
    set("all-masses", "all, masses 10 %", ALL_AND_MASSES),
];

const fn set(
    id: &'static str,
    title: &'static str,
    non_idealities: &'static [NonIdeality],
) -> LoopCondition {
    LoopCondition {
        id,
        title,
        non_idealities,
    }
}

/// The condition of this name.
pub fn condition(id: &str) -> Option<&'static LoopCondition> {
    CONDITIONS.iter().find(|condition| condition.id == id)
}

impl LoopCondition {
    /// Puts the case under the condition; the designer knows the nominal values. What is drawn for
    /// every robot comes back.
    pub fn apply(&self, case: &mut Case) -> Vec<Uncertain> {
        let has = |own: NonIdeality| self.non_idealities.contains(&own);
        let share = |own: NonIdeality, value: f64| if has(own) { value } else { 0.0 };
        let drives = Drives {
            saturates: has(Saturation),
            dead_zone: share(DeadZone, Drives::PAPER.dead_zone),
            delay_periods: share(Delay, 1.0),
            ..Drives::IDEAL
        };
        let sensor = Sensor {
            position_resolution_rad: share(Positions, Sensor::PAPER.position_resolution_rad),
            velocity: Velocity::Direct,
            gyro: Sensor::PAPER.gyro.filter(|_| has(Gyro)),
            ..Sensor::EXACT
        };
        (case.drives, case.sensor) = (drives, sensor);
        (case.control.drives, case.control.sensor) = (drives, sensor);
        case.servo = has(Servo).then_some(ServoLag::PAPER);
        let spreads = [
            (Masses, "mass", MASS_ERROR),
            (Eccentric, "com-aside", ECCENTRIC_M),
            (DeadZone, "dead-zone", DEAD_ZONE_ERROR * drives.dead_zone),
        ];
        let links = case.robot.link_count();
        let acting = spreads.iter().filter(|(own, ..)| has(*own));
        acting
            .flat_map(|(_, id, size)| Uncertain::uniform(id, *size, links))
            .collect()
    }
}
