//! Why a text describes no simulated bus.

use handstand_shared::dynamixel::ID_LIST_SYNTAX;

/// Text that describes no simulated bus.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum SpecError {
    /// A key that does not exist.
    #[error("`{0}` is no key of a simulated bus; there are: {KEYS}")]
    UnknownKey(String),
    /// A list of ids that names none.
    #[error("`{0}` names no ids: {ID_LIST_SYNTAX}")]
    Ids(String),
    /// A value outside its range.
    #[error("{key}={value}: give {expected}")]
    Value {
        /// The key.
        key: String,
        /// The value found.
        value: String,
        /// What the key takes.
        expected: String,
    },
    /// Keys of a servo of Protocol 2.0 without its model.
    #[error(
        "firmware, mode, turns and turnaround are of a servo of Protocol 2.0: name its model \
         before them, model=XL330-M288"
    )]
    NoServoModel,
    /// A robot on servos of Protocol 2.0.
    #[error("a robot hangs on simulated AX-12 servos only: leave model out")]
    RobotOnX,
    /// Keys of a robot without its model.
    #[error("joints, start, lean, lag and gyro are a robot's: name its model, robot=MODEL.toml")]
    NoModel,
}

const KEYS: &str = "ids, delay, level, baud, drop, flip, late, wrong_id, corrupt_request, echo, \
                    dead, hot, warms, overload, jam, supply, model, firmware, mode, turns, \
                    turnaround, robot, joints, start, lean, lag, gyro, seed";

impl SpecError {
    pub(super) fn value(key: &str, value: &str, expected: &str) -> Self {
        SpecError::Value {
            key: key.into(),
            value: value.into(),
            expected: expected.into(),
        }
    }
}
