//! Registers that get another content, and showing them.

use crate::cli::{Console, ExitStatus, show::table_of};
use handstand::Result;
use handstand::report::table::columns_of;
use handstand_shared::control_table::Item;
use serde::{Serialize, Serializer};
use serde_json::Value;

/// A register of a servo that gets another code.
#[derive(Serialize)]
pub struct RegisterChange {
    /// The servo.
    pub id: u8,
    /// The register.
    #[serde(serialize_with = "name")]
    pub register: Item,
    /// What was in it.
    pub before: i32,
    /// What comes in.
    pub code: i32,
}

fn name<S: Serializer>(register: &Item, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.serialize_str(register.name)
}

/// `data` for programs; for people a table, if there are any changes, and what was done. `after`
/// heads what comes in.
///
/// # Errors
/// Standard output is closed.
pub fn report(
    data: &Value,
    changes: &[RegisterChange],
    after: &str,
    done: &str,
    console: &Console,
) -> Result<ExitStatus> {
    if console.json {
        console.data(data)?;
        return Ok(ExitStatus::Done);
    }
    let columns = columns_of::<RegisterChange>()
        .text("Id", |change| change.id.to_string())
        .text("Register", |change| change.register.name.to_string())
        .text("Before", |change| change.before.to_string())
        .text(after, |change| change.code.to_string());
    let table = table_of(changes, &columns);
    if !changes.is_empty() {
        console.print(&table.to_string())?;
    }
    console.say(done);
    Ok(ExitStatus::Done)
}
