//! The CM-5's fault log: why torque went off, the newest first.

use super::port::SerialLink;
use super::session::Session;
use super::session_error::{SessionError, condition_words};
use handstand_shared::message::{Cause, Command, Condition, FaultEntry, Refusal, Report};

/// All entries, the newest first; torn ones are left out by the CM-5, and what is older with them.
///
/// # Errors
/// Torque is on, or the CM-5 does not answer.
pub fn fault_log<L: SerialLink>(session: &mut Session<L>) -> Result<Vec<FaultEntry>, SessionError> {
    let condition = session.hello.condition;
    let armed = [
        Condition::StreamArmed,
        Condition::BalanceArmed,
        Condition::Soft,
    ];
    if armed.contains(&condition) {
        return Err(SessionError::Refused {
            action: "tell its fault log".into(),
            refusal: Refusal::Armed,
        });
    }
    let mut entries = Vec::new();
    for back in 0..=u8::MAX {
        let entry = session.fetch(&Command::FaultRead { back }, |report| match report {
            Report::Fault { back: told, entry } if *told == back => Some(*entry),
            _ => None,
        })?;
        match entry {
            Some(entry) => entries.push(entry),
            None => break,
        }
    }
    Ok(entries)
}

/// Why torque went off, in words.
pub fn cause_words(cause: Cause) -> &'static str {
    let words = condition_words(Condition::Fault(cause));
    words.strip_prefix("stopped: ").unwrap_or(words)
}
