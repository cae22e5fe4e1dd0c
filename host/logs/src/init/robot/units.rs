//! Units of angles that LeRobot wrote, in a data set or a plain table: degrees, rad, or per cent of
//! what a calibration says.

use super::matching::{LogJoint, matched};
use super::{RobotLog, columns_of};
use crate::error::{Error, Place, Result};
use crate::init::log_guess::{ColumnGuess, JointGuess};
use crate::init::values::range;
use crate::init::{Guess, LogGuess};
use crate::lerobot::{DEGREES_PER_TURN, MotorCalibration};
use crate::model::import::MovingJoint;
use crate::{DatasetFacts, RawLog};

/// How far beyond its ends a value may be that LeRobot holds between them.
const ROUNDED: f64 = 0.5;
/// Robots whose servos are Dynamixels: there a servo turns its count round by itself.
const DYNAMIXEL: [&str; 6] = ["koch", "omx", "viperx", "widowx", "aloha", "stretch"];

/// In what a data set of LeRobot writes angles.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LerobotUnit {
    /// rad, as simulators write them.
    Rad,
    /// Degrees (`use_degrees`); a gripper in per cent.
    Deg,
    /// Per cent of each joint's calibrated range, -100 to 100; of a gripper's 0 to 100.
    Percent,
}

impl LerobotUnit {
    /// The unit of a name: `rad`, `deg`, `percent`.
    pub fn named(name: &str) -> Option<LerobotUnit> {
        match name {
            "rad" => Some(LerobotUnit::Rad),
            "deg" => Some(LerobotUnit::Deg),
            "percent" => Some(LerobotUnit::Percent),
            _ => None,
        }
    }

    fn words(self) -> &'static str {
        match self {
            LerobotUnit::Rad => "in rad",
            LerobotUnit::Deg => "in deg, a gripper's in per cent of its calibrated range",
            LerobotUnit::Percent => "in per cent of each joint's calibrated range",
        }
    }
}

/// A joint of the robot, and that of the log.
pub(super) type Pair<'a> = (&'a MovingJoint, &'a JointGuess, &'a LogJoint);

/// Why a unit was guessed.
const GUESSED: &str = "a guess from their range; else say --unit, of per cent --calibration, too";
/// Why zero is where it is.
const ZERO: &str = "LeRobot takes the middle of a calibrated range for the file's 0, the least of \
                    a gripper's for its lower end";

/// Units of the joints of one data set.
pub(super) struct AngleUnits<'a> {
    pub log: &'a RawLog,
    pub file: &'a str,
    pub ask: &'a RobotLog<'a>,
    unit: LerobotUnit,
    /// For each joint, its servo.
    motors: Vec<Option<MotorCalibration>>,
    is_dynamixel: bool,
    /// Whether a gripper's degrees are per cent: those of a table need not be LeRobot's.
    is_dataset: bool,
}

impl<'a> AngleUnits<'a> {
    /// The units, said; `pairs` are the robot's joints with those of the log.
    ///
    /// # Errors
    /// A calibration without the joints, a unit that nothing tells, per cent without a calibration.
    pub fn of(
        log: &'a RawLog,
        file: &'a str,
        ask: &'a RobotLog<'a>,
        pairs: &[Pair<'_>],
        said: &mut Vec<Guess>,
    ) -> Result<AngleUnits<'a>> {
        let robot_type = log
            .dataset
            .as_ref()
            .and_then(|facts| facts.robot_type.as_deref());
        let is_dynamixel =
            robot_type.is_some_and(|own| DYNAMIXEL.iter().any(|known| own.contains(known)));
        let mut units = AngleUnits {
            log,
            file,
            ask,
            unit: LerobotUnit::Rad,
            motors: vec![None; pairs.len()],
            is_dynamixel,
            is_dataset: log.dataset.is_some(),
        };
        if let Some(calibration) = ask.calibration {
            let all: Vec<LogJoint> = calibration.names().map(of_motor).collect();
            let names: Vec<&str> = pairs.iter().map(|(.., own)| own.name.as_str()).collect();
            let places = matched(&names, &all, &[], "the calibration").map_err(|error| {
                let remedy = "give the calibration of the robot that recorded the data set";
                Error::usage(error.to_string(), remedy)
            })?;
            let motor = |(index, _): (usize, _)| calibration.motor(&all[index].name);
            units.motors = places.into_iter().map(motor).collect();
        }
        units.unit = units.decided(pairs, said)?;
        Ok(units)
    }

