//! Which column of a log is what, guessed from names and values.

use super::Guess;
use super::log_guess::{ColumnGuess, JointGuess, LogGuess};
use super::name::{NameGuess, Role, name_guess, says_current};
use super::values::{angle_unit, counts, median, range, speed_fit, stands_still, time_unit};
use crate::error::{Error, Place, Result};
use crate::log::{LogReason, RawLog};
use crate::model::Unit;

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
const INPUTS: [(Role, &str); 5] = [
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
        return Err(Error::refused(Place::file(file), LogReason::NoSample));
    }
    give_inputs(&mut names);
    let reader = GuessReader { log, names, drive };
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
        return Err(Error::data(
            Place::file(file),
            format!("no column is named as an angle or a speed: {}", listed(log)),
            "name the angle's column angle_rad, q1_rad or position, or write the model by hand: \
             docs/model.md",
        ));
    }
    let name_of = |role: Role| reader.first(role).map(|index| log.names[index].clone());
    let guess = LogGuess {
        segment: name_of(Role::Segment),
        torque_on: name_of(Role::TorqueOn).filter(|name| is_flag(log, name)),
        supply: reader
            .first(Role::Supply)
            .map(|index| reader.supply(index, said)),
        time,
        joints,
    };
    reader.say_rest(&guess, said);
    Ok(guess)
}

/// Where the names tell of one joint's angle or speed, inputs that name no joint are that joint's;
/// so is the only input, whatever its name says: `shoulder_deg` with `motor_torque_nm` or `m1_tau`.
fn give_inputs(names: &mut [NameGuess]) {
    let is_input = |name: &NameGuess| INPUTS.iter().any(|(role, _)| name.role == Some(*role));
    let with = |role: Role| -> Vec<&String> {
        let mut joints: Vec<&String> = Vec::new();
        for name in names.iter().filter(|name| name.role == Some(role)) {
            if !joints.contains(&&name.joint) {
                joints.push(&name.joint);
            }
        }
        joints
    };
    let measured = match with(Role::Position) {
        angles if angles.is_empty() => with(Role::Velocity),
        angles => angles,
    };
    let [joint] = measured[..] else {
        return;
    };
    let joint = joint.clone();
    let only = names.iter().filter(|name| is_input(name)).count() == 1;
    for name in names.iter_mut().filter(|name| is_input(name)) {
        if only || name.joint.is_empty() {
            name.joint.clone_from(&joint);
        }
    }
}

fn listed(log: &RawLog) -> String {
    log.names.join(", ")
}

fn is_flag(log: &RawLog, name: &str) -> bool {
    let index = log.names.iter().position(|known| known == name);
    index.is_some_and(|index| log.columns[index].iter().all(|v| *v == 0.0 || *v == 1.0))
}

struct GuessReader<'a> {
    log: &'a RawLog,
    names: Vec<NameGuess>,
    drive: Option<&'a str>,
}

impl GuessReader<'_> {
    fn first(&self, role: Role) -> Option<usize> {
        self.names.iter().position(|name| name.role == Some(role))
    }

    fn column(&self, index: usize, unit: (&'static str, Option<f64>)) -> ColumnGuess {
        let mut ticks = unit.1;
        if unit.0 == "ticks" && ticks.is_none() {
            let highest = range(&self.log.columns[index]).map_or(0.0, |(_, high)| high);
            ticks = Some(counts(highest));
        }
        ColumnGuess {
            index,
            name: self.log.names[index].clone(),
            unit: unit.0,
            ticks_per_turn: ticks,
            reversed: false,
        }
    }

    /// The column in its name's unit if that measures the right thing, else in the one guessed.
    fn with_unit(
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
        let column = self.column(index, named.unwrap_or(guessed));
        let why = if named.is_some() { "its name" } else { why };
        said.push(Guess::new(
            what,
            format!("column {:?} in {}", column.name, column.unit_words()),
            why,
        ));
        column
    }

    fn time(&self, file: &str, said: &mut Vec<Guess>) -> Result<ColumnGuess> {
        let index = self.first(Role::Time).or_else(|| self.log.time()).ok_or_else(|| {
            Error::data(
                Place::file(file),
                format!("no column is named time, and none only grows: {}", listed(self.log)),
                "add a column time_s; rows a fixed period apart are their number times the period",
            )
        })?;
        let unit = match self.log.iso.get(index) {
            Some(true) => "iso8601",
            _ => time_unit(&self.log.columns[index]),
        };
        let why = "the middle step between rows";
        let mut column = self.with_unit(index, "time", (unit, None), why, said);
        if unit == "iso8601" {
            column.unit = unit;
        }
        Ok(column)
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
        let why = "the range of its values";
        let position = self.of_joint(name, Role::Position).map(|index| {
            let guessed = angle_unit(&self.log.columns[index]);
            self.with_unit(index, &of("angle"), guessed, why, said)
        });
        let angle = position.as_ref().map(|column| column.si(self.log));
        let velocity = self
            .of_joint(name, Role::Velocity)
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
                let idle = *drive != "position" && stands_still(&self.log.columns[index]);
                (!idle).then_some((index, *drive))
            });
        let Some((index, drive)) = found else {
            return ("passive", None);
        };
        let values = &self.log.columns[index];
        let like = position.map(|column| (column.unit, column.ticks_per_turn));
        let (unit, why) = match drive {
            "position" => (
                like.unwrap_or_else(|| angle_unit(values)),
                "the angle's unit",
            ),
            "speed" => (("rad/s", None), "a guess: nothing tells"),
            "duty" if range(values).is_some_and(|(low, high)| high.max(-low) > 1.5) => {
                (("%", None), "the range of its values")
            }
            "duty" => (("1", None), "the range of its values"),
            _ => (("N m", None), "a guess: nothing tells"),
        };
        (drive, Some(self.with_unit(index, what, unit, why, said)))
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

    /// Says which columns are not used.
    fn say_rest(&self, guess: &LogGuess, said: &mut Vec<Guess>) {
        let used = guess.names();
        let rest = self
            .log
            .names
            .iter()
            .map(String::as_str)
            .filter(|name| !used.contains(name));
        let rest: Vec<String> = rest.map(|name| format!("{name:?}")).collect();
        if !rest.is_empty() {
            said.push(Guess::new(
                "not used",
                rest.join(", "),
                "another value is more direct, or none needs it",
            ));
        }
        let current = |name: &&String| says_current(name);
        if let Some(name) = self.log.names.iter().find(current)
            && guess.joints.iter().all(|joint| joint.input.is_none())
        {
            let guess = format!("no column; {name:?} is a current");
            let remedy = "drive = \"torque\" takes it as input = { column, unit = \"A\", \
                          torque_constant_nm_a }";
            said.push(Guess::new("input", guess, remedy));
        }
        if self.first(Role::Payload).is_some() {
            let remedy = "payload = { column, unit, at_m } says where it is bolted";
            said.push(Guess::new("payload", "not used", remedy));
        }
    }
}
