//! `cargo xtask next`: how often one proposed experiment settles an ambiguous diagnosis.
//!
//! Bench arms that hide one effect, of which their owner has one bare log. Those whose diagnosis is
//! ambiguous get the experiment that `handstand next` proposes, played by the bench's own
//! equations. Where the explanations are one law of that arm, and `next` says so, no experiment
//! could settle it, and it does not count. Fails when fewer than nine in ten are settled, or a case
//! cannot be made.

use super::page::Page;
use clap::builder::PossibleValuesParser;
use comfy_table::Table;
use handstand::challenge::KINDS;
use handstand::study::Shard;
use handstand_measure::experiment::{ExperimentCase, ExperimentOutcome, Settled, try_experiments};
use handstand_measure::measured::Measured;
use serde_json::json;

/// Share of the ambiguous cases that one experiment must settle.
const TARGET: f64 = 0.9;

/// Measure how often one proposed experiment settles an ambiguous diagnosis.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// Arms per effect
    #[arg(long, default_value_t = 3)]
    seeds: u64,
    /// First seed, from 1
    #[arg(long, default_value_t = 1, value_parser = clap::value_parser!(u64).range(1..))]
    seed0: u64,
    /// Hide only these
    #[arg(long, value_delimiter = ',', value_parser = PossibleValuesParser::new(KINDS))]
    effects: Vec<String>,
    /// Try only this share of the cases: `2/5` is the second of five
    #[arg(long, default_value = "1/1", value_name = "I/N")]
    shard: Shard,
    /// Print every outcome as JSON
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    page: Page,
}

/// Whether the target is met.
pub fn run(args: &Args) -> bool {
    let is_wanted = |kind: &&str| args.effects.is_empty() || args.effects.iter().any(|e| e == kind);
    let kinds = KINDS.into_iter().filter(is_wanted);
    let seeds = args.seed0..args.seed0 + args.seeds;
    let cases = kinds.flat_map(|kind| seeds.clone().map(move |seed| ExperimentCase { kind, seed }));
    let cases = cases.enumerate().filter(|(k, _)| args.shard.holds(*k));
    let cases: Vec<ExperimentCase> = cases.map(|(_, case)| case).collect();
    let tried = try_experiments(&cases, &|outcome| eprintln!("{}", line(outcome)));
    let (mut outcomes, mut failed) = (Vec::new(), 0);
    for outcome in tried {
        match outcome {
            Ok(outcome) => outcomes.push(outcome),
            Err(why) => {
                eprintln!("{why}");
                failed += 1;
            }
        }
    }
    let open: Vec<&ExperimentOutcome> = outcomes.iter().filter(|o| o.settled.is_some()).collect();
    let count = |is: fn(&Settled) -> bool| {
        let settled = open.iter().filter_map(|outcome| outcome.settled.as_ref());
        settled.filter(|settled| is(settled)).count()
    };
    let (settled, one_law) = (count(|s| s.settled), count(|s| s.one_law && !s.settled));
    let share = settled as f64 / (open.len() - one_law).max(1) as f64;
    let measured = Measured::default().table(table(&open)).line(format!(
        "{} arms, of which {} are ambiguous and hold what is hidden. In {one_law} of these the \
             explanations are one law of that arm, which `next` says; of the other {}, one \
             experiment or measurement settles {settled}: {:.0} % (target {:.0} %).",
        outcomes.len(),
        open.len(),
        open.len() - one_law,
        100.0 * share,
        100.0 * TARGET
    ));
    let json = (args.json).then(|| json!(outcomes));
    let title = "Ambiguous diagnoses settled by one proposed experiment";
    let written = args.page.show(json, &measured, "next", title);
    written && failed == 0 && !open.is_empty() && share >= TARGET
}

fn table(open: &[&ExperimentOutcome]) -> Table {
    let mut table = handstand::output::table::plain_table([
        "hidden",
        "seed",
        "left open",
        "proposed",
        "standard errors",
        "then",
        "settled",
    ]);
    for outcome in open {
        let Some(settled) = &outcome.settled else {
            continue;
        };
        let apart = settled
            .separation
            .map_or("–".to_string(), |s| format!("{s:.0}"));
        table.add_row([
            outcome.kind.to_string(),
            outcome.seed.to_string(),
            outcome.first_sets.join(" | "),
            settled.proposed.clone(),
            apart,
            format!("{:?}: {}", settled.verdict, settled.sets.join(" | ")).to_lowercase(),
            match (settled.settled, settled.one_law) {
                (true, _) => "yes",
                (false, true) => "one law",
                (false, false) => "no",
            }
            .to_string(),
        ]);
    }
    table
}

fn line(outcome: &ExperimentOutcome) -> String {
    let first = format!(
        "{} {}: {:?}, {}",
        outcome.kind,
        outcome.seed,
        outcome.first_verdict,
        outcome.first_sets.join(" | ")
    );
    match &outcome.settled {
        None => first,
        Some(settled) => format!(
            "{first}; {} -> {:?}, {} ({:.1} s)",
            settled.proposed,
            settled.verdict,
            settled.sets.join(" | "),
            settled.seconds
        ),
    }
}
