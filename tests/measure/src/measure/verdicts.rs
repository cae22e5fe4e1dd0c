//! `cargo xtask verdicts`: whether what is said of a design is what it then does.
//!
//! `gains`, on random robots, against a simulation of its own (`tests/measure/src/verdicts`);
//! `deploy --dry-run` against `balance` on the simulated CM-5, on random robots and on robots with
//! one non-ideality each.

use super::page::Page;
use super::program;
use comfy_table::Table;
use handstand::output::table::plain_table;
use handstand_measure::measured::Measured;
use handstand_measure::verdicts::robot::{NonIdeality, Robot};
use handstand_measure::verdicts::{Judged, judge};
use rand::{Rng as _, SeedableRng as _};
use rand_chacha::ChaCha8Rng;
use rayon::prelude::*;
use serde_json::{Value, json};
use std::path::Path;
use std::process::{Command, Output};

/// Measure whether verdicts on designs agree with other simulations and with `balance`.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// How many random robots
    #[arg(long, default_value_t = 30)]
    robots: u64,
    /// Seed of robots and starts
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Starts of each robot in the simulation of its own
    #[arg(long, default_value_t = 40)]
    runs: usize,
    /// `gains` alone
    #[arg(long)]
    gains: bool,
    /// Print the figures as JSON
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    page: Page,
}

/// Share of the robots on which both have to agree: 28 of 30.
const AGREE: f64 = 28.0 / 30.0;
/// Attempts of `balance` with each robot, and how many have to stand.
const ATTEMPTS: usize = 10;
const STAND: usize = 9;
/// Starts of `balance` are within this of upright in each joint, deg.
const START_DEG: f64 = 1.0;

/// Exit codes that answer: it stands; it does not; no plan; the CM-5 does not arm; safety stop.
const STOOD: i32 = 0;
const NO: i32 = 1;
const REFUSED: i32 = 3;
const UNARMED: i32 = 4;
const STOPPED: i32 = 5;

const BALANCE_HEADER: [&str; 4] = [
    "Robot",
    "`deploy --dry-run`, of 10",
    "`balance`, of 10",
    "Same",
];

/// Whether the targets are met.
pub fn run(args: &Args) -> bool {
    let mut random = ChaCha8Rng::seed_from_u64(args.seed);
    let robots: Vec<Robot> = (0..args.robots).map(|_| Robot::draw(&mut random)).collect();
    let (judged, refused) = by_gains(args, &robots);
    let agreed = judged.iter().filter(|one| one.agrees()).count();
    let enough = |agreed: usize, of: usize| agreed as f64 >= AGREE * of as f64;
    let mut well = refused.is_empty() && enough(agreed, judged.len());
    let mut measured = Measured::default()
        .table(table(
            [
                "Robot",
                "Weight of speeds",
                "`gains`",
                "stabilised",
                "Own simulation",
                "stand",
                "Same",
            ],
            judged.iter().map(gains_line),
        ))
        .lines(refused)
        .line(format!(
            "`gains` and a simulation of its own agree on {agreed} of {} robots (at least 28 of \
             30).",
            judged.len()
        ));
    let mut figures = json!({ "gains": { "agree": agreed, "robots": judged.len() } });
    if !args.gains {
        let Some(program) = program::built() else {
            return false;
        };
        let (balanced, failed) = balanced(&program, &robots, args.seed);
        let agreed = balanced.iter().filter(|one| one.agrees()).count();
        let (singles, failed_singly) = balanced_singly(&program, args.seed);
        let held = singles.iter().filter(|one| one.agrees());
        let held = held.count();
        let failed = [failed, failed_singly].concat();
        well &= failed.is_empty() && enough(agreed, balanced.len()) && held == singles.len();
        measured = measured
            .lines(failed)
            .table(table(BALANCE_HEADER, balanced.iter().map(balance_line)))
            .line(format!(
                "`deploy --dry-run` and `balance` agree on {agreed} of {} robots (at least 28 of \
                 30).",
                balanced.len()
            ))
            .table(table(BALANCE_HEADER, singles.iter().map(balance_line)))
            .line(format!(
                "One non-ideality each: they agree on {held} of {} (all of them); {} stand.",
                singles.len(),
                singles.iter().filter(|one| one.stands()).count()
            ));
        figures["deploy"] = json!({ "agree": agreed, "robots": balanced.len() });
        figures["single"] = json!({ "agree": held, "robots": singles.len() });
    }
    let json = args.json.then_some(figures);
    let title = "Verdicts on designs, and what the designs then do";
    args.page.show(json, &measured, "verdicts", title) && well
}

fn by_gains(args: &Args, robots: &[Robot]) -> (Vec<Judged>, Vec<String>) {
    let judged = robots.par_iter().enumerate().map(|(place, robot)| {
        let said = judge(robot.clone(), args.runs, args.seed + 1000 + place as u64);
        if let Ok(judged) = &said {
            eprintln!("{}: {}", place + 1, gains_line(judged).join(" | "));
        }
        said.map_err(|why| format!("Robot {} ({}): {why}.", place + 1, robot.words()))
    });
    parted(judged.collect())
}

/// What was found, and why the rest was not.
fn parted<T>(all: Vec<Result<T, String>>) -> (Vec<T>, Vec<String>) {
    let (mut found, mut failed) = (Vec::new(), Vec::new());
    for one in all {
        match one {
            Ok(one) => found.push(one),
            Err(why) => failed.push(why),
        }
    }
    (found, failed)
}

