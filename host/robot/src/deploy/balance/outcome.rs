//! How balancing ended.

use crate::link::{account_words, condition_words};
use handstand_shared::message::{Condition, Telemetry};

/// Why balancing ended.
#[derive(Debug, Clone, PartialEq)]
pub enum BalanceEnd {
    /// Its time was over; let down softly.
    Finished,
    /// The user wanted it; let down softly.
    Interrupted,
    /// No attitude will ever come again; let down softly.
    AttitudeEnded,
    /// The CM-5 let the robot down for its safety.
    Stopped(Condition),
}

/// How balancing ended, with the CM-5's account.
#[derive(Debug, Clone, PartialEq)]
pub struct BalanceOutcome {
    /// Why.
    pub end: BalanceEnd,
    /// How long torque was on, s.
    pub balanced_s: f64,
    /// The CM-5's account of itself; none if it could not be asked.
    pub account: Option<Telemetry>,
}

impl BalanceOutcome {
    /// Whether it was stopped for the robot's safety.
    pub fn is_safety_stop(&self) -> bool {
        matches!(self.end, BalanceEnd::Stopped(_) | BalanceEnd::AttitudeEnded)
    }

    /// Why it ended, in words.
    pub fn words(&self) -> String {
        let account = self.account.as_ref().map(account_words);
        let account = account.map_or(String::new(), |words| format!(": {words}"));
        match self.end {
            BalanceEnd::Finished => "let down, for its time is over".to_string(),
            BalanceEnd::Interrupted => "let down at Ctrl-C".to_string(),
            BalanceEnd::AttitudeEnded => {
                format!("let down, for no attitude comes any more{account}")
            }
            BalanceEnd::Stopped(condition) => format!("{}{account}", condition_words(condition)),
        }
    }

    /// The same as a word for programs.
    pub fn id(&self) -> &'static str {
        match self.end {
            BalanceEnd::Finished => "finished",
            BalanceEnd::Interrupted => "interrupted",
            BalanceEnd::AttitudeEnded => "attitude_ended",
            BalanceEnd::Stopped(_) => "stopped",
        }
    }
}
