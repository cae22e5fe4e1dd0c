//! `bus log`: the CM-5's fault log, the newest entry first. The firmware keeps the last 16 without
//! power: why torque went off, in which of its starts, how long after it, and what it was doing.
//!
//! A restart by the watchdog loses time and state; its entry says when the firmware came back. The
//! log is not read while torque is on.

use crate::cli::port::Port;
use crate::cli::show::table_of;
use crate::cli::{Console, ExitStatus};
use handstand::Result;
use handstand::link::{Session, cause_words, condition_words, fault_log};
use handstand::report::table::columns_of;
use handstand_shared::message::FaultEntry;
use serde::Serialize;

/// Read the CM-5's fault log.
#[derive(Debug, clap::Args)]
pub struct FaultLogArgs {
    #[command(flatten)]
    port: Port,
}

/// An entry of the fault log.
#[derive(Debug, Serialize)]
struct LoggedFault {
    /// Number of the start, modulo 256.
    start: u8,
    tick: u32,
    /// Since that start, s.
    time_s: f64,
    cause: &'static str,
    condition: &'static str,
}

impl From<FaultEntry> for LoggedFault {
    fn from(entry: FaultEntry) -> Self {
        LoggedFault {
            start: entry.start,
            tick: entry.tick,
            time_s: f64::from(entry.tick) * 0.01,
            cause: cause_words(entry.cause),
            condition: condition_words(entry.condition),
        }
    }
}

/// Asks, shows.
pub fn run(args: &FaultLogArgs, console: &Console) -> Result<ExitStatus> {
    let mut session = Session::open(args.port.open()?)?;
    let entries = fault_log(&mut session)?;
    let faults: Vec<LoggedFault> = entries.into_iter().map(LoggedFault::from).collect();
    console.result(&faults, || text(&faults))?;
    Ok(ExitStatus::Done)
}

fn text(faults: &[LoggedFault]) -> String {
    let columns = columns_of::<LoggedFault>()
        .text("Start", |fault| fault.start.to_string())
        .text("After", |fault| format!("{:.2} s", fault.time_s))
        .text("Torque went off, for", |fault| fault.cause.to_string())
        .text("It was", |fault| fault.condition.to_string());
    if faults.is_empty() {
        "No fault is kept.".to_string()
    } else {
        table_of(faults, &columns).to_string()
    }
}
