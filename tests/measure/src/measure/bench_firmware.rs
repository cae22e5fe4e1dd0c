//! `cargo xtask bench-firmware`: the firmware's promises, measured, one row each.
//!
//! Runs the very ELF in simavr against simulated servos; without simavr or an ELF it measures the
//! same logic in process and says so. simavr lets a byte of 8N1 take 11 bits; the bench sets it to
//! 10, so no time here needs correcting.

mod ages;
mod frames;
mod laws;
mod loops;
mod safety;
mod servo_faults;
mod servos;
mod streams;

use super::page::Page;
use comfy_table::{Table, presets::UTF8_HORIZONTAL_ONLY};
use handstand_measure::firmware::{Built, find_built};
use handstand_measure::measured::Measured;
use serde_json::{Value, json};

/// Measure the firmware: cycles, times, losses and frames.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// Only the rows whose name holds this
    #[arg(long)]
    only: Option<String>,
    /// Seconds of streaming
    #[arg(long, default_value_t = 60.0)]
    seconds: f64,
    /// Link losses and hangs
    #[arg(long, default_value_t = 1000)]
    losses: usize,
    /// States on which the two laws are compared
    #[arg(long, default_value_t = 1_000_000)]
    states: usize,
    /// Random steps under which the invariants are checked
    #[arg(long, default_value_t = 10_000_000)]
    steps: usize,
    /// Random bytes fed to the decoder
    #[arg(long, default_value_t = 1_000_000_000)]
    bytes: u64,
    /// Seed of all chance
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Small figures everywhere: a minute instead of many
    #[arg(long)]
    quick: bool,
    /// Print the rows as JSON
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    page: Page,
}

/// A promise, what was measured, and whether it holds.
struct Row {
    name: &'static str,
    measured: String,
    limit: &'static str,
    /// Nothing where nothing is promised.
    holds: Option<bool>,
    values: Value,
}

/// Whether every promise holds.
pub fn run(args: &Args) -> bool {
    let built = find_built();
    if let Err(why) = &built {
        eprintln!("{why}");
    }
    let built = built.ok();
    let on = match (&built, handstand_simavr::AVAILABLE) {
        (Some(_), true) => "the ELF in simavr",
        (None, true) => "the logic in process: `cargo xtask firmware` builds the ELF",
        (_, false) => "the logic in process: simavr is not installed (Debian: libsimavr-dev)",
    };
    eprintln!("Measured on {on}.");
    let mut rows = Vec::new();
    for (name, measure) in ROWS {
        if args
            .only
            .as_ref()
            .is_none_or(|part| name.contains(part.as_str()))
        {
            eprintln!("{name} ...");
            rows.extend(measure(args, built.as_ref()));
        }
    }
    let json = args.json.then(|| {
        let rows: Vec<_> = (rows.iter())
            .map(|row| json!({"row": row.name, "measured": row.measured, "limit": row.limit, "holds": row.holds, "values": row.values}))
            .collect();
        json!({"on": on, "rows": rows})
    });
    let measured = Measured::default()
        .table(table(&rows))
        .line(format!("Measured on {on}."));
    let written = args
        .page
        .show(json, &measured, "bench-firmware", "The firmware's promises");
    // A part, or small figures, would not be what the document promises.
    let is_whole = args.only.is_none() && !args.quick;
    let written = written && (!is_whole || args.page.insert(&measured, "firmware.md"));
    written && rows.iter().all(|row| row.holds != Some(false))
}

type Measure = fn(&Args, Option<&Built>) -> Vec<Row>;

const ROWS: &[(&str, Measure)] = &[
    ("stream", streams::streams),
    ("link loss", safety::losses),
    ("hang", safety::hangs),
    ("start", safety::starts),
    ("noise", safety::noises),
    ("restarts and rails", servo_faults::servo_faults),
    ("invariants", safety::invariants),
    ("law", laws::laws),
    ("age of readings", ages::readings),
    ("closed loop", loops::loops),
    ("servos", servos::servos),
    ("gyro alone", loops::gyros),
    ("balancing", loops::balancing),
    ("power cut", safety::cuts),
    ("frames", frames::frames),
];

#[cfg(simavr)]
const LONGEST_TICK: &str = "6 ms, 60 % of the period";
#[cfg(simavr)]
const _: () = assert!(handstand_measure::bench::LONGEST_TICK_US == 6000);

fn table(rows: &[Row]) -> Table {
    let mut table = Table::new();
    table
        .load_preset(UTF8_HORIZONTAL_ONLY)
        .set_header(["", "Measured", "Limit", "Holds"]);
    for row in rows {
        let holds = match row.holds {
            Some(true) => "yes",
            Some(false) => "NO",
            None => "-",
        };
        table.add_row([row.name, &row.measured, row.limit, holds]);
    }
    table
}

impl Args {
    fn reduced(&self, full: usize, quick: usize) -> usize {
        if self.quick { full.min(quick) } else { full }
    }
}
