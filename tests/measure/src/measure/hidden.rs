//! `cargo xtask hidden`: how often hidden effects are named, missed, or invented, against targets.
//!
//! Families of cases: one effect at the bench arm, at the robot hanging, at the robot hanging and
//! balancing; two and three effects; none; one that the library lacks; one where every value of the
//! file is a little wrong, too; one at an arm in space, which MuJoCo alone makes. Every rig has
//! motions to learn from and some held out. The truth is the library's own independent equations,
//! with `--truth mujoco` MuJoCo's, with `--truth robot` the virtual robot recorded through the
//! firmware.
//! A line goes to stderr as each diagnosis ends, whichever ends first; the tables go to stdout.
//! Fails when a target is missed or a case cannot be made.
//!
//! With `--outcomes FILE` each outcome is appended to a file of JSON lines, and what it holds is
//! not tried again: a run that was stopped goes on, and the files of shards, put together, make one
//! table (`--tabulate`).

use super::journal;
use super::page::{Page, print};
use clap::builder::PossibleValuesParser;
use handstand::challenge::{KINDS, Motions};
use handstand::study::Shard;
use handstand_measure::hidden::{
    FAMILIES, Family, OUTSIDE, Outcome, Plan, Tally, Truth, install_mujoco, line, misses, tables,
    try_all,
};
use handstand_measure::measured::{Measured, Provenance};
use indicatif::{ProgressBar, ProgressStyle};
use serde_json::json;
use std::collections::BTreeSet;
use std::path::PathBuf;

/// Measure how often hidden effects are named, missed and invented.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// Who makes the logs
    #[arg(long, value_enum, default_value = "own")]
    truth: Truth,
    /// Only these families
    #[arg(long, value_delimiter = ',', value_parser = PossibleValuesParser::new(names()))]
    families: Vec<String>,
    /// Rigs per effect; of pairs and triples ten sets per seed
    #[arg(long, default_value_t = 10)]
    seeds: u64,
    /// Arms that hide nothing
    #[arg(long, default_value_t = 200)]
    nominal: u64,
    /// First seed, from 1
    #[arg(long, default_value_t = 1, value_parser = clap::value_parser!(u64).range(1..))]
    seed0: u64,
    /// Hide only these, where one is hidden
    #[arg(long, value_delimiter = ',', value_parser = PossibleValuesParser::new(hideable()))]
    effects: Vec<String>,
    /// Try only this share of the cases: `2/5` is the second of five
    #[arg(long, default_value = "1/1", value_name = "I/N")]
    shard: Shard,
    /// Diagnoses at a time; one per core without it
    #[arg(long)]
    jobs: Option<usize>,
    /// Append every outcome to this file of JSON lines, and leave out what it holds
    #[arg(long, value_name = "FILE")]
    outcomes: Option<PathBuf>,
    /// Try nothing: tabulate all that the file of outcomes holds, its number of rigs by family
    #[arg(long, requires = "outcomes")]
    tabulate: bool,
    /// Keep every rig's model, true model and logs in this folder
    #[arg(long, value_name = "DIR")]
    rigs: Option<PathBuf>,
    /// Print every outcome and the figures as JSON
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    page: Page,
}

fn names() -> Vec<&'static str> {
    FAMILIES.into_iter().map(Family::name).collect()
}

fn hideable() -> Vec<&'static str> {
    KINDS.into_iter().chain(OUTSIDE).collect()
}

