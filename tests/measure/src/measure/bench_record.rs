//! `cargo xtask bench-record`: recorders killed a thousand times; no file may be lost, nor more
//! than a second of any.

use super::page::Page;
use super::program::built;
use comfy_table::{Table, presets::UTF8_HORIZONTAL_ONLY};
use handstand_measure::kills::{Tally, kill_recorders};
use handstand_measure::measured::Measured;

/// Kill recorders, and read what is left
#[derive(Debug, clap::Args)]
pub struct Args {
    /// How many
    #[arg(long, default_value_t = 1000)]
    kills: usize,
    /// How many run at once
    #[arg(long, default_value_t = 8, value_parser = clap::value_parser!(u64).range(1..=64))]
    at_once: u64,
    /// Seed of the moments
    #[arg(long, default_value_t = 1)]
    seed: u64,
    #[command(flatten)]
    page: Page,
}

/// Most that a killed recorder may lose, s.
const LIMIT_S: f64 = 1.0;

/// Whether every file was read and lost a second at most.
pub fn run(args: &Args) -> bool {
    let Some(program) = built() else {
        eprintln!("handstand could not be built");
        return false;
    };
    let told = |done: usize| {
        if done.is_multiple_of(50) {
            eprintln!("{done} of {}", args.kills);
        }
    };
    match kill_recorders(&program, args.kills, args.at_once as usize, args.seed, told) {
        Ok(tally) => {
            let title = "Recorders killed at random moments";
            let written = args.page.show(None, &tables(&tally), "bench-record", title);
            written && tally.unreadable.is_empty() && tally.worst_lost_s <= LIMIT_S
        }
        Err(why) => {
            eprintln!("{why}");
            false
        }
    }
}

fn tables(tally: &Tally) -> Measured {
    let mut table = Table::new();
    table.load_preset(UTF8_HORIZONTAL_ONLY);
    table.set_header(["", "Measured", "Limit"]);
    let rows = [
        ("recorders killed", tally.kills.to_string(), "-".into()),
        (
            "files that cannot be read",
            tally.unreadable.len().to_string(),
            "0".into(),
        ),
        (
            "files without an end, read up to it",
            tally.torn.to_string(),
            "-".into(),
        ),
        (
            "most that one file lost, s",
            format!("{:.3}", tally.worst_lost_s),
            LIMIT_S.to_string(),
        ),
        ("samples read", tally.samples.to_string(), "-".into()),
    ];
    for (name, measured, limit) in rows {
        table.add_row([name.to_string(), measured, limit]);
    }
    Measured::default()
        .table(table)
        .lines(tally.unreadable.iter().cloned())
}
