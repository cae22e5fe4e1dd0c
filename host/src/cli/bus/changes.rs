//! Registers that get another content, and showing them.

use super::super::show::table;
use super::super::talk::Talk;
use handstand::Result;
use handstand_shared::control_table::Register;
use serde_json::{Value, json};

/// A register of a servo that gets another code.
pub struct RegisterChange {
    /// The servo.
    pub id: u8,
    /// The register.
    pub register: Register,
    /// What was in it.
    pub before: u16,
    /// What comes in.
    pub code: u16,
}

/// Under their keys.
pub fn data(changes: &[RegisterChange]) -> Vec<Value> {
    let change = |c: &RegisterChange| json!({ "id": c.id, "register": c.register.name, "before": c.before, "code": c.code });
    changes.iter().map(change).collect()
}

/// As a table, if there are any; `after` heads what comes in.
///
/// # Errors
/// Standard output is closed.
pub fn print(changes: &[RegisterChange], after: &str, talk: &Talk) -> Result<()> {
    if changes.is_empty() {
        return Ok(());
    }
    let mut shown = table(["Id", "Register", "Before", after]);
    for change in changes {
        shown.add_row([
            change.id.to_string(),
            change.register.name.to_string(),
            change.before.to_string(),
            change.code.to_string(),
        ]);
    }
    talk.print(&shown.to_string())
}
