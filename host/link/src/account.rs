//! The CM-5's account of why it let a robot down.

use handstand_shared::dynamixel::ErrorBits;
use handstand_shared::message::{Condition, Telemetry};
use handstand_shared::raw::Supply;

/// Whether the CM-5 lets the robot down, or has.
pub fn is_let_down(condition: Condition) -> bool {
    matches!(condition, Condition::Soft | Condition::Fault(_))
}

/// What may have been the cause, in words: silence of the line, a servo, the supply.
pub fn account_words(account: &Telemetry) -> String {
    let servo = account.tripped.map_or(String::new(), |tripped| {
        let names: Vec<&str> = ErrorBits(tripped.error).names().collect();
        if names.is_empty() {
            format!(", servo {} lost its torque", tripped.id)
        } else {
            format!(", servo {} reports {}", tripped.id, names.join(" and "))
        }
    });
    format!(
        "the line was silent for {} ms at most{servo}, supply {:.1} V",
        account.longest_silence_ms,
        Supply(account.supply).to_v()
    )
}
