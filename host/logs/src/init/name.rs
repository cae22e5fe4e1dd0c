//! Words of a column's name: the quantity, the unit and the joint they say.

use super::counts::counts;
use super::words::{
    AXES, DERIVED, DUTY, EFFORT, GOAL, MEASURED, ON, OTHER, PER_TURN, PLAIN, POSITION, SEGMENT,
    SUPPLY, TIME, TORQUE, UNIT_WORDS, VELOCITY, is_one_of,
};
use crate::model::{Dimension, Unit};

/// What a column's name says it holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Role {
    /// Time.
    Time,
    /// Marks separate motions.
    Segment,
    /// Supply voltage.
    Supply,
    /// Whether the drives are energised.
    TorqueOn,
    /// Mass bolted to the last link.
    Payload,
    /// Measured angle.
    Position,
    /// Measured speed.
    Velocity,
    /// Torque, N m.
    Torque,
    /// A torque under a name that often means something else: `effort`, `u`.
    Effort,
    /// Goal angle.
    GoalPosition,
    /// Goal speed.
    GoalVelocity,
    /// Share of the full voltage.
    Duty,
}

/// A column's name, understood.
#[derive(Debug, Clone, PartialEq)]
pub struct NameGuess {
    /// What it holds; nothing that a model needs without.
    pub role: Option<Role>,
    /// Unit that the name ends in, and counts per turn where it says them.
    pub unit: Option<(&'static str, Option<f64>)>,
    /// What is left of the name: `1`, `shoulder`; empty where there is one joint.
    pub joint: String,
    /// How direct the value is: 0 measured, then plain, then filtered and the like.
    pub rank: u8,
}

impl NameGuess {
    /// Unit of a reading of this name, SI where it says none; none of times, marks and names that
    /// tell no quantity. Ticks whose size it does not say are those of the finest encoder.
    pub fn reading_unit(&self) -> Option<Unit> {
        let in_si = match self.role? {
            Role::Time | Role::Segment | Role::TorqueOn => return None,
            Role::Supply => "V",
            Role::Payload => "kg",
            Role::Position | Role::GoalPosition => "rad",
            Role::Velocity | Role::GoalVelocity => "rad/s",
            Role::Torque | Role::Effort => "N m",
            Role::Duty => "1",
        };
        let said = self.unit.and_then(|(unit, ticks)| {
            let finest = (unit == "ticks").then(|| counts(f64::INFINITY));
            Unit::named(unit, ticks.or(finest))
        });
        let said = said.filter(|unit| unit.dimension != Dimension::Time);
        said.or_else(|| Unit::named(in_si, None))
    }
}

/// Takes a column's name apart.
pub fn name_guess(name: &str) -> NameGuess {
    let (bare, bracketed) = bracketed(name);
    let (words, bracketed) = match bracketed.filter(|text| is_number_of_joint(bare, text)) {
        Some(_) => (words(name), None),
        None => (words(bare), bracketed),
    };
    let (unit, unit_words) = unit(&words, bracketed);
    let has = |list: &str| words.iter().any(|word| is_one_of(list, word));
    let is_time = is_time(&words) || is_time(&self::words(field_of(name)));
    let role = role(&words, is_time, unit.map(|(unit, _)| unit));
    let unit = unit.or_else(|| Some((joint_state_unit(name, role?)?, None)));
    let lists = [
        TIME, SEGMENT, SUPPLY, ON, GOAL, TORQUE, EFFORT, DUTY, VELOCITY, POSITION, MEASURED,
        DERIVED, PLAIN,
    ];
    let left = words[..words.len() - unit_words].iter();
    let left = left.filter(|word| !lists.iter().any(|list| is_one_of(list, word)));
    let joint = left.cloned().collect::<Vec<_>>().join("_");
    let rank = match (has(MEASURED), has(DERIVED)) {
        (_, true) => 2,
        (true, false) => 0,
        (false, false) => 1,
    };
    NameGuess {
        role,
        unit,
        joint,
        rank,
    }
}

/// Whether a number in brackets says which joint is meant: `pos (2)`, `q[1]`. A duty in `[1]` is a
/// share.
fn is_number_of_joint(bare: &str, text: &str) -> bool {
    let is_number = !text.is_empty() && text.bytes().all(|byte| byte.is_ascii_digit());
    let is_duty = || words(bare).iter().any(|word| is_one_of(DUTY, word));
    is_number && !(text == "1" && is_duty())
}

/// Whether a name is that of a topic of ROS joint states, or of the state of a controller of
/// joints, as PlotJuggler writes it, or `rostopic echo -p`.
pub fn is_joint_state(name: &str) -> bool {
    let name = name.to_lowercase();
    let printed = ["field.position", "field.velocity", "field.effort"];
    name.contains("joint_states/")
        || name.contains("trajectory_controller/")
        || printed.iter().any(|begin| name.starts_with(begin))
}

/// The unit that joint states have by definition.
fn joint_state_unit(name: &str, role: Role) -> Option<&'static str> {
    let unit = match role {
        Role::Position => "rad",
        Role::Velocity => "rad/s",
        Role::Effort | Role::Torque => "N m",
        _ => return None,
    };
    is_joint_state(name).then_some(unit)
}

