//! `cargo xtask hidden`: how often a hidden effect is named, missed, or invented, against targets.
//!
//! Every effect of the challenges on several benches, benches that hide nothing, and every effect
//! again with a library that lacks it. Training on two motions of 20 s, held out a third. The same
//! arguments give the same tables on any number of threads. A line goes to stderr as each diagnosis
//! ends, whichever ends first; the tables go to stdout. Fails when a target is missed.

use super::page::Page;
use clap::builder::PossibleValuesParser;
use handstand::challenge::{KINDS, kind_named};
use handstand_tests::hidden::{Plan, Tally, line, misses, tables, try_all};
use indicatif::{ProgressBar, ProgressStyle};
use serde_json::json;

/// Measure how often hidden effects are named, missed and invented.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// Benches per effect
    #[arg(long, default_value_t = 5)]
    seeds: u64,
    /// Benches that hide nothing
    #[arg(long, default_value_t = 50)]
    nominal: u64,
    /// First seed
    #[arg(long, default_value_t = 1)]
    seed0: u64,
    /// Hide only these
    #[arg(long, value_delimiter = ',', value_parser = PossibleValuesParser::new(KINDS))]
    effects: Vec<String>,
    /// Skip the run whose library lacks the hidden effect
    #[arg(long)]
    no_leave_out: bool,
    /// Only the run whose library lacks the hidden effect
    #[arg(long, conflicts_with = "no_leave_out")]
    leave_out: bool,
    /// Diagnoses at a time; one per core without it
    #[arg(long)]
    jobs: Option<usize>,
    /// Print every outcome and the figures as JSON
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    page: Page,
}

/// Whether every target is met.
pub fn run(args: &Args) -> bool {
    let mut plan = Plan {
        seeds: args.seeds,
        nominal: args.nominal,
        seed0: args.seed0,
        leave_out: !args.no_leave_out,
        ..Plan::default()
    };
    if !args.effects.is_empty() {
        let named = args.effects.iter().filter_map(|name| kind_named(name));
        plan.effects = named.collect();
    }
    let mut cases = plan.cases();
    cases.retain(|case| case.left_out || !args.leave_out);
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    let bar = ProgressBar::new(cases.len() as u64).with_style(style());
    let found = try_all(&cases, args.jobs.unwrap_or(threads), threads, &|outcome| {
        bar.suspend(|| eprintln!("{}", line(outcome)));
        bar.inc(1);
    });
    bar.finish_and_clear();
    let outcomes = match found {
        Ok(outcomes) => outcomes,
        Err(error) => {
            println!("{error}");
            return false;
        }
    };
    let tally = Tally::of(&outcomes);
    let json = (args.json).then(|| json!({ "tally": tally, "outcomes": outcomes }));
    let measured = tables(&tally).lines(misses(&outcomes));
    let written = args.page.show(
        json,
        &measured,
        "hidden",
        "Hidden effects named, missed and invented",
    );
    tally.is_met() && written
}

fn style() -> ProgressStyle {
    ProgressStyle::with_template("{bar:30} {pos} of {len}, {eta} left")
        .unwrap_or_else(|_| ProgressStyle::default_bar())
}
