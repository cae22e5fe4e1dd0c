//! `cargo xtask discover`: how often a law that the library lacks is found as an expression, and
//! whether one is invented where nothing is missing.
//!
//! Arms whose logs another simulation writes, with a law that no effect of the library states; the
//! discovery has to leave at most 1.5 times what the true law leaves on the motion held out. Fails
//! where fewer than four of five laws are found, or one where there is none.

use super::page::Page;
use comfy_table::Table;
use handstand::challenge::unknown_laws;
use handstand::output::table::plain_table;
use handstand::study::Shard;
use handstand_measure::discover::{DiscoverCase, DiscoverOutcome, try_discover};
use handstand_measure::measured::Measured;
use serde_json::json;
use std::path::PathBuf;

/// Least share of the laws that are found.
const TARGET: f64 = 0.8;

/// Measure how often a law that the library lacks is discovered, and how often one is invented.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// Arms per law
    #[arg(long, default_value_t = 1)]
    seeds: u64,
    /// First seed
    #[arg(long, default_value_t = 1)]
    seed0: u64,
    /// Arms that lack nothing
    #[arg(long, default_value_t = 50)]
    nothing: u64,
    /// Laws to hide, comma-separated; all of them by default
    #[arg(long, value_delimiter = ',', value_name = "LAW")]
    laws: Vec<String>,
    /// Try only this share of the cases: `2/5` is the second of five
    #[arg(long, default_value = "1/1", value_name = "I/N")]
    shard: Shard,
    /// Keep the files of each arm in a folder of this one
    #[arg(long, value_name = "FOLDER")]
    rigs: Option<PathBuf>,
    /// Print every outcome as JSON
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    page: Page,
}

/// Whether the target is met.
pub fn run(args: &Args) -> bool {
    let mut outcomes = Vec::new();
    let mut failed = 0;
    let cases = cases(args).into_iter().enumerate();
    for (_, case) in cases.filter(|(k, _)| args.shard.holds(*k)) {
        match try_discover(case, args.rigs.as_deref()) {
            Ok(outcome) => {
                eprintln!("{}", line(&outcome));
                outcomes.push(outcome);
            }
            Err(why) => {
                eprintln!("{case:?}: {why}");
                failed += 1;
            }
        }
    }
    let [laws, nothing] = [true, false].map(|hides| {
        let of = outcomes.iter().filter(|o| o.law.is_some() == hides);
        of.collect::<Vec<&DiscoverOutcome>>()
    });
    let right = |of: &[&DiscoverOutcome]| of.iter().filter(|o| o.is_right()).count();
    let (found, silent) = (right(&laws), right(&nothing));
    let measured = Measured::default()
        .line(format!(
            "Of {} laws that the library lacks {found} are found: the discovered one leaves at \
             most 1.5 times what the true law leaves on the motion held out. In {} arms that lack \
             nothing {} laws are invented.",
            laws.len(),
            nothing.len(),
            nothing.len() - silent,
        ))
        .line(format!("Seconds per arm: {}.", times(&outcomes)))
        .table(table(&laws))
        .table(invented(&nothing));
    let json = args.json.then(|| json!(outcomes));
    let title = "Laws outside the library, discovered";
    let written = args.page.show(json, &measured, "discover", title);
    let enough = found as f64 >= TARGET * laws.len() as f64 && silent == nothing.len();
    written && failed == 0 && enough
}

fn cases(args: &Args) -> Vec<DiscoverCase> {
    let asked = |law: &&str| args.laws.is_empty() || args.laws.iter().any(|own| own == law);
    let seeds = args.seed0..args.seed0 + args.seeds;
    let hiding = unknown_laws().filter(asked).flat_map(|law| {
        let case = move |seed| DiscoverCase {
            law: Some(law),
            seed,
        };
        seeds.clone().map(case)
    });
    let nothing = args.seed0..args.seed0 + args.nothing;
    let nothing = nothing.map(|seed| DiscoverCase { law: None, seed });
    hiding.chain(nothing).collect()
}

fn mrad(rad: f64) -> String {
    format!("{:.3}", 1e3 * rad)
}

fn verdict(outcome: &DiscoverOutcome) -> String {
    json!(outcome.verdict)
        .as_str()
        .unwrap_or_default()
        .to_string()
}

fn line(outcome: &DiscoverOutcome) -> String {
    format!(
        "{} {}: {}, {} -> {} mrad, true {}, {:.1} s: {} | {}",
        outcome.law.as_deref().unwrap_or("nothing"),
        outcome.seed,
        if outcome.is_right() {
            "right"
        } else {
            "MISSED"
        },
        mrad(outcome.before_rad),
        mrad(outcome.after_rad),
        mrad(outcome.true_rad),
        outcome.seconds,
        verdict(outcome),
        outcome.found.join(" and "),
    )
}

fn times(outcomes: &[DiscoverOutcome]) -> String {
    let mut seconds: Vec<f64> = outcomes.iter().map(|o| o.seconds).collect();
    seconds.sort_by(f64::total_cmp);
    let at = |share: f64| {
        let place = (share * seconds.len() as f64) as usize;
        seconds
            .get(place.min(seconds.len().saturating_sub(1)))
            .copied()
            .unwrap_or(f64::NAN)
    };
    format!("median {:.1}, 90 % within {:.1}", at(0.5), at(0.9))
}

fn table(outcomes: &[&DiscoverOutcome]) -> Table {
    let header = [
        "law", "seed", "hidden", "verdict", "found", "before", "after", "true", "",
    ];
    let mut table = plain_table(header);
    for outcome in outcomes {
        table.add_row([
            outcome.law.clone().unwrap_or_default(),
            outcome.seed.to_string(),
            outcome.hidden.clone(),
            verdict(outcome),
            outcome.found.join("; "),
            mrad(outcome.before_rad),
            mrad(outcome.after_rad),
            mrad(outcome.true_rad),
            if outcome.is_right() { "" } else { "missed" }.to_string(),
        ]);
    }
    table
}

/// Laws that were found where none is missing.
fn invented(outcomes: &[&DiscoverOutcome]) -> Table {
    let mut table = plain_table([
        "nothing missing, seed",
        "verdict",
        "found",
        "before",
        "after",
    ]);
    for outcome in outcomes.iter().filter(|outcome| !outcome.is_right()) {
        table.add_row([
            outcome.seed.to_string(),
            verdict(outcome),
            outcome.found.join("; "),
            mrad(outcome.before_rad),
            mrad(outcome.after_rad),
        ]);
    }
    table
}