/// Whether some word of a name is one for an angle.
pub fn names_an_angle(name: &str) -> bool {
    let words = words(bracketed(name).0);
    words.iter().any(|word| is_one_of(POSITION, word))
}

/// Whether a name says that the column holds a current.
pub fn says_current(name: &str) -> bool {
    let words = words(bracketed(name).0);
    words.iter().any(|word| word == "current")
}

/// The last part of a name: `time` of MATLAB's `log.time`.
fn field_of(name: &str) -> &str {
    name.rsplit('.').next().unwrap_or(name)
}

fn is_time(words: &[String]) -> bool {
    let first = words.first();
    first.is_some_and(|word| is_one_of(TIME, word))
}

fn role(words: &[String], is_time: bool, unit: Option<&'static str>) -> Option<Role> {
    let has = |list: &str| words.iter().any(|word| is_one_of(list, word));
    let is = |unit: Option<&str>, names: &[&str]| unit.is_some_and(|unit| names.contains(&unit));
    let speed = has(VELOCITY) || is(unit, &["rad/s", "deg/s", "rpm"]) || has("dot");
    let torque = has(TORQUE) || is(unit, &["N m", "mN m", "kgf cm"]);
    if has(ON) {
        return Some(Role::TorqueOn);
    }
    if is_time {
        return Some(Role::Time);
    }
    let other = has(OTHER);
    let moves = speed || has(POSITION);
    let goal = has(GOAL) || (has("input") && moves);
    match () {
        () if has(SEGMENT) => Some(Role::Segment),
        () if has("payload") => Some(Role::Payload),
        () if other || (has(AXES) && !speed) => None,
        () if torque => Some(Role::Torque),
        () if has(DUTY) => Some(Role::Duty),
        // ODrive's `input_pos` is what the drive is given.
        () if goal && speed => Some(Role::GoalVelocity),
        () if goal => Some(Role::GoalPosition),
        () if speed => Some(Role::Velocity),
        () if has(POSITION) || is(unit, &["rad", "deg", "turn", "ticks"]) => Some(Role::Position),
        () if has(SUPPLY) => Some(Role::Supply),
        () if has(EFFORT) => Some(Role::Effort),
        () => None,
    }
}

/// The name without the unit in brackets behind it, and that unit: `angle [deg]`.
fn bracketed(name: &str) -> (&str, Option<&str>) {
    let name = name.trim();
    for (open, close) in [('[', ']'), ('(', ')'), ('<', '>')] {
        if let Some((bare, unit)) = name.strip_suffix(close).and_then(|n| n.rsplit_once(open)) {
            return (bare, Some(unit.trim()));
        }
    }
    (name, None)
}

/// The unit, and of how many words at the end it is made.
fn unit(words: &[String], bracketed: Option<&str>) -> (Option<(&'static str, Option<f64>)>, usize) {
    if let Some(text) = bracketed {
        // What a motor's ampere is in N m no header says.
        let known = Unit::named(text, Some(1.0)).map(|unit| unit.name);
        let known = known.filter(|name| !["A", "mA"].contains(name));
        let known = known.or_else(|| unit_word(&self::words(text).join("_")));
        return (known.map(|unit| (unit, None)), 0);
    }
    if let [_, .., word] = words
        && let Some((_, per_turn)) = PER_TURN.iter().find(|(known, _)| known == word)
    {
        return (Some(("ticks", Some(*per_turn))), 1);
    }
    if let [.., word, number] = words {
        let turn = number.parse::<f64>().ok().filter(|turn| *turn >= 100.0);
        if let (Some("ticks"), Some(turn)) = (unit_word(word), turn) {
            return (Some(("ticks", Some(turn))), 2);
        }
    }
    for count in (1..=3.min(words.len().saturating_sub(1))).rev() {
        let tail = words[words.len() - count..].join("_");
        if let Some(unit) = unit_word(&tail) {
            return (Some((unit, None)), count);
        }
    }
    (None, 0)
}

fn unit_word(text: &str) -> Option<&'static str> {
    let mut known = UNIT_WORDS.iter();
    let known = known.find(|(_, words)| is_one_of(words, text));
    known.map(|(unit, _)| *unit)
}

/// Lower-case words: cut at signs, between small and capital letters, and around digits.
fn words(name: &str) -> Vec<String> {
    let mut words: Vec<String> = Vec::new();
    let mut last = ' ';
    for letter in name.chars() {
        let begins = !last.is_alphanumeric()
            || last.is_numeric() != letter.is_numeric()
            || (last.is_lowercase() && letter.is_uppercase());
        if letter.is_alphanumeric() {
            match words.last_mut().filter(|_| !begins) {
                Some(word) => word.extend(letter.to_lowercase()),
                None => words.push(letter.to_lowercase().collect()),
            }
        }
        last = letter;
    }
    words
}

#[cfg(test)]
mod tests;
