//! What a terminal shows while the robot is balanced, and the summary.

use crate::cli::show::{or_dash, table};
use crate::cli::{Console, ExitStatus};
use handstand::Result;
use handstand::deploy::balance::{BalanceOutcome, BalanceStatus, WheelChange};
use handstand::link::condition_words;
use handstand_shared::dynamixel::ErrorBits;
use handstand_shared::raw::Supply;
use serde_json::json;
use std::path::Path;

/// The live table.
pub fn live_table(status: &BalanceStatus) -> String {
    let degrees = |rad: Option<f64>| or_dash(rad, |rad| format!("{:.1} deg", rad.to_degrees()));
    let mut joints = table(["", "Angle", "Output or rate"]);
    let lean = degrees(status.lean_rad);
    let rate = or_dash(status.rate_rad_s, |rate| {
        format!("{:.1} deg/s", rate.to_degrees())
    });
    joints.add_row(["first link", &lean, &rate]);
    for (name, joint) in [("shoulder", 0), ("hip", 1)] {
        let output = or_dash(status.output[joint], |share| {
            format!("{:.0} %", 100.0 * share)
        });
        joints.add_row([name, &degrees(status.joint_rad[joint]), &output]);
    }
    format!(
        "{}, {:.1} s\n{joints}\nsupply {}, hottest servo {}, reports every {:.0} ms (longest {:.0})",
        condition_words(status.condition),
        status.balanced_s,
        or_dash(status.supply_v(), |supply| format!("{supply:.1} V")),
        or_dash(status.hottest_celsius(), |heat| format!("{heat:.0} C")),
        1e3 * status.report_s,
        1e3 * status.longest_report_s,
    )
}

/// What was done, for the summary.
#[derive(Default)]
pub struct BalanceReport {
    /// Of the plan.
    pub fingerprint: u32,
    /// Whether the CM-5 did not have it.
    pub uploaded: bool,
    /// Registers set in servos.
    pub changes: Vec<WheelChange>,
    /// Samples recorded.
    pub samples: u64,
}

impl BalanceReport {
    /// Prints it; the exit status.
    ///
    /// # Errors
    /// Standard output is closed.
    pub fn print(
        &self,
        outcome: &BalanceOutcome,
        status: &BalanceStatus,
        record: Option<&Path>,
        console: &Console,
    ) -> Result<ExitStatus> {
        let account = outcome.account.as_ref();
        let tripped = account.and_then(|account| account.tripped);
        let data = json!({
            "ended": outcome.id(),
            "cause": outcome.is_safety_stop().then(|| outcome.words()),
            "balanced_s": outcome.balanced_s,
            "lean_rms_rad": status.lean_rms_rad(),
            "fingerprint": format!("{:08X}", self.fingerprint),
            "uploaded": self.uploaded,
            "changes": self.changes,
            "longest_report_s": status.longest_report_s,
            "longest_attitude_s": status.lean_rad.map(|_| status.longest_attitude_s),
            "longest_silence_ms": account.map(|account| account.longest_silence_ms),
            "tripped": tripped.map(|tripped| json!({
                "id": tripped.id,
                "error_flags": ErrorBits(tripped.error).names().collect::<Vec<_>>(),
            })),
            "supply_v": account.map(|account| Supply(account.supply).to_v()),
            "samples": record.map(|_| self.samples),
            "record": record.map(|file| file.display().to_string()),
        });
        let rms = or_dash(status.lean_rms_rad(), |rad| {
            format!(", {:.1} mrad rms from upright", 1e3 * rad)
        });
        let rms = if status.lean_rad.is_some() {
            rms
        } else {
            String::new()
        };
        let text = format!(
            "balanced for {:.1} s{rms}; {}",
            outcome.balanced_s,
            outcome.words()
        );
        console.result(&data, || text)?;
        if outcome.is_safety_stop() {
            Ok(ExitStatus::Stopped)
        } else {
            Ok(ExitStatus::Done)
        }
    }
}
