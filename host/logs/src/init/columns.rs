//! Which column of a log is what, guessed from names and values.

use super::Guess;
use super::coding::coding;
use super::counts::{counts_beside, counts_of};
use super::dataset::{self, give_lerobot_roles, is_lerobot};
use super::inputs::give_inputs;
use super::log_guess::{ColumnGuess, JointGuess, LogGuess};
use super::name::{NameGuess, Role, is_joint_state, name_guess};
use super::segment::stepping_segment;
use super::unused::{say_file, say_unused};
use super::values::{angle_unit, duty_unit, median, range, speed_fit, stays_by};
use crate::RawLog;
use crate::error::{Place, Result};
use crate::model::Unit;
use crate::output::shortened;
use crate::read::no_sample;

/// Roles of a joint's columns.
const OF_JOINTS: [Role; 7] = [
    Role::Position,
    Role::Velocity,
    Role::Torque,
    Role::GoalPosition,
    Role::GoalVelocity,
    Role::Duty,
    Role::Effort,
];

/// Inputs in the order in which they are believed, and their drives.
pub(super) const INPUTS: [(Role, &str); 5] = [
    (Role::Torque, "torque"),
    (Role::GoalPosition, "position"),
    (Role::GoalVelocity, "speed"),
    (Role::Duty, "duty"),
    (Role::Effort, "torque"),
];

/// Guesses columns and units; `drive` says which input to take, where the user knows.
///
/// # Errors
/// No time, or neither an angle nor a speed among the names.
pub fn log_guess(
    log: &RawLog,
    file: &str,
    drive: Option<&str>,
    said: &mut Vec<Guess>,
) -> Result<LogGuess> {
    let mut names: Vec<NameGuess> = log.names.iter().map(|name| name_guess(name)).collect();
    if !names.is_empty() && log.columns.iter().all(Vec::is_empty) {
        return Err(no_sample().at(Place::file(file)));
    }
    let is_lerobot = is_lerobot(log.names.iter().map(String::as_str));
    if is_lerobot {
        give_lerobot_roles(log, &mut names);
    }
    give_inputs(&mut names);
    let reader = GuessReader {
        log,
        names,
        drive,
        is_lerobot,
    };
    let time = reader.time(file, said)?;
    let time_s = time.si(log);
    let mut joints = Vec::new();
    for name in reader.joints() {
        joints.extend(reader.joint(&name, &time_s, said));
    }
    if joints.iter().any(|joint| joint.position.is_some()) {
        joints.retain(|joint| joint.position.is_some());
    }
    if joints.is_empty() {
        return Err(reader.no_joint(file));
    }
    let name_of = |role: Role| reader.first(role).map(|index| log.names[index].clone());
    let segment = name_of(Role::Segment);
    let guess = LogGuess {
        segment: segment.or_else(|| stepping_segment(log, time.index, said)),
        torque_on: name_of(Role::TorqueOn).filter(|name| is_flag(log, name)),
        supply: reader
            .first(Role::Supply)
            .map(|index| reader.supply(index, said)),
        time,
        joints,
        payload: None,
        knows_links: false,
    };
    say_file(log, &guess, said);
    say_unused(log, &reader.names, &guess, said);
    Ok(guess)
}

fn is_flag(log: &RawLog, name: &str) -> bool {
    let index = log.names.iter().position(|known| known == name);
    index.is_some_and(|index| log.columns[index].iter().all(|v| *v == 0.0 || *v == 1.0))
}

pub(super) struct GuessReader<'a> {
    pub log: &'a RawLog,
    pub names: Vec<NameGuess>,
    drive: Option<&'a str>,
    is_lerobot: bool,
}

