//! `cargo xtask within`: is the answer of a limited time the answer of the whole search, and in
//! time?
//!
//! Bench arms whose law is outside the library, each diagnosed within the limit and then as long as
//! it takes, one after the other, each on all threads. Fails when fewer than eight in ten verdicts
//! agree, or an answer comes more than two seconds late.

use super::journal;
use super::page::Page;
use comfy_table::Table;
use handstand::challenge::KINDS;
use handstand::study::Shard;
use handstand_measure::hidden::{Case, Family, Truth, Within, try_within};
use handstand_measure::measured::Measured;
use serde_json::json;
use std::path::PathBuf;

/// Share of the verdicts that must agree.
const TARGET: f64 = 0.8;
/// Seconds that an answer may be late.
const LATE_S: f64 = 2.0;

/// Measure whether a limited time gives the verdict of the whole search, in time.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// The limit, s
    #[arg(long, default_value_t = 60.0)]
    limit: f64,
    /// Arms, each with another effect that its library lacks
    #[arg(long, default_value_t = 10)]
    arms: usize,
    /// Seed of the arms, from 1
    #[arg(long, default_value_t = 1, value_parser = clap::value_parser!(u64).range(1..))]
    seed: u64,
    /// Try only this share of the arms: `2/5` is the second of five
    #[arg(long, default_value = "1/1", value_name = "I/N")]
    shard: Shard,
    /// Append every outcome to this file of JSON lines, and leave out what it holds
    #[arg(long, value_name = "FILE")]
    outcomes: Option<PathBuf>,
    /// Print every outcome as JSON
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    page: Page,
}

/// Whether the targets are met.
pub fn run(args: &Args) -> bool {
    match tried(args) {
        Ok(met) => met,
        Err(why) => {
            eprintln!("{why}");
            false
        }
    }
}

/// Arms that hide effects evenly spread over all kinds.
fn cases(args: &Args) -> Vec<Case> {
    let count = args.arms.clamp(1, KINDS.len());
    let kinds = (0..count).map(|k| KINDS[k * KINDS.len() / count]);
    let case = |kind| Case {
        truth: Truth::Own,
        family: Family::Outside,
        hidden: vec![kind],
        seed: args.seed,
        skipped: Vec::new(),
    };
    kinds.map(case).collect()
}

fn tried(args: &Args) -> Result<bool, String> {
    let mut all = args
        .outcomes
        .as_deref()
        .map_or(Ok(Vec::new()), journal::read)?;
    let is_of = |outcome: &Within, case: &Case| {
        let same = outcome.hidden == case.hidden && outcome.seed == case.seed;
        same && outcome.limit_s == args.limit
    };
    let cases: Vec<Case> = cases(args);
    all.retain(|outcome| cases.iter().any(|case| is_of(outcome, case)));
    let own = cases
        .iter()
        .enumerate()
        .filter(|(k, _)| args.shard.holds(*k));
    let mut failed = 0;
    for (_, case) in own {
        if all.iter().any(|outcome| is_of(outcome, case)) {
            continue;
        }
        match try_within(case, args.limit) {
            Ok(outcome) => {
                eprintln!("{}", line(&outcome));
                if let Some(path) = &args.outcomes {
                    journal::append(path, &outcome)?;
                }
                all.push(outcome);
            }
            Err(why) => {
                eprintln!("{}: {why}", case.hidden.join(" + "));
                failed += 1;
            }
        }
    }
    let agree = all.iter().filter(|outcome| outcome.agrees()).count();
    let latest_s = all.iter().map(Within::late_s).fold(f64::MIN, f64::max);
    let cut = all.iter().filter(|outcome| outcome.limited.ended == "time");
    let measured = Measured::default().table(table(&all)).line(format!(
        "{agree} of {} verdicts agree (target {:.0} %); {} searches were ended by the limit of {} s. \
         The latest answer came at {:+.1} s of the limit (target at most {LATE_S:+.0} s).",
        all.len(),
        100.0 * TARGET,
        cut.count(),
        args.limit,
        latest_s
    ));
    let json = args.json.then(|| json!(all));
    let title = "Diagnoses of a limited time: arms whose law is outside the library";
    let written = args.page.show(json, &measured, "within", title);
    let met = agree as f64 >= TARGET * all.len() as f64 && latest_s <= LATE_S;
    Ok(met && failed == 0 && written)
}

fn line(outcome: &Within) -> String {
    let answer = |timed: &handstand_measure::hidden::Timed| {
        let (verdict, set) = (&timed.verdict, timed.set.join(" + "));
        format!("{verdict} ({set}) in {:.1} s", timed.seconds)
    };
    format!(
        "{}: {}; whole search {}",
        outcome.hidden.join(" + "),
        answer(&outcome.limited),
        answer(&outcome.whole)
    )
}

fn table(outcomes: &[Within]) -> Table {
    let mut table = Table::new();
    table.set_header([
        "outside the library",
        "within the limit",
        "best explanation",
        "left, mrad",
        "s",
        "whole search",
        "best explanation",
        "left, mrad",
        "s",
    ]);
    for outcome in outcomes {
        let cells = |timed: &handstand_measure::hidden::Timed| {
            [
                timed.verdict.clone(),
                timed.set.join(" + "),
                format!("{:.2}", 1e3 * timed.after_rad),
                format!("{:.1}", timed.seconds),
            ]
        };
        let hidden = [outcome.hidden.join(" + ")].into_iter();
        table.add_row(
            hidden
                .chain(cells(&outcome.limited))
                .chain(cells(&outcome.whole)),
        );
    }
    table
}
