//! Logs whose format says what their columns are: data sets of LeRobot, joint states of ROS.

use super::name::{NameGuess, Role};

/// A list of the angles that were measured, and one of the goals, in data sets of LeRobot.
const STATE: &str = "observation.state";
const ACTION: &str = "action";
const EPISODE: &str = "episode_index";

/// Why an angle of LeRobot's has the unit that was guessed.
pub const LEROBOT_UNIT: &str = "a guess from its range: LeRobot writes deg, rad or per cent of each \
                                joint's calibrated range; of per cent from -100 to 100 over R rad: \
                                unit = \"ticks\", ticks_per_turn = 200 * 2 pi / R";
/// Why a value of a format that defines its units has them.
pub const FORMAT_UNIT: &str = "the format defines it";
/// Why a joint state is in SI.
pub const ROS_UNIT: &str = "joint states are in rad, rad/s and N m by definition";

/// Whether these are the columns of a data set of LeRobot.
pub fn is_lerobot<'a>(mut names: impl Iterator<Item = &'a str>) -> bool {
    names.any(|name| name == STATE || number_of(name, STATE).is_some())
}

/// The roles that LeRobot gives its columns.
pub fn give_lerobot_roles<'a>(names: impl Iterator<Item = &'a str>, guesses: &mut [NameGuess]) {
    for (name, guess) in names.zip(guesses) {
        let given = match name {
            EPISODE => Some((Role::Segment, String::new())),
            STATE => Some((Role::Position, String::new())),
            ACTION => Some((Role::GoalPosition, String::new())),
            name => number_of(name, STATE)
                .map(|number| (Role::Position, number))
                .or_else(|| Some((Role::GoalPosition, number_of(name, ACTION)?))),
        };
        if let Some((role, joint)) = given {
            (guess.role, guess.joint, guess.unit) = (Some(role), joint, None);
        }
    }
}

/// The number behind a list's name: `action_3`.
fn number_of(name: &str, list: &str) -> Option<String> {
    let number = name.strip_prefix(list)?.strip_prefix('_')?;
    let is_number = !number.is_empty() && number.bytes().all(|byte| byte.is_ascii_digit());
    is_number.then(|| number.to_string())
}
