//! `cargo xtask ablation`: what each part of the search for missing effects brings, and costs.
//!
//! The same rigs are diagnosed with the whole search, and once without each of its parts. A part
//! that no rig needs, and that costs time, does not pay.

use super::hidden::{provenance, style};
use super::journal;
use super::page::{Page, print};
use clap::builder::PossibleValuesParser;
use comfy_table::Table;
use handstand::diagnose::Strategy;
use handstand_measure::hidden::{
    Answer, Case, Family, Outcome, Plan, Truth, install_mujoco, try_all,
};
use handstand_measure::measured::Measured;
use indicatif::ProgressBar;
use serde::{Deserialize, Serialize};
use serde_json::json;
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::sync::Mutex;

/// Measure what each part of the search for missing effects brings.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// Who makes the logs
    #[arg(long, value_enum, default_value = "own")]
    truth: Truth,
    /// Only without these parts
    #[arg(long, value_delimiter = ',', value_parser = PossibleValuesParser::new(names()))]
    parts: Vec<String>,
    /// Without all of them at once
    #[arg(long, requires = "parts")]
    together: bool,
    /// Rigs of these families
    #[arg(long, value_delimiter = ',', default_value = "single,pairs,triples")]
    #[arg(value_parser = PossibleValuesParser::new(families()))]
    families: Vec<String>,
    /// Rigs per effect; of pairs and triples ten sets per seed
    #[arg(long, default_value_t = 1)]
    seeds: u64,
    /// First seed, from 1
    #[arg(long, default_value_t = 31_001, value_parser = clap::value_parser!(u64).range(1..))]
    seed0: u64,
    /// Append every outcome to this file of JSON lines, and leave out what it holds
    #[arg(long, value_name = "FILE")]
    outcomes: Option<PathBuf>,
    /// Try nothing: tabulate all that the file of outcomes holds
    #[arg(long, requires = "outcomes")]
    tabulate: bool,
    /// Print every outcome as JSON
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    page: Page,
}

/// What was said of a rig without a part of the search.
#[derive(Debug, Clone, Serialize, Deserialize)]
struct Ablated {
    /// The parts; empty of the whole search.
    without: String,
    outcome: Outcome,
}

fn names() -> Vec<&'static str> {
    Strategy::ALL.into_iter().map(Strategy::name).collect()
}

fn families() -> Vec<&'static str> {
    let all = handstand_measure::hidden::FAMILIES.into_iter();
    all.map(Family::name).collect()
}

/// Whether every rig could be tried.
pub fn run(args: &Args) -> bool {
    match tried(args) {
        Ok(all) => all,
        Err(why) => {
            eprintln!("{why}");
            false
        }
    }
}

fn tried(args: &Args) -> Result<bool, String> {
    if args.truth == Truth::Mujoco && !install_mujoco() {
        return Err("MuJoCo cannot be installed".to_string());
    }
    let file = args.outcomes.as_deref();
    let mut all = file.map_or(Ok(Vec::new()), journal::read)?;
    let mut failed = 0;
    if !args.tabulate {
        let named = args.families.iter().filter_map(|name| Family::named(name));
        let plan = Plan {
            truth: args.truth,
            families: named.collect(),
            effects: Vec::new(),
            seeds: args.seeds,
            nominal: 10,
            seed0: args.seed0,
        };
        plan.check()?;
        let asked = args.parts.iter().filter_map(|name| Strategy::named(name));
        let asked: Vec<Strategy> = asked.collect();
        let asked = match asked.as_slice() {
            [] => Strategy::ALL.to_vec(),
            _ => asked,
        };
        let rows: Vec<&[Strategy]> = if args.together {
            vec![&asked]
        } else {
            asked.chunks(1).collect()
        };
        for without in [&[][..]].into_iter().chain(rows) {
            failed += try_without(without, &plan.cases(), file, &mut all);
        }
    }
    let measured = measured(&all);
    let json = args.json.then(|| json!(all));
    print(json, &measured);
    let outcomes: Vec<Outcome> = all.into_iter().map(|own| own.outcome).collect();
    let (from, title) = (provenance(&outcomes), "What each part of the search brings");
    let written = args.page.keep(&from, &measured, "ablation", title);
    Ok(failed == 0 && written)
}

