//! A plan as a Rust file that the firmware compiles in.

use handstand_shared::plan::Plan;
use std::fmt::Write as _;

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