/// Whether every target is met.
pub fn run(args: &Args) -> bool {
    match tried(args) {
        Ok(met) => met,
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
    let families = args.families.iter().filter_map(|name| Family::named(name));
    let mut families: Vec<Family> = families.collect();
    if families.is_empty() {
        families = FAMILIES.to_vec();
    }
    let plan = Plan {
        truth: args.truth,
        families,
        effects: args.effects.clone(),
        seeds: args.seeds,
        nominal: args.nominal,
        seed0: args.seed0,
    };
    let mut old = args
        .outcomes
        .as_deref()
        .map_or(Ok(Vec::new()), journal::read::<Outcome>)?;
    if !(args.tabulate || args.families.is_empty()) {
        plan.check()?;
    }
    let mut cases = plan.cases();
    let mut number = 0;
    cases.retain(|_| {
        number += 1;
        args.shard.holds(number - 1)
    });
    if args.tabulate {
        old.retain(|outcome| outcome.truth == args.truth);
        cases.clear();
    } else {
        old.retain(|outcome| cases.iter().any(|case| outcome.is_of(case)));
        cases.retain(|case| !old.iter().any(|outcome| outcome.is_of(case)));
    }

    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    let bar = ProgressBar::new(cases.len() as u64).with_style(style());
    let jobs = args.jobs.unwrap_or(threads);
    let rigs = args.rigs.as_deref();
    let (new, failed) = try_all(&cases, rigs, [jobs, threads], &|outcome| {
        bar.suspend(|| eprintln!("{}", line(outcome)));
        bar.inc(1);
        let kept = (args.outcomes.as_deref()).map(|file| journal::append(file, outcome));
        if let Some(Err(why)) = kept {
            bar.suspend(|| eprintln!("the outcome is not kept: {why}"));
        }
    });
    bar.finish_and_clear();
    for (case, why) in &failed {
        let (family, kinds) = (case.family.name(), case.hidden.join(" + "));
        eprintln!("{family}, seed {}, {kinds}: {why}", case.seed);
    }
    old.extend(new);
    let tally = Tally::of(&old);
    let json = (args.json).then(|| json!({ "tally": tally, "outcomes": old }));
    print(json, &measured(&old));
    let written = PAGES.iter().all(|page| {
        let own: Vec<Outcome> = old.iter().filter(|o| page.holds(o)).cloned().collect();
        let keep = |page: &RigPage| {
            let (from, measured) = (provenance(&own), measured(&own));
            args.page.keep(&from, &measured, page.name, page.title)
        };
        own.is_empty() || keep(page)
    });
    Ok(tally.is_met() && failed.is_empty() && written)
}

fn measured(outcomes: &[Outcome]) -> Measured {
    tables(&Tally::of(outcomes)).lines(misses(outcomes))
}

/// This run, with the versions that the outcomes are of.
pub(super) fn provenance(outcomes: &[Outcome]) -> Provenance {
    let versions = outcomes.iter().map(|outcome| outcome.version.as_str());
    let versions: BTreeSet<&str> = versions.collect();
    let versions: Vec<&str> = versions.into_iter().collect();
    Provenance {
        version: versions.join(", "),
        ..Provenance::here()
    }
}

/// What is said of the rigs of a page.
#[derive(PartialEq)]
enum Files {
    /// One arm, all but what is hidden as the file says.
    ExactArm,
    /// The same of three links.
    ExactChain,
    /// Files that are a little wrong everywhere.
    Approximate,
    /// An arm in space, all but what is hidden and its friction as the file says.
    InSpace,
}

/// A page of docs/measured: the outcomes of one truth at one kind of rig.
struct RigPage {
    truth: Truth,
    files: Files,
    name: &'static str,
    title: &'static str,
}

const PAGES: [RigPage; 8] = [
    RigPage {
        truth: Truth::Own,
        files: Files::ExactArm,
        name: "hidden",
        title: "Hidden effects named, missed and invented: one arm",
    },
    RigPage {
        truth: Truth::Own,
        files: Files::ExactChain,
        name: "hidden-chain",
        title: "Hidden effects named, missed and invented: three links",
    },
    RigPage {
        truth: Truth::Mujoco,
        files: Files::ExactArm,
        name: "hidden-mujoco",
        title: "Hidden effects named, missed and invented: MuJoCo's truth",
    },
    RigPage {
        truth: Truth::Mujoco,
        files: Files::ExactChain,
        name: "hidden-chain-mujoco",
        title: "Hidden effects named, missed and invented: MuJoCo's truth, three links",
    },
    RigPage {
        truth: Truth::Own,
        files: Files::Approximate,
        name: "hidden-approximate",
        title: "Hidden effects named, missed and invented: files a little wrong everywhere",
    },
    RigPage {
        truth: Truth::Mujoco,
        files: Files::Approximate,
        name: "hidden-approximate-mujoco",
        title: "Hidden effects named, missed and invented: MuJoCo's truth, files a little wrong",
    },
    RigPage {
        truth: Truth::Mujoco,
        files: Files::InSpace,
        name: "hidden-space",
        title: "Hidden effects named, missed and invented: arms in space",
    },
    RigPage {
        truth: Truth::Robot,
        files: Files::ExactArm,
        name: "hidden-robot",
        title: "Hidden effects named, missed and invented: the virtual robot's own recordings",
    },
];

impl RigPage {
    fn holds(&self, outcome: &Outcome) -> bool {
        let files = if outcome.family.is_in_space() {
            Files::InSpace
        } else if outcome.family.is_approximate() {
            Files::Approximate
        } else if outcome.family.motions() == Motions::Arm {
            Files::ExactArm
        } else {
            Files::ExactChain
        };
        outcome.truth == self.truth && files == self.files
    }
}

/// The bar of many diagnoses.
pub(super) fn style() -> ProgressStyle {
    ProgressStyle::with_template("{bar:30} {pos} of {len}, {eta} left")
        .unwrap_or_else(|_| ProgressStyle::default_bar())
}