/// Tries the cases that are left without parts of the search, and keeps what was said; how many
/// could not be tried.
fn try_without(
    without: &[Strategy],
    cases: &[Case],
    file: Option<&Path>,
    all: &mut Vec<Ablated>,
) -> usize {
    let names: Vec<&str> = without.iter().map(|part| part.name()).collect();
    let name = names.join(", ");
    let is_known = |case: &Case| {
        let mut same = all.iter().filter(|known| known.without == name);
        same.any(|known| known.outcome.is_of(case))
    };
    let mut left: Vec<Case> = cases.to_vec();
    left.retain(|case| !is_known(case));
    for case in &mut left {
        case.skipped = without.to_vec();
    }
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    let bar = ProgressBar::new(left.len() as u64).with_style(style());
    let found = Mutex::new(Vec::new());
    let (_, failed) = try_all(&left, None, [threads, threads], &|outcome| {
        let ablated = Ablated {
            without: name.clone(),
            outcome: outcome.clone(),
        };
        bar.suspend(|| eprintln!("{}", line(&ablated)));
        bar.inc(1);
        let kept = file.map_or(Ok(()), |file| journal::append(file, &ablated));
        if let Err(why) = kept {
            bar.suspend(|| eprintln!("the outcome is not kept: {why}"));
        }
        if let Ok(mut found) = found.lock() {
            found.push(ablated);
        }
    });
    bar.finish_and_clear();
    for (case, why) in &failed {
        eprintln!("{}: {why}", case.hidden.join(" + "));
    }
    all.extend(found.into_inner().unwrap_or_default());
    failed.len()
}

fn line(ablated: &Ablated) -> String {
    let without = match ablated.without.as_str() {
        "" => "whole search",
        parts => parts,
    };
    let text = handstand_measure::hidden::line(&ablated.outcome);
    format!("{without}: {text}")
}

fn is_reached(outcome: &Outcome) -> bool {
    matches!(outcome.answer, Answer::Right | Answer::Equivalent)
}

/// What a row of the table is of: parts left out, and rigs of a family.
type Row<'a> = (&'a str, String);

fn measured(all: &[Ablated]) -> Measured {
    let mut table = Table::new();
    table.set_header([
        "without",
        "rigs",
        "reached",
        "with the whole search",
        "wrong",
        "with the whole search",
        "lost",
        "won",
        "time / whole search",
    ]);
    let mut measured = Measured::default();
    let mut rows = BTreeMap::<Row, Vec<[&Outcome; 2]>>::new();
    for own in all.iter().filter(|own| !own.without.is_empty()) {
        if let Some(whole) = whole_of(all, own) {
            let row = (own.without.as_str(), family_of(&own.outcome));
            rows.entry(row).or_default().push([whole, &own.outcome]);
        }
    }
    let mut lines = Vec::new();
    let mut several = BTreeMap::<&str, usize>::new();
    for ((without, family), pairs) in &rows {
        let next = several.len() + 1;
        let name = match without.split(", ").count() {
            1 => (*without).to_string(),
            count => {
                let note = several.entry(without).or_insert(next);
                format!("{count} parts ({note})")
            }
        };
        table.add_row(row(&name, family, pairs));
        lines.extend(pairs.iter().filter_map(|pair| differing(&name, pair)));
    }
    measured = measured.table(table);
    for (parts, note) in several {
        measured = measured.line(format!("({note}): {parts}"));
    }
    measured.line(rigs(all)).lines(lines)
}

