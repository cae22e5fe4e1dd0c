//! `cargo xtask robot-demo`: `handstand demo --robot` over many seeds: where the nominal plan
//! stands, where the learned one does, and whether what was hidden was named.

use super::page::Page;
use comfy_table::{Table, presets::UTF8_HORIZONTAL_ONLY};
use handstand::deploy::rehearsal::BalanceAttempt;
use handstand::diagnose::Verdict;
use handstand::robot_demo::{RobotDemo, ScoredEffect, run as circle};
use handstand_measure::measured::Measured;
use serde_json::json;

/// Run the robot's demonstration over many seeds.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// How many robots
    #[arg(long, default_value_t = 10)]
    seeds: u64,
    /// Seed of the first
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Print the demonstrations as JSON
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    page: Page,
}

/// Of ten robots: least that stand as learned, most that stand as believed, least that are named.
const LEARNED: f64 = 0.9;
const NOMINAL: f64 = 0.3;
const NAMED: f64 = 0.9;

/// Whether the targets are met.
pub fn run(args: &Args) -> bool {
    let (mut demos, mut refused) = (Vec::new(), Vec::new());
    for seed in args.seed..args.seed + args.seeds {
        match of_seed(seed) {
            Ok(demo) => {
                eprintln!("{}", line(&demo).join("; "));
                demos.push(demo);
            }
            Err(why) => {
                eprintln!("seed {seed}: {why}");
                refused.push(format!("Seed {seed}: {why}."));
            }
        }
    }
    let share = |of: fn(&RobotDemo) -> bool| {
        demos.iter().filter(|demo| of(demo)).count() as f64 / args.seeds.max(1) as f64
    };
    // One that came to no end counts against every target.
    let unknown = refused.len() as f64 / args.seeds.max(1) as f64;
    let nominal = share(|demo| demo.nominal.stands) + unknown;
    let learned = share(|demo| demo.learned.stands);
    let named = share(|demo| demo.named);
    let percent = |share: f64| format!("{:.0} %", 100.0 * share);
    let measured = Measured::default().table(table(&demos)).lines(refused);
    let measured = measured.line(format!(
        "Stand for 10 s: {} as believed (at most {}), {} as learned (at least {}). Named: {} (at \
         least {}).",
        percent(nominal),
        percent(NOMINAL),
        percent(learned),
        percent(LEARNED),
        percent(named),
        percent(NAMED),
    ));
    let json = args.json.then(|| json!(demos));
    let title = "A robot balanced before and after it was measured";
    let written = args.page.show(json, &measured, "robot-demo", title);
    written && learned >= LEARNED && nominal <= NOMINAL && named >= NAMED
}

fn of_seed(seed: u64) -> Result<RobotDemo, String> {
    let dir = tempfile::tempdir().map_err(|error| error.to_string())?;
    circle(seed, dir.path(), &|_| {}).map_err(|error| error.to_string())
}

fn table(demos: &[RobotDemo]) -> Table {
    let mut table = Table::new();
    let header = [
        "Seed",
        "Hidden: true, estimated",
        "Named",
        "As believed",
        "As learned",
    ];
    table.load_preset(UTF8_HORIZONTAL_ONLY).set_header(header);
    for demo in demos {
        table.add_row(line(demo));
    }
    table
}

fn line(demo: &RobotDemo) -> [String; 5] {
    let effects = demo.effects.chunk_by(|a, b| a.address == b.address);
    let effects: Vec<String> = effects.map(|values| effect(&values[0])).collect();
    let named = if demo.named {
        "yes".to_string()
    } else {
        let open = if demo.verdict == Verdict::Ambiguous {
            ", or something else"
        } else {
            ""
        };
        format!("NO: {}{open}", demo.added.join(", "))
    };
    [
        demo.seed.to_string(),
        effects.join("; "),
        named,
        attempt(&demo.nominal),
        attempt(&demo.learned),
    ]
}

fn effect(effect: &ScoredEffect) -> String {
    let estimate = effect
        .estimate
        .map_or("-".to_string(), |it| format!("{it:.4}"));
    format!("{} {:.4}, {estimate}", effect.address, effect.true_value)
}

fn attempt(attempt: &BalanceAttempt) -> String {
    let sway = attempt
        .sway_rms_rad
        .map_or(String::new(), |rad| format!(", {:.0} mrad", 1e3 * rad));
    if attempt.stands {
        format!("stands{sway}")
    } else {
        format!("{:.1} s{sway}", attempt.stood_s)
    }
}
