//! `cargo xtask detection`: how weak an effect at the bench arm may be and still be named.
//!
//! What an arm hides is made weaker, by the root of a half at a time, until `diagnose` with default
//! settings no longer finds it. The motions are commanded alike at every strength.

use super::page::Page;
use clap::builder::PossibleValuesParser;
use handstand::challenge::KINDS;
use handstand_measure::hidden::{DetectionLimit, Faintest, detection_limit, limits_table};
use handstand_measure::measured::Measured;
use indicatif::ProgressBar;
use rayon::prelude::*;
use serde_json::json;

/// Measure how weak an effect may be and still be named.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// Arms per effect
    #[arg(long, default_value_t = 3)]
    seeds: u64,
    /// Only these effects
    #[arg(long, value_delimiter = ',', value_parser = PossibleValuesParser::new(KINDS))]
    effects: Vec<String>,
    /// Print every arm as JSON
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    page: Page,
}

/// Whether every arm could be tried; there is no target.
pub fn run(args: &Args) -> bool {
    let wanted = |kind: &&str| args.effects.is_empty() || args.effects.iter().any(|it| it == kind);
    let kinds = KINDS.into_iter().filter(wanted);
    let arms: Vec<(&str, u64)> = kinds
        .flat_map(|kind| (1..=args.seeds).map(move |seed| (kind, seed)))
        .collect();
    let bar = ProgressBar::new(arms.len() as u64);
    let found: Vec<Result<DetectionLimit, String>> = arms
        .par_iter()
        .map(|(kind, seed)| {
            let found = detection_limit(kind, *seed);
            bar.suspend(|| match &found {
                Ok(limit) => eprintln!("{}", line(limit)),
                Err(why) => eprintln!("{kind}, seed {seed}: {why}"),
            });
            bar.inc(1);
            found
        })
        .collect();
    bar.finish_and_clear();
    let limits: Vec<DetectionLimit> = found.iter().flatten().cloned().collect();
    let measured = Measured::default().table(limits_table(&limits)).line(
        "Named: exactly, or in a set of explanations that cannot be told apart. Noticed: something \
         is said to be missing. Medians over the arms; a dash: not even as strong as the benchmark \
         hides it. A limit, a stiffness or a share that remains is the largest that is found.",
    );
    let json = args.json.then(|| json!(limits));
    let title = "Detection limits: how weak an effect is still named";
    let written = args.page.show(json, &measured, "detection", title);
    written && limits.len() == arms.len()
}

fn line(limit: &DetectionLimit) -> String {
    let share =
        |found: Option<Faintest>| found.map_or("-".to_string(), |it| format!("{:.4}", it.share));
    format!(
        "{:20} seed {:<3} named from {}, noticed from {} of its strength",
        limit.kind,
        limit.seed,
        share(limit.named),
        share(limit.noticed)
    )
}
