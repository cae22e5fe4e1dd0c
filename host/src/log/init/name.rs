//! Words of a column's name: the quantity, the unit and the joint they say.

use crate::model::Unit;

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

/// Unit suffixes, words joined by `_`, longest first; only those that are no unit's own name.
const UNIT_WORDS: &[(&str, &str)] = &[
    ("rad_s", "rad/s"),
    ("rad_sec", "rad/s"),
    ("rads", "rad/s"),
    ("radps", "rad/s"),
    ("rad_per_s", "rad/s"),
    ("deg_s", "deg/s"),
    ("deg_sec", "deg/s"),
    ("deg_per_s", "deg/s"),
    ("dps", "deg/s"),
    ("rpm", "rpm"),
    ("mn_m", "mN m"),
    ("mnm", "mN m"),
    ("n_m", "N m"),
    ("nm", "N m"),
    ("kgf_cm", "kgf cm"),
    ("kgfcm", "kgf cm"),
    ("kg_cm", "kgf cm"),
    ("kgcm", "kgf cm"),
    ("rad", "rad"),
    ("radian", "rad"),
    ("radians", "rad"),
    ("deg", "deg"),
    ("degree", "deg"),
    ("degrees", "deg"),
    ("turn", "turn"),
    ("turns", "turn"),
    ("rev", "turn"),
    ("tick", "ticks"),
    ("ticks", "ticks"),
    ("count", "ticks"),
    ("counts", "ticks"),
    ("sec", "s"),
    ("secs", "s"),
    ("seconds", "s"),
    ("msec", "ms"),
    ("usec", "us"),
    ("nsec", "ns"),
    ("ms", "ms"),
    ("us", "us"),
    ("ns", "ns"),
    ("s", "s"),
    ("mv", "mV"),
    ("v", "V"),
    ("volt", "V"),
    ("volts", "V"),
    ("percent", "%"),
    ("pct", "%"),
    ("kg", "kg"),
    ("g", "g"),
];

const TIME: &[&str] = &[
    "t",
    "time",
    "times",
    "timestamp",
    "stamp",
    "elapsed",
    "clock",
    "secs",
];
const SEGMENT: &[&str] = &["segment", "seg", "trial", "episode", "run"];
const SUPPLY: &[&str] = &[
    "supply", "voltage", "volts", "volt", "vin", "vbat", "battery", "vbus",
];
const ON: &[&str] = &["on", "enable", "enabled"];
const GOAL: &[&str] = &[
    "goal",
    "goals",
    "target",
    "desired",
    "des",
    "cmd",
    "command",
    "commanded",
    "commands",
    "ref",
    "reference",
    "setpoint",
    "sp",
];
const TORQUE: &[&str] = &["tau", "torque", "torques", "trq"];
const EFFORT: &[&str] = &["effort", "u", "input", "control", "action"];
const DUTY: &[&str] = &["duty", "pwm"];
const VELOCITY: &[&str] = &[
    "vel",
    "velocity",
    "velocities",
    "speed",
    "dq",
    "qd",
    "qdot",
    "dtheta",
    "thetadot",
    "dth",
    "dphi",
    "omega",
    "w",
    "rate",
    "gyro",
    "dpos",
    "dangle",
];
const POSITION: &[&str] = &[
    "pos",
    "position",
    "positions",
    "q",
    "angle",
    "angles",
    "theta",
    "th",
    "phi",
    "ang",
    "encoder",
    "enc",
];
/// Directions in space, which say something of a speed alone.
const AXES: &[&str] = &["x", "y", "z"];
/// Quantities that no model reads.
const OTHER: &[&str] = &[
    "acc",
    "accel",
    "acceleration",
    "ddq",
    "qdd",
    "ddtheta",
    "jerk",
    "fric",
    "friction",
    "temp",
    "temperature",
    "error",
    "err",
    "load",
    "current",
    "index",
    "row",
    "code",
    "zero",
    "celsius",
    "power",
];
const MEASURED: &[&str] = &[
    "meas", "measured", "actual", "act", "present", "fb", "feedback",
];
const DERIVED: &[&str] = &[
    "filt",
    "filtered",
    "est",
    "estimated",
    "estimate",
    "sim",
    "simulated",
    "con",
    "ctrl",
    "raw",
    "smooth",
    "smoothed",
    "lp",
    "pred",
    "predicted",
];
/// Words that say nothing of which joint is meant.
const PLAIN: &[&str] = &[
    "joint", "joints", "servo", "servos", "motor", "axis", "link", "state", "states", "dof", "j",
    "data", "dot", "in", "per",
];