fn table<const N: usize>(header: [&str; N], lines: impl Iterator<Item = [String; N]>) -> Table {
    let mut table = plain_table(header);
    table.add_rows(lines);
    table
}

fn gains_line(one: &Judged) -> [String; 7] {
    let verdict = |stands: bool| if stands { "stabilised" } else { "not" };
    let percent = |share: f64| format!("{:.0} %", 100.0 * share);
    [
        one.robot.words(),
        one.robot.q[5].to_string(),
        verdict(one.gains).to_string(),
        percent(one.gains_share),
        verdict(one.stands()).to_string(),
        percent(one.stood) + if one.held { ", held by friction" } else { "" },
        if one.agrees() { "yes" } else { "NO" }.to_string(),
    ]
}

/// A robot that was deployed to and balanced.
#[derive(Debug)]
struct Balanced {
    robot: String,
    /// Of ten attempts of `deploy --dry-run`; none where it refuses the robot.
    verdict: Option<u64>,
    /// Of ten attempts of `balance`.
    stood: usize,
}

impl Balanced {
    fn stands(&self) -> bool {
        self.stood >= STAND
    }

    fn agrees(&self) -> bool {
        self.verdict.is_some_and(|stood| stood >= STAND as u64) == self.stands()
    }
}

fn balanced(program: &Path, robots: &[Robot], seed: u64) -> (Vec<Balanced>, Vec<String>) {
    let each = robots.par_iter().enumerate().map(|(place, robot)| {
        let balanced = balance(program, robot, seed + 2000 + place as u64);
        if let Ok(balanced) = &balanced {
            eprintln!("{}: {}", place + 1, balance_line(balanced).join(" | "));
        }
        balanced.map_err(|why| format!("Robot {} ({}): {why}.", place + 1, robot.words()))
    });
    parted(each.collect())
}

/// The paper's robot with each of the non-idealities that a plan can hold, alone.
fn balanced_singly(program: &Path, seed: u64) -> (Vec<Balanced>, Vec<String>) {
    let singles = [
        NonIdeality::Delay(0.018),
        NonIdeality::DeadZone(1, 0.2, 0.0),
        NonIdeality::Coulomb(1, 0.05),
        NonIdeality::Viscous(1, 0.05),
        NonIdeality::Saturation(0.6),
        NonIdeality::Scale(0.7),
        NonIdeality::Lag(1, 0.02),
        NonIdeality::Backlash(1, 0.03),
    ];
    let robots = singles.map(Robot::paper);
    balanced(program, &robots, seed + 1000)
}

/// Deploys to a robot and balances it, by the program's own commands without an option but the
/// model. An end that is no answer is an error: two commands that fail alike agree on nothing.
fn balance(program: &Path, robot: &Robot, seed: u64) -> Result<Balanced, String> {
    let folder = tempfile::tempdir().map_err(|error| error.to_string())?;
    let written = std::fs::write(folder.path().join("robot.toml"), robot.toml());
    written.map_err(|error| error.to_string())?;
    let run = |words: &str| {
        let mut command = Command::new(program);
        command.current_dir(folder.path()).args(words.split(' '));
        command.output().map_err(|error| error.to_string())
    };
    let said = run("deploy robot.toml --dry-run --states 1 --json -q")?;
    let verdict = match said.status.code() {
        Some(STOOD | NO) => Some(verdict(&said.stdout)?),
        Some(REFUSED) => None,
        _ => return Err(ended("deploy", &said)),
    };
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let mut stood = 0;
    for _ in 0..ATTEMPTS {
        let [first, second, third]: [f64; 3] =
            std::array::from_fn(|_| random.random_range(-START_DEG..=START_DEG));
        let lean = format!("{first:.3}/{second:.3}/{third:.3}");
        let port = format!("sim-cm5:robot=robot.toml,start=held,lean={lean}");
        let words = format!("balance robot.toml --port {port} --yes --seconds 10 --countdown 0 -q");
        let balanced = run(&words)?;
        match balanced.status.code() {
            Some(STOOD) => stood += 1,
            Some(UNARMED | STOPPED) => {}
            Some(REFUSED) if verdict.is_none() => {}
            _ => return Err(ended("balance", &balanced)),
        }
    }
    Ok(Balanced {
        robot: robot.words(),
        verdict,
        stood,
    })
}

/// How many of the attempts stood that `deploy --json` tells of.
fn verdict(json: &[u8]) -> Result<u64, String> {
    let said: Value = serde_json::from_slice(json).map_err(|error| error.to_string())?;
    let stood = said["verdict"]["stood"].as_u64();
    stood.ok_or_else(|| "`deploy` states no verdict".to_string())
}

fn ended(command: &str, output: &Output) -> String {
    let said = String::from_utf8_lossy(&output.stderr);
    format!("`{command}` ended with {}: {}", output.status, said.trim())
}

fn balance_line(one: &Balanced) -> [String; 4] {
    [
        one.robot.clone(),
        one.verdict
            .map_or("refused".into(), |stood| stood.to_string()),
        one.stood.to_string(),
        if one.agrees() { "yes" } else { "NO" }.to_string(),
    ]
}
