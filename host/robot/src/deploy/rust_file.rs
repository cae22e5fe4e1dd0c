//! A plan as a Rust file that the firmware compiles in.

use crate::error::{Error, Place, Result};
use handstand_shared::plan::Plan;
use std::fmt::Write as _;
use std::path::Path;

/// `plan.rs`: the plan's bytes as `PLAN`, with what it is and the command that makes it again.
pub fn plan_file(plan: &Plan, made_by: &str) -> String {
    let mut bytes = Vec::new();
    plan.bytes(|byte| bytes.push(byte));
    let mut text = String::new();
    let _ = write!(
        text,
        "// Made by `{made_by}`; do not edit.\n\
         // Fingerprint {:08X}: CRC-32 of these bytes.\n\
         [\n",
        plan.fingerprint()
    );
    for line in bytes.chunks(16) {
        let line: Vec<String> = line.iter().map(|byte| format!("0x{byte:02x}")).collect();
        let _ = writeln!(text, "    {},", line.join(", "));
    }
    text.push_str("]\n");
    text
}

/// The plan in a file that [`plan_file`] made; `path` names it in errors.
///
/// # Errors
/// Text without a plan, or a plan that this version's firmware refuses.
pub fn plan_of_file(text: &str, path: &Path) -> Result<Plan> {
    let refused = |line, what: &str| {
        Error::data(
            Place::at(path, line, 1),
            what,
            "make it again: handstand gains deploy MODEL.toml --dry-run --header plan.rs",
        )
    };
    let mut bytes = Vec::new();
    let code = text
        .lines()
        .zip(1..)
        .filter(|(line, _)| !line.starts_with("//"));
    for (line, number) in code {
        let words = line
            .split([',', ' ', '[', ']'])
            .filter(|word| !word.is_empty());
        for word in words {
            let byte = word
                .strip_prefix("0x")
                .map(|digits| u8::from_str_radix(digits, 16));
            match byte {
                Some(Ok(byte)) => bytes.push(byte),
                _ => return Err(refused(number, &format!("`{word}` is no byte of a plan"))),
            }
        }
    }
    Plan::from_bytes(&bytes).ok_or_else(|| {
        let what = format!("these {} bytes are no plan of this version", bytes.len());
        refused(1, &what)
    })
}