    /// The unit of all angles, said.
    fn decided(&self, pairs: &[Pair], said: &mut Vec<Guess>) -> Result<LerobotUnit> {
        let (unit, why) = match (self.ask.unit, self.ask.calibration) {
            (Some(LerobotUnit::Percent), None) => {
                return Err(Error::usage(
                    "--unit percent: nothing tells the range of each joint",
                    "give the robot's calibration: --calibration FILE.json",
                ));
            }
            (Some(unit), _) => (unit, "as you say"),
            (None, None) => (self.guessed(pairs), GUESSED),
            (None, Some(_)) if pairs.iter().any(|pair| self.is_beyond(pair)) => {
                let why = "some lie beyond 100, so they are no per cent";
                (LerobotUnit::Deg, why)
            }
            (None, Some(_)) => {
                return Err(Error::usage(
                    format!(
                        "{}: degrees or per cent, which nothing in it tells",
                        self.file
                    ),
                    "say --unit deg (LeRobot's use_degrees) or --unit percent",
                ));
            }
        };
        let words = match unit {
            // Without a calibration a table's gripper has no per cent.
            LerobotUnit::Deg if !self.is_dataset && self.ask.calibration.is_none() => "in deg",
            _ => unit.words(),
        };
        said.push(Guess::new("angles", words, why));
        if unit != LerobotUnit::Rad {
            said.push(Guess::new("angle zero", "that of the robot's file", ZERO));
        }
        Ok(unit)
    }

    /// Degrees where an angle goes farther than one in rad.
    fn guessed(&self, pairs: &[Pair]) -> LerobotUnit {
        let is_deg = |(_, joint, _): &Pair| {
            let position = joint.position.as_ref();
            position.is_some_and(|own| own.unit == "deg")
        };
        if pairs.iter().any(is_deg) {
            LerobotUnit::Deg
        } else {
            LerobotUnit::Rad
        }
    }

    /// Whether an angle lies where no per cent do.
    fn is_beyond(&self, (_, joint, own): &Pair) -> bool {
        let position = joint.position.as_ref().filter(|_| !is_gripper(&own.name));
        let values = position.and_then(|own| range(&self.log.columns[own.index]));
        values.is_some_and(|(low, high)| low.min(-high) < -100.0 - ROUNDED)
    }

    /// The lines of a joint's `[[log.joint]]`.
    ///
    /// # Errors
    /// Values that the unit does not have; a gripper in per cent whose range nothing tells.
    pub fn columns(&self, index: usize, (joint, own, name): Pair) -> Result<String> {
        let Some(position) = &own.position else {
            return Ok(columns_of(None, own, joint));
        };
        let is_deg = self.unit == LerobotUnit::Deg;
        let is_percent = self.unit == LerobotUnit::Percent;
        let motor = self.motors[index];
        let scaled = match (is_gripper(&name.name), motor) {
            (true, None) if is_deg && self.is_dataset => {
                return Err(self.gripper_range(joint, name));
            }
            (true, Some(motor)) if is_deg || is_percent => {
                self.within(position, (0.0, 100.0), name)?;
                self.gripper(motor, joint)
            }
            (_, Some(motor)) if is_percent => {
                self.within(position, (-100.0, 100.0), name)?;
                Scaled {
                    unit: ("ticks", Some(motor.per_turn(200.0))),
                    reversed: self.is_reversed(motor),
                    offset_rad: 0.0,
                }
            }
            (_, Some(_)) if is_deg => Scaled::in_unit("ticks", Some(DEGREES_PER_TURN)),
            (_, None) if is_deg => Scaled::in_unit("deg", None),
            _ => Scaled::in_unit("rad", None),
        };
        if joint.slides && scaled.unit.0 != "rad" {
            let what = format!(
                "joint {} slides, and {} is an angle or per cent",
                joint.name, name.shown
            );
            return Err(Error::usage(what, self.hold(joint)));
        }
        // A speed's unit was guessed by the angle's: of another one it says nothing.
        let is_same = scaled.unit.0 == position.unit;
        let mut own = own.clone();
        own.velocity.take_if(|_| !is_same);
        for column in [&mut own.position]
            .into_iter()
            .chain([&mut own.input])
            .flatten()
        {
            let is_angle = column.index == position.index || own.drive == "position";
            if is_angle {
                scaled.put(column);
            }
        }
        Ok(columns_of(
            motor.filter(|_| scaled.unit.0 == "ticks"),
            &own,
            joint,
        ))
    }

