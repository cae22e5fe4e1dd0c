//! `cargo xtask spoiled`: every bundled, public and simulated log, spoiled in every way, and what
//! `handstand log check` says of it.
//!
//! The public logs lie in the folder `HANDSTAND_DATA` names. Simulated logs are those of
//! [`handstand::challenge`]: each rig hides an effect that its model lacks, which must not be taken
//! for a spoiled log.

use super::page::Page;
use comfy_table::{ContentArrangement, Table, presets::UTF8_HORIZONTAL_ONLY};
use handstand::challenge::{KINDS, Motions};
use handstand_measure::measured::Measured;
use handstand_measure::spoiled::{
    Answer, Outcome, Rig, bundled, judge, public, simulated, spoilings, unspoiled,
};
use std::collections::BTreeMap;
use std::path::PathBuf;

/// Spoil logs in every way, and measure what the check finds.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// Only the logs whose name holds this
    #[arg(long)]
    only: Option<String>,
    /// Simulated rigs whose logs are judged as they are
    #[arg(long, default_value_t = 200)]
    alarms: u64,
    /// Simulated rigs whose logs are spoiled
    #[arg(long, default_value_t = 6)]
    simulated: u64,
    /// Print every outcome as JSON
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    page: Page,
}

/// Least share found with the right remedy, most share of alarms, and longest check, s.
const FOUND: f64 = 0.95;
const ALARMS: f64 = 0.02;
const LONGEST_S: f64 = 60.0;

/// Whether the targets are met.
pub fn run(args: &Args) -> bool {
    let rigs = match rigs(args) {
        Ok(rigs) => rigs,
        Err(why) => {
            eprintln!("{why}");
            return false;
        }
    };
    let mut outcomes = Vec::new();
    for rig in &rigs {
        let mut hear = |outcome: Outcome| {
            if !matches!(outcome.answer, Answer::Right | Answer::Unseen) {
                eprintln!("{}", line(&outcome));
            }
            outcomes.push(outcome);
        };
        hear(unspoiled(rig));
        for spoiling in spoilings(rig) {
            hear(judge(rig, spoiling));
        }
        eprintln!("{}", rig.name);
    }
    // A column that was read at another time is a fault of the log, and is to be found.
    let good = KINDS.into_iter().filter(|kind| *kind != "time_offset");
    let good: Vec<&str> = good.collect();
    let simulated = (0..args.alarms).filter_map(|seed| {
        let kind = good[seed as usize % good.len()];
        let motions = if seed % 4 == 3 {
            Motions::Hanging
        } else {
            Motions::Arm
        };
        let rig = simulated(motions, kind, 1000 + seed)?;
        wanted(args, &rig).then(|| unspoiled(&rig))
    });
    let simulated: Vec<Outcome> = simulated.collect();
    for outcome in simulated.iter().filter(|o| o.answer != Answer::Right) {
        eprintln!("{}", line(outcome));
    }
    outcomes.extend(simulated);
    let json = args.json.then(|| serde_json::json!(outcomes));
    let shown = args
        .page
        .show(json, &tables(&outcomes), "spoiled", "Spoiled logs");
    shown && met(&outcomes)
}

fn wanted(args: &Args, rig: &Rig) -> bool {
    args.only
        .as_ref()
        .is_none_or(|part| rig.name.contains(part.as_str()))
}

fn rigs(args: &Args) -> Result<Vec<Rig>, String> {
    let Some(data) = std::env::var_os("HANDSTAND_DATA").map(PathBuf::from) else {
        return Err("HANDSTAND_DATA is unset: it must name the folder of the public logs".into());
    };
    let told = |error: handstand::Error| error.to_string();
    let mut rigs = vec![bundled().map_err(told)?];
    rigs.extend(public(&data).map_err(told)?);
    rigs.extend((0..args.simulated).filter_map(|seed| {
        let motions = if seed % 2 == 1 {
            Motions::Hanging
        } else {
            Motions::Arm
        };
        simulated(motions, KINDS[seed as usize % KINDS.len()], seed)
    }));
    rigs.retain(|rig| wanted(args, rig));
    Ok(rigs)
}