/// Takes a column's name apart.
pub fn name_guess(name: &str) -> NameGuess {
    let (bare, bracketed) = bracketed(name);
    let words = words(bare);
    let (unit, unit_words) = unit(&words, bracketed);
    let has = |set: &[&str]| words.iter().any(|word| set.contains(&word.as_str()));
    let role = role(&words, unit.map(|(unit, _)| unit));
    let sets = [
        TIME, SEGMENT, SUPPLY, ON, GOAL, TORQUE, EFFORT, DUTY, VELOCITY, POSITION, MEASURED,
        DERIVED, PLAIN,
    ];
    let left = words[..words.len() - unit_words].iter();
    let left = left.filter(|word| !sets.iter().any(|set| set.contains(&word.as_str())));
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

fn role(words: &[String], unit: Option<&'static str>) -> Option<Role> {
    let has = |set: &[&str]| words.iter().any(|word| set.contains(&word.as_str()));
    let is = |unit: Option<&str>, names: &[&str]| unit.is_some_and(|unit| names.contains(&unit));
    let speed = has(VELOCITY) || is(unit, &["rad/s", "deg/s", "rpm"]) || has(&["dot"]);
    let torque = has(TORQUE) || is(unit, &["N m", "mN m", "kgf cm"]);
    if has(ON) {
        return Some(Role::TorqueOn);
    }
    if words
        .first()
        .is_some_and(|word| TIME.contains(&word.as_str()))
    {
        return Some(Role::Time);
    }
    let other = has(OTHER);
    match () {
        () if has(SEGMENT) => Some(Role::Segment),
        () if has(&["payload"]) => Some(Role::Payload),
        () if other || (has(AXES) && !speed) => None,
        () if torque => Some(Role::Torque),
        () if has(DUTY) => Some(Role::Duty),
        () if has(GOAL) && speed => Some(Role::GoalVelocity),
        () if has(GOAL) => Some(Role::GoalPosition),
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
        let known = Unit::named(text, Some(1.0)).map(|unit| unit.name);
        let known = known.or_else(|| unit_word(&self::words(text).join("_")));
        return (known.map(|unit| (unit, None)), 0);
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
    known.find(|(word, _)| *word == text).map(|(_, unit)| *unit)
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
mod tests {
    use super::*;

    fn guess(name: &str) -> (Option<Role>, Option<&'static str>, String) {
        let guess = name_guess(name);
        (guess.role, guess.unit.map(|(unit, _)| unit), guess.joint)
    }

    #[test]
    fn names_of_many_benches_are_understood() {
        use Role::*;
        let cases = [
            ("t", Time, None, ""),
            ("t_s", Time, Some("s"), ""),
            ("time_ms", Time, Some("ms"), ""),
            ("Timestamp [us]", Time, Some("us"), ""),
            ("segment", Segment, None, ""),
            ("theta1", Position, None, "1"),
            ("dtheta1", Velocity, None, "1"),
            ("q2_rad", Position, Some("rad"), "2"),
            ("dq2_rad_s", Velocity, Some("rad/s"), "2"),
            ("pos_meas1", Position, None, "1"),
            ("vel_filt2", Velocity, None, "2"),
            ("tau_meas1", Torque, None, "1"),
            ("pos_count4096", Position, Some("ticks"), ""),
            ("shoulder.position", Position, None, "shoulder"),
            ("joint_goals/servo3.position", GoalPosition, None, "3"),
            ("elbow.effort", Effort, None, "elbow"),
            ("goal_rad", GoalPosition, Some("rad"), ""),
            ("goalSpeed[rpm]", GoalVelocity, Some("rpm"), ""),
            ("PresentPosition (deg)", Position, Some("deg"), ""),
            ("theta_dot", Velocity, None, ""),
            ("supply_v", Supply, Some("V"), ""),
            ("input_volts", Supply, Some("V"), ""),
            ("torque_on", TorqueOn, None, ""),
            ("torque_enable", TorqueOn, None, ""),
            ("duty1", Duty, None, "1"),
            ("Joint 1 Angle (deg)", Position, Some("deg"), "1"),
            ("gyro_rad_s", Velocity, Some("rad/s"), ""),
        ];
        for (name, role, unit, joint) in cases {
            assert_eq!(guess(name), (Some(role), unit, joint.to_string()), "{name}");
        }
        for name in [
            "",
            "tau_fric1",
            "temperature1_celsius",
            "ddq1",
            "error2",
            "load1",
            "gyro_code",
        ] {
            assert_eq!(guess(name).0, None, "{name}");
        }
        assert_eq!(
            name_guess("pos_count4096").unit,
            Some(("ticks", Some(4096.0)))
        );
        assert!(name_guess("pos_meas1").rank < name_guess("pos_filt1").rank);
    }
}