impl GuessReader<'_> {
    fn first(&self, role: Role) -> Option<usize> {
        self.names.iter().position(|name| name.role == Some(role))
    }

    fn column(&self, index: usize, unit: (&'static str, Option<f64>)) -> ColumnGuess {
        let mut scale = unit.1;
        if unit.0 == "ticks" && scale.is_none() {
            scale = Some(self.counts_per_turn(index));
        }
        ColumnGuess {
            index,
            name: self.log.names[index].clone(),
            unit: unit.0,
            scale,
            reversed: false,
            offset_rad: 0.0,
        }
    }

    /// Counts per turn of a column of counts: as its joint's goals say, if they are angles, else as
    /// far as it reaches.
    fn counts_per_turn(&self, index: usize) -> f64 {
        let values = &self.log.columns[index];
        let goal = self
            .of_joint(&self.names[index].joint, Role::GoalPosition)
            .and_then(|goal| {
                let unit = self.names[goal].unit.filter(|(name, _)| *name != "ticks")?;
                let unit = Unit::named(unit.0, unit.1)?;
                let goals = self.log.columns[goal].iter();
                Some(goals.map(|value| unit.to_si(*value)).collect::<Vec<f64>>())
            });
        let beside = goal.and_then(|goal_rad| counts_beside(values, &goal_rad));
        beside.unwrap_or_else(|| counts_of(values))
    }

    /// The column in its name's unit if that measures the right thing, else in the one guessed.
    pub(super) fn with_unit(
        &self,
        index: usize,
        what: &str,
        guessed: (&'static str, Option<f64>),
        why: &str,
        said: &mut Vec<Guess>,
    ) -> ColumnGuess {
        let dimension = |name: &str| Unit::named(name, Some(1.0)).map(|unit| unit.dimension);
        let named = self.names[index].unit;
        let named = named.filter(|(name, _)| dimension(name) == dimension(guessed.0));
        let si = Unit::named(guessed.0, guessed.1).map(|unit| unit.dimension.si_unit());
        let defined = si.filter(|si| self.log.is_si && !si.is_empty() && *si != "s");
        let (unit, why) = match (named, defined) {
            (Some(named), _) if is_joint_state(&self.log.names[index]) => {
                (named, dataset::ROS_UNIT)
            }
            (Some(named), _) => (named, "its name"),
            (None, Some(si)) => ((si, None), dataset::FORMAT_UNIT),
            (None, None) => (guessed, why),
        };
        let column = self.column(index, unit);
        said.push(Guess::new(
            what,
            format!("column {:?} in {}", column.name, column.unit_words()),
            why,
        ));
        column
    }

    /// Names of the joints, numbers in their order, others as they come.
    fn joints(&self) -> Vec<String> {
        let mut joints: Vec<String> = Vec::new();
        let own = self
            .names
            .iter()
            .filter(|name| name.role.is_some_and(|r| OF_JOINTS.contains(&r)));
        for name in own {
            if !joints.contains(&name.joint) {
                joints.push(name.joint.clone());
            }
        }
        if joints.iter().all(|joint| joint.parse::<u64>().is_ok()) {
            joints.sort_by_key(|joint| joint.parse::<u64>().unwrap_or(0));
        }
        joints
    }

    /// The most direct column of a role at a joint, if one moves or may stand still.
    fn of_joint(&self, joint: &str, role: Role) -> Option<usize> {
        let mine = |index: &usize| {
            let name = &self.names[*index];
            let ticks = name.unit.is_some_and(|(unit, _)| unit == "ticks");
            name.joint == joint
                && name.role == Some(role)
                && range(&self.log.columns[*index]).is_some()
                && !(ticks && role == Role::Velocity)
        };
        let rank = |index: &usize| {
            let name = &self.names[*index];
            (
                name.rank,
                name.unit.is_some_and(|(unit, _)| unit == "ticks"),
            )
        };
        (0..self.names.len()).filter(mine).min_by_key(rank)
    }

    fn joint(&self, name: &str, time_s: &[f64], said: &mut Vec<Guess>) -> Option<JointGuess> {
        let of = |what: &str| match name {
            "" => what.to_string(),
            name => format!("{what} of joint {name}"),
        };
        let why = match self.is_lerobot {
            // Said once.
            true if said.iter().any(|guess| guess.why == dataset::LEROBOT_UNIT) => "likewise",
            true => dataset::LEROBOT_UNIT,
            false => "the range of its values",
        };
        let position = self
            .of_joint(name, Role::Position)
            .filter(|index| self.is_plain(*index, &of("angle"), &[], None, said));
        let position = position.map(|index| {
            let (guessed, why) = match angle_unit(&self.log.columns[index]) {
                ("rad", _) if self.some_angle_is_deg() => {
                    (("deg", None), "the unit of the other angles")
                }
                own => (own, why),
            };
            self.with_unit(index, &of("angle"), guessed, why, said)
        });
        let angle = position.as_ref().map(|column| column.si(self.log));
        let velocity = self
            .of_joint(name, Role::Velocity)
            .filter(|index| self.is_plain(*index, &of("speed"), time_s, angle.as_deref(), said))
            .map(|index| self.velocity(index, &of("speed"), time_s, angle.as_deref(), said));
        if position.is_none() && velocity.is_none() {
            return None;
        }
        let (drive, input) = self.input(name, &of("input"), position.as_ref(), said);
        Some(JointGuess {
            name: name.to_string(),
            position,
            velocity,
            drive,
            input,
        })
    }

    /// Whether an angle whose name says no unit goes farther than one in rad. One program writes
    /// all its angles in one unit.
    fn some_angle_is_deg(&self) -> bool {
        let is_open = |index: &usize| {
            let name = &self.names[*index];
            name.role == Some(Role::Position) && name.unit.is_none()
        };
        let mut open = (0..self.names.len()).filter(is_open);
        open.any(|index| angle_unit(&self.log.columns[index]).0 == "deg")
    }

    /// Whether a column holds plain numbers; says how else they are coded.
    fn is_plain(
        &self,
        index: usize,
        what: &str,
        time_s: &[f64],
        angle_rad: Option<&[f64]>,
        said: &mut Vec<Guess>,
    ) -> bool {
        let coding = coding(&self.log.columns[index], time_s, angle_rad);
        if let Some(coding) = coding {
            let name = shortened(&self.log.names[index]);
            let guess = format!("column {name:?} not taken: {}", coding.words());
            said.push(Guess::new(what, guess, coding.remedy()));
        }
        coding.is_none()
    }

    fn velocity(
        &self,
        index: usize,
        what: &str,
        time_s: &[f64],
        angle_rad: Option<&[f64]>,
        said: &mut Vec<Guess>,
    ) -> ColumnGuess {
        let fit = angle_rad.and_then(|a| speed_fit(time_s, a, &self.log.columns[index]));
        let (unit, why) = match fit {
            Some(fit) => (fit.unit, "the slope of the angles"),
            None => ("rad/s", "a guess: no angle's slope tells"),
        };
        let mut column = self.with_unit(index, what, (unit, None), why, said);
        if fit.is_some_and(|fit| fit.reversed) {
            column.reversed = true;
            said.push(Guess::new(
                what,
                "counts the other way round",
                "the slope of the angles",
            ));
        }
        column
    }

    fn input(
        &self,
        joint: &str,
        what: &str,
        position: Option<&ColumnGuess>,
        said: &mut Vec<Guess>,
    ) -> (&'static str, Option<ColumnGuess>) {
        let wanted = |drive: &str| self.drive.is_none_or(|wanted| wanted == drive);
        let found = INPUTS
            .iter()
            .filter(|(_, drive)| wanted(drive))
            .find_map(|(role, drive)| {
                let index = self.of_joint(joint, *role)?;
                let values = &self.log.columns[index];
                // What is constant but not 0 drives all the same, as a topic that is sent once.
                let idle = *drive != "position" && range(values) == Some((0.0, 0.0));
                let is_open = *role == Role::Effort && self.names[index].unit.is_none();
                let drive = if is_open && position.is_some() && self.actions_are_goals() {
                    "position"
                } else {
                    *drive
                };
                (!idle && self.is_plain(index, what, &[], None, said)).then_some((index, drive))
            });
        let Some((index, drive)) = found else {
            return ("passive", None);
        };
        let values = &self.log.columns[index];
        let follows = self.names[index].role == Some(Role::Effort);
        let like = position.map(|column| (column.unit, column.scale));
        let (unit, why) = match drive {
            "position" if follows => (
                like.unwrap_or_else(|| angle_unit(values)),
                "a goal in the angle's unit: angles stay by theirs",
            ),
            "position" => (
                like.unwrap_or_else(|| angle_unit(values)),
                "the angle's unit",
            ),
            "speed" => (("rad/s", None), "a guess: nothing tells"),
            "duty" => match duty_unit(values) {
                unit @ ("counts", _) => (unit, "a guess: more than 100, so no per cent"),
                unit => (unit, "the range of its values"),
            },
            _ => (("N m", None), "a guess: nothing tells"),
        };
        (drive, Some(self.with_unit(index, what, unit, why, said)))
    }

    /// Whether inputs whose names tell neither unit nor kind of drive are goals: most angles stay
    /// by theirs, as they are written. One program writes all its inputs alike, and a joint that
    /// lags stays by none. Where the user knows the drive, it is what he says.
    fn actions_are_goals(&self) -> bool {
        let stay = self.names.iter().enumerate().filter_map(|(index, name)| {
            let is_open = name.role == Some(Role::Effort) && name.unit.is_none();
            let angle = self
                .of_joint(&name.joint, Role::Position)
                .filter(|_| is_open)?;
            Some(stays_by(&self.log.columns[angle], &self.log.columns[index]))
        });
        let stay: Vec<bool> = stay.collect();
        let goals = stay.iter().filter(|stays| **stays).count();
        self.drive.is_none() && 2 * goals > stay.len()
    }

    fn supply(&self, index: usize, said: &mut Vec<Guess>) -> ColumnGuess {
        let unit = match median(&self.log.columns[index]) {
            level if level > 100.0 => "mV",
            _ => "V",
        };
        self.with_unit(
            index,
            "supply",
            (unit, None),
            "the range of its values",
            said,
        )
    }
}