fn line(outcome: &Outcome) -> String {
    let share = |share: Option<f64>| share.map_or("-".to_string(), |share| format!("{share:.3}"));
    format!(
        "  {:?} {} {} ({} -> {}) {:.1} s: {}",
        outcome.answer,
        outcome.log,
        outcome.detail,
        share(outcome.unexplained[0]),
        share(outcome.unexplained[1]),
        outcome.seconds,
        outcome.said.join("\n      ")
    )
}

/// How often each answer was given.
#[derive(Default)]
struct Count {
    right: usize,
    other: usize,
    missed: usize,
    unseen: usize,
}

impl Count {
    fn of<'a>(outcomes: impl Iterator<Item = &'a Outcome>) -> Count {
        let mut count = Count::default();
        for outcome in outcomes {
            match outcome.answer {
                Answer::Right => count.right += 1,
                Answer::Other => count.other += 1,
                Answer::Missed => count.missed += 1,
                Answer::Unseen => count.unseen += 1,
            }
        }
        count
    }

    fn seen(&self) -> usize {
        self.right + self.other + self.missed
    }

    fn share(&self) -> f64 {
        self.right as f64 / self.seen().max(1) as f64
    }
}

fn spoiled(outcomes: &[Outcome]) -> impl Iterator<Item = &Outcome> {
    outcomes.iter().filter(|outcome| outcome.spoiling.is_some())
}

fn as_it_is(outcomes: &[Outcome]) -> impl Iterator<Item = &Outcome> {
    outcomes.iter().filter(|outcome| outcome.spoiling.is_none())
}

fn longest_s(outcomes: &[Outcome]) -> f64 {
    outcomes
        .iter()
        .map(|outcome| outcome.seconds)
        .fold(0.0, f64::max)
}

fn met(outcomes: &[Outcome]) -> bool {
    let alarms = 1.0 - Count::of(as_it_is(outcomes)).share();
    let found = Count::of(spoiled(outcomes)).share();
    found >= FOUND && alarms <= ALARMS && longest_s(outcomes) <= LONGEST_S
}

fn tables(outcomes: &[Outcome]) -> Measured {
    let header = [
        "",
        "Seen",
        "Right remedy",
        "Another",
        "None",
        "Not to be seen",
    ];
    let by = |key: &dyn Fn(&Outcome) -> String, head: &str| {
        let mut names = header.map(str::to_string);
        names[0] = head.to_string();
        let mut table = Table::new();
        table
            .load_preset(UTF8_HORIZONTAL_ONLY)
            .set_content_arrangement(ContentArrangement::Disabled)
            .set_header(names);
        let mut groups: BTreeMap<String, Vec<&Outcome>> = BTreeMap::new();
        for outcome in spoiled(outcomes) {
            groups.entry(key(outcome)).or_default().push(outcome);
        }
        for (name, group) in groups {
            table.add_row(row(&name, &Count::of(group.into_iter())));
        }
        table.add_row(row("all", &Count::of(spoiled(outcomes))));
        table
    };
    let quiet = Count::of(as_it_is(outcomes));
    let seconds: f64 = outcomes.iter().map(|outcome| outcome.seconds).sum();
    Measured::default()
        .table(by(&|o| o.spoiling.unwrap_or_default().to_string(), "Spoiling"))
        .table(by(&|o| o.log.clone(), "Log"))
        .line(format!(
            "Logs as they are: {} judged, {} with an alarm ({:.1} %).",
            quiet.seen(),
            quiet.other,
            100.0 * (1.0 - quiet.share())
        ))
        .line(format!(
            "A check takes {:.1} s on the mean, {:.1} s at most.",
            seconds / outcomes.len().max(1) as f64,
            longest_s(outcomes)
        ))
        .line(
            "A spoiling is not to be seen where the model does as well on the spoiled log, within a \
             quarter of its error: a free pendulum mirrored, the sign of an input that stays zero.",
        )
}

fn row(name: &str, count: &Count) -> [String; 6] {
    [
        name.to_string(),
        count.seen().to_string(),
        format!("{} ({:.0} %)", count.right, 100.0 * count.share()),
        count.other.to_string(),
        count.missed.to_string(),
        count.unseen.to_string(),
    ]
}