/// What the whole search said of the rig that was tried without a part.
fn whole_of<'a>(all: &'a [Ablated], own: &Ablated) -> Option<&'a Outcome> {
    let b = &own.outcome;
    let is_same = |a: &Outcome| {
        a.truth == b.truth && a.family == b.family && a.kinds == b.kinds && a.seed == b.seed
    };
    let mut whole = all.iter().filter(|whole| whole.without.is_empty());
    let whole = whole.find(|whole| is_same(&whole.outcome))?;
    Some(&whole.outcome)
}

/// The family of a rig, and who made its logs where that is another than the challenges.
fn family_of(outcome: &Outcome) -> String {
    let family = outcome.family.name();
    match outcome.truth {
        Truth::Own => family.to_string(),
        Truth::Mujoco => format!("{family} (MuJoCo)"),
        Truth::Robot => format!("{family} (virtual robot)"),
    }
}

/// How the outcomes without a part compare with those of the whole search, which come first.
fn row(without: &str, family: &str, pairs: &[[&Outcome; 2]]) -> [String; 9] {
    let count = |side: usize, is: &dyn Fn(&Outcome) -> bool| {
        let sides = pairs.iter().filter(|pair| is(pair[side]));
        sides.count().to_string()
    };
    let wrong = |outcome: &Outcome| outcome.answer == Answer::Wrong;
    let seconds = |side: usize| pairs.iter().map(|pair| pair[side].seconds).sum::<f64>();
    let turned = |to: bool| {
        let turned = pairs.iter().map(|pair| pair.map(is_reached));
        turned.filter(|pair| *pair == [!to, to]).count().to_string()
    };
    [
        without.to_string(),
        format!("{} {family}", pairs.len()),
        count(1, &is_reached),
        count(0, &is_reached),
        count(1, &wrong),
        count(0, &wrong),
        turned(false),
        turned(true),
        format!("{:.2}", seconds(1) / seconds(0)),
    ]
}

/// What both said of a rig that only one of them explained rightly.
fn differing(without: &str, [whole, own]: &[&Outcome; 2]) -> Option<String> {
    let said = |outcome: &Outcome| {
        let sets = outcome.sets.iter().map(|set| set.join(" + "));
        let sets: Vec<String> = sets.collect();
        format!("{} {}", outcome.verdict, sets.join(" | "))
    };
    (is_reached(whole) != is_reached(own)).then(|| {
        format!(
            "without {without}: {}, seed {}, {}: {}; whole search: {}",
            family_of(own),
            own.seed,
            own.hidden.join(" + "),
            said(own),
            said(whole)
        )
    })
}

/// Which parts that were measured the search no longer has.
fn gone(all: &[Ablated]) -> String {
    let measured = all.iter().flat_map(|own| own.without.split(", "));
    let measured: BTreeSet<&str> = measured.filter(|part| !part.is_empty()).collect();
    let gone: Vec<&str> = measured
        .into_iter()
        .filter(|part| Strategy::named(part).is_none())
        .collect();
    if gone.is_empty() {
        return String::new();
    }
    format!(" Taken out of the search since: {}.", gone.join(", "))
}

/// The families of the rigs, with their seeds.
fn rigs(all: &[Ablated]) -> String {
    let mut seeds = BTreeMap::<String, BTreeSet<u64>>::new();
    for own in all {
        let of_family = seeds.entry(family_of(&own.outcome)).or_default();
        of_family.insert(own.outcome.seed);
    }
    let families = seeds.iter().map(|(family, seeds)| {
        let ends = [seeds.first(), seeds.last()].map(|seed| seed.copied().unwrap_or(0));
        format!("{family}, seeds {} to {}", ends[0], ends[1])
    });
    format!(
        "Rigs: {}. A row is measured by `--families` and `--parts` (several at once with \
         `--together`), and kept in the file of `--outcomes`.{}",
        families.collect::<Vec<_>>().join("; "),
        gone(all)
    )
}
