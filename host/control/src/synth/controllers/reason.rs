//! Why a controller cannot be designed: data, sentence, remedy.

use crate::error::{Error, Reason};
use handstand_shared::observer::DELAYS;
use std::borrow::Cow;

/// What stands in the way of a controller whose plant itself can be stabilised.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum ControllerReason {
    /// The filter's innovation has no positive definite covariance.
    #[error("the readings do not tell the state")]
    Unobserved,
    /// B'PB is singular.
    #[error("the inputs do not reach the sliding surface")]
    SlidingSurface,
    /// A robot of another size than the CM-5 balances.
    #[error("{joints} joints, {drives} of them driven")]
    BoardSize {
        /// Joints of the robot.
        joints: usize,
        /// How many of them are driven.
        drives: usize,
    },
    /// Inputs or readings older than the CM-5 keeps inputs.
    #[error("inputs or readings {:.1} ms late", 1e3 * delay_s)]
    TooLate {
        /// How late, s.
        delay_s: f64,
    },
    /// A plan whose pose is not upright, or whose inputs there are not 0.
    #[error("the plan does not hold the robot upright without torque")]
    NotUpright,
    /// A plan for another sampling time.
    #[error("the plan is for {}, not for every {period_s} s", sampled(*ts_s))]
    OtherPeriod {
        /// Its sampling time, s; none of continuous time.
        ts_s: Option<f64>,
        /// The study's, s.
        period_s: f64,
    },
    /// A plan for a drive that is not commanded in torque.
    #[error("joint {joint} is commanded neither in torque nor in duty")]
    NoTorque {
        /// From 1.
        joint: usize,
    },
    /// A plan for another robot.
    #[error("the plan is not for {joints} joints, {drives} of them driven")]
    OtherRobot {
        /// Joints of the robot.
        joints: usize,
        /// How many of them are driven.
        drives: usize,
    },
    /// The plant's state cannot be computed backwards in time.
    #[error("the plant cannot be followed back")]
    Irreversible,
}

impl Reason for ControllerReason {
    fn remedy(&self) -> Cow<'_, str> {
        Cow::Borrowed(match self {
            ControllerReason::Unobserved => "read finer, or sample faster",
            ControllerReason::SlidingSurface => "drive other joints",
            ControllerReason::BoardSize { .. } => {
                "the CM-5 balances three joints of which two are driven"
            }
            ControllerReason::TooLate { .. } => {
                return format!(
                    "the CM-5 keeps the inputs of {DELAYS} periods: shorten the delay, or sample \
                     more slowly"
                )
                .into();
            }
            ControllerReason::NotUpright => {
                "studies hold robots upright: design without --pose, or ask `handstand gains` for \
                 the verdict"
            }
            ControllerReason::OtherPeriod { .. } => {
                "give the sampling time of the plan, or design for this one"
            }
            ControllerReason::NoTorque { .. } => {
                "studies command torques; ask `handstand gains` for the verdict on this plan"
            }
            ControllerReason::OtherRobot { .. } => "give the plan that was made for this robot",
            ControllerReason::Irreversible => "sample faster",
        })
    }
}

impl From<ControllerReason> for Error {
    fn from(reason: ControllerReason) -> Error {
        Error::Design(Box::new(reason))
    }
}

/// A sampling time in words.
fn sampled(ts_s: Option<f64>) -> String {
    ts_s.map_or("continuous time".into(), |ts_s| format!("every {ts_s} s"))
}