    fn is_reversed(&self, motor: MotorCalibration) -> bool {
        motor.is_reversed && !self.is_dynamixel
    }

    /// Per cent of a gripper: 0 is the lower end of its range, in the robot's file or about 0.
    fn gripper(&self, motor: MotorCalibration, joint: &MovingJoint) -> Scaled {
        let span_rad = motor.range_rad();
        let low_rad = joint.range.map_or(-span_rad / 2.0, |(low, _)| low);
        let reversed = self.is_reversed(motor);
        Scaled {
            unit: ("ticks", Some(motor.per_turn(100.0))),
            reversed,
            offset_rad: if reversed {
                low_rad + span_rad
            } else {
                low_rad
            },
        }
    }

    /// Refuses values that LeRobot would not have written.
    fn within(&self, column: &ColumnGuess, (low, high): (f64, f64), name: &LogJoint) -> Result<()> {
        let found = range(&self.log.columns[column.index]).unwrap_or((low, low));
        let beyond = [found.0, found.1]
            .into_iter()
            .find(|value| *value < low - ROUNDED || *value > high + ROUNDED);
        let Some(beyond) = beyond else {
            return Ok(());
        };
        let file = self
            .log
            .dataset
            .as_ref()
            .map(|facts: &DatasetFacts| facts.info.as_path());
        let place = Place::file(file.unwrap_or(std::path::Path::new(self.file)));
        let shown = &name.shown;
        let what = format!("{shown} is {beyond}, beyond the {low} to {high} of per cent");
        let remedy = "say --unit deg where LeRobot wrote degrees (use_degrees)";
        Err(Error::data(place, what, remedy))
    }

    /// Nothing tells how far a gripper moves.
    fn gripper_range(&self, joint: &MovingJoint, name: &LogJoint) -> Error {
        let what = format!(
            "{}: LeRobot writes it in per cent of its calibrated range, never in degrees",
            name.shown
        );
        Error::usage(what, self.hold(joint))
    }

    fn hold(&self, joint: &MovingJoint) -> String {
        let name = &joint.name;
        format!(
            "hold it, --lock {name}=0, or give the robot's calibration, --calibration FILE.json"
        )
    }
}

/// How a joint's angles are written.
#[derive(Debug, Clone, Copy)]
struct Scaled {
    unit: (&'static str, Option<f64>),
    reversed: bool,
    offset_rad: f64,
}

impl Scaled {
    fn in_unit(unit: &'static str, scale: Option<f64>) -> Scaled {
        Scaled {
            unit: (unit, scale),
            reversed: false,
            offset_rad: 0.0,
        }
    }

    fn put(&self, column: &mut ColumnGuess) {
        (column.unit, column.scale) = self.unit;
        (column.reversed, column.offset_rad) = (self.reversed, self.offset_rad);
    }
}

/// Whether LeRobot writes a joint of this name from 0 to 100.
fn is_gripper(name: &str) -> bool {
    name == "gripper" || name.ends_with("_gripper")
}

fn of_motor(name: &str) -> LogJoint {
    LogJoint {
        name: name.to_string(),
        shown: name.to_string(),
        column: name.to_string(),
        is_left_over: false,
    }
}

/// Whether the log's columns are a data set's.
pub(super) fn is_lerobot(guess: &LogGuess) -> bool {
    let mut joints = guess.joints.iter();
    joints.any(|joint| {
        let position = joint.position.as_ref();
        position.is_some_and(|own| own.name.starts_with(crate::lerobot::STATE))
    })
}
