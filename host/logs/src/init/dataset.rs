//! Logs whose format says what their columns are: data sets of LeRobot, joint states of ROS.

use super::name::{NameGuess, Role};
use crate::RawLog;
use crate::lerobot::{ACTION, EPISODE, LISTS, STATE, element_of};

/// Why an angle of LeRobot's has the unit that was guessed.
pub const LEROBOT_UNIT: &str = "a guess from its range: LeRobot writes deg, rad or per cent of each \
                                joint's calibrated range; of per cent from -100 to 100 over R rad: \
                                unit = \"ticks\", ticks_per_turn = 200 * 2 pi / R";
/// Why a value of a format that defines its units has them.
pub const FORMAT_UNIT: &str = "the format defines it";
/// Why a joint state is in SI.
pub const ROS_UNIT: &str = "joint states are in rad, rad/s and N m by definition";

/// What an element's name ends in, what it measures and what it commands; nothing that a model
/// needs of temperatures and the like.
const SUFFIXES: [(&str, Option<(Role, Role)>); 10] = [
    ("pos", Some((Role::Position, Role::GoalPosition))),
    ("position", Some((Role::Position, Role::GoalPosition))),
    ("vel", Some((Role::Velocity, Role::GoalVelocity))),
    ("velocity", Some((Role::Velocity, Role::GoalVelocity))),
    ("torque", Some((Role::Effort, Role::Torque))),
    ("effort", Some((Role::Effort, Role::Torque))),
    ("load", None),
    ("current", None),
    ("temp", None),
    ("temperature", None),
];

/// Whether these are the columns of a data set of LeRobot.
pub fn is_lerobot<'a>(mut names: impl Iterator<Item = &'a str>) -> bool {
    names.any(|name| element_of(name, STATE).is_some())
}

/// The roles that LeRobot gives its columns.
pub fn give_lerobot_roles(log: &RawLog, guesses: &mut [NameGuess]) {
    for (name, guess) in log.names.iter().zip(guesses) {
        let called = log.dataset.as_ref().and_then(|facts| facts.name_of(name));
        let list = LISTS
            .iter()
            .find_map(|list| Some((*list, element_of(name, list)?)));
        let given = match (list, called) {
            _ if name == EPISODE => Some((Some(Role::Segment), String::new())),
            (None, _) => None,
            (Some((list, number)), None) => Some((Some(role_of(list)), number)),
            (Some((list, _)), Some(called)) => Some(named(list, called)),
        };
        if let Some((role, joint)) = given {
            (guess.role, guess.joint, guess.unit) = (role, joint, None);
        }
    }
}

/// The joint that an element's name means: without what says the quantity.
pub fn joint_of(called: &str) -> &str {
    let cut = called.rsplit_once('.');
    let is_suffix = |(_, suffix): &(&str, &str)| SUFFIXES.iter().any(|(own, _)| own == suffix);
    cut.filter(is_suffix).map_or(called, |(joint, _)| joint)
}

/// Role and joint of an element that has a name.
fn named(list: &str, called: &str) -> (Option<Role>, String) {
    let suffix = called.rsplit_once('.').map(|(_, suffix)| suffix);
    let mut known = SUFFIXES.iter();
    let roles = known
        .find(|(own, _)| Some(*own) == suffix)
        .map(|(_, roles)| *roles);
    let of_action = |(measured, commanded)| match list {
        ACTION => commanded,
        _ => measured,
    };
    let role = match roles {
        Some(roles) if [STATE, ACTION].contains(&list) => roles.map(of_action),
        _ => Some(role_of(list)),
    };
    (role, joint_of(called).to_string())
}

fn role_of(list: &str) -> Role {
    match list {
        ACTION => Role::GoalPosition,
        "observation.velocity" => Role::Velocity,
        "observation.effort" => Role::Effort,
        _ => Role::Position,
    }
}
