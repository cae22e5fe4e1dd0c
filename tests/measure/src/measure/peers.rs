//! `cargo xtask peers`: the same tasks by other programs and by the library, in one run and in
//! turns.
//!
//! First says and installs what the peers need, into `target/peers`; `--no-install` leaves that
//! out. A figure is a ratio of two times taken one after the other on this machine. Fails when a
//! target is missed.

mod dynamics;

use super::page::Page;
use comfy_table::{Table, presets::UTF8_HORIZONTAL_ONLY};
use handstand_measure::measured::Measured;
use handstand_measure::peers::{
    Arm, Robot, angles_after, chain_fixture, dlqr_off, dlqr_seconds, runs_per_second,
};
use handstand_xtask::program::run as succeeds;
use handstand_xtask::root;
use serde_json::Value;
use std::path::PathBuf;
use std::process::Command;

/// Measure other programs and the library on the same tasks.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// Install nothing
    #[arg(long)]
    no_install: bool,
    /// Times the two take turns at short tasks
    #[arg(long, default_value_t = 3)]
    rounds: usize,
    /// Only these tasks
    #[arg(long, value_enum, value_delimiter = ',')]
    only: Vec<Task>,
    #[command(flatten)]
    page: Page,
}

/// What is measured.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
enum Task {
    /// One evaluation of the forward dynamics
    Dynamics,
    /// Runs of the closed loop
    ClosedLoop,
    /// Gains from Riccati equations
    Gains,
    /// Fits and diagnoses of a servo arm's logs
    Fits,
}

const NOTES: [&str; 2] = [
    "Times are seconds of wall clock, medians; the library uses every core, SciPy one. It is built \
     with the profile `dist`: thin LTO.",
    "A start converges when it leaves at most 1.1 times the floor: with SciPy over one free run; \
     with the library over the longest stable windows, and then every value must be within 10 % \
     of the truth too.",
];

/// Whether every target is met.
pub fn run(args: &Args) -> bool {
    let bench = Bench::new();
    if !args.no_install && !bench.install() {
        return false;
    }
    let mut table = Rows::default();
    let wanted = |task| args.only.is_empty() || args.only.contains(&task);
    let well = bench.measure(args.rounds.max(1), &wanted, &mut table);
    println!();
    let measured = Measured::default()
        .table(table.table)
        .lines(table.left_out)
        .lines(well.as_ref().err().cloned())
        .lines(NOTES.map(String::from));
    let written = args.page.show(
        None,
        &measured,
        "peers",
        "Other programs and the library on the same tasks",
    );
    well.is_ok() && !table.missed && written
}

struct Bench {
    scripts: PathBuf,
    folder: PathBuf,
}

impl Bench {
    fn new() -> Bench {
        Bench {
            scripts: root().join("tests/peers"),
            folder: root().join("target/peers"),
        }
    }

    fn install(&self) -> bool {
        println!(
            "Needed: Python 3 and the packages of tests/peers/requirements.txt (MuJoCo, Pinocchio, SciPy,"
        );
        println!(
            "numba, pycma: some 600 MB). Installing them into target/peers/venv where they are not there yet."
        );
        let venv = self.folder.join("venv");
        let mut pip = Command::new(venv.join("bin/pip"));
        pip.args(["install", "--quiet", "-r"])
            .arg(self.scripts.join("requirements.txt"));
        (venv.join("bin/python").is_file()
            || succeeds(Command::new("python3").args(["-m", "venv"]).arg(&venv)))
            && succeeds(&mut pip)
            && self.install_drake()
    }

    /// Drake has no package for every system: its rows are left out there.
    fn install_drake(&self) -> bool {
        let mut pip = Command::new(self.folder.join("venv/bin/pip"));
        pip.args(["install", "--quiet", "-r"])
            .arg(self.scripts.join("requirements-drake.txt"));
        if !succeeds(&mut pip) {
            println!("Drake cannot be installed here: its rows are left out.");
        }
        true
    }

    /// Runs a script on files of the folder; its JSON.
    fn script(&self, name: &str, words: &[&str]) -> Result<Value, String> {
        println!("{name} {}", words.join(" "));
        let output = Command::new(self.folder.join("venv/bin/python"))
            .arg(self.scripts.join(name))
            .args(words)
            .current_dir(&self.folder)
            .output()
            .map_err(|error| format!("cannot run {name}: {error}"))?;
        serde_json::from_slice(&output.stdout).map_err(|_| {
            let complaints = String::from_utf8_lossy(&output.stderr);
            let last = complaints.lines().last().unwrap_or("it said nothing");
            format!("{name} failed: {last}")
        })
    }

    fn log(&self, name: &str, words: &[&str]) -> Result<PathBuf, String> {
        self.script("arm_log.py", &[&[name], words].concat())?;
        Ok(self.folder.join(name))
    }

    fn measure(
        &self,
        rounds: usize,
        wanted: &dyn Fn(Task) -> bool,
        table: &mut Rows,
    ) -> Result<(), String> {
        if wanted(Task::Dynamics) {
            self.dynamics(rounds, table)?;
            self.trees(rounds, table)?;
        }
        if wanted(Task::ClosedLoop) {
            self.closed_loop(rounds, table)?;
        }
        if wanted(Task::Gains) {
            self.gains(rounds, table)?;
        }
        if wanted(Task::Fits) {
            self.fits(rounds, table)?;
        }
        Ok(())
    }

    fn fits(&self, rounds: usize, table: &mut Rows) -> Result<(), String> {
        let load = |logs: &[PathBuf]| Arm::load(logs).map_err(|error| error.to_string());
        let arm = load(&[self.log("arm.csv", &[])?])?;
        let mut pairs = Vec::new();
        for _ in 0..rounds {
            let (ours, _) = arm.fit_seconds(3);
            let theirs = number(&self.script("fit_scipy.py", &["arm.csv"])?, &["seconds"]);
            pairs.push((ours, theirs));
        }
        table.faster("fit of 4 parameters: SciPy + numba", &pairs, 1.0);

        let over = load(&[self.log("over.csv", &["--seed", "4", "--over-the-top"])?])?;
        let ours = over.starts(30, 1);
        let theirs = self.script("fit_scipy.py", &["over.csv", "--starts", "30"])?;
        let theirs = number(&theirs, &["converged"]);
        table.add(
            "over the top, starts of 30 that converge: SciPy",
            [
                &ours.converged.to_string(),
                &theirs.to_string(),
                "",
                ">= 27",
            ],
            ours.converged >= 27,
        );

        let names = ["arm1.csv", "arm2.csv", "arm3.csv"];
        let mut logs = Vec::new();
        for (name, seed) in names.iter().zip(["1", "2", "3"]) {
            logs.push(self.log(name, &["--seed", seed])?);
        }
        let three = load(&logs)?;
        for optimizer in ["scipy", "mujoco"] {
            let (ours, said) = three.diagnose_seconds();
            let words = [&["--optimizer", optimizer][..], &names].concat();
            let theirs = number(&self.script("sysid_mujoco.py", &words)?, &["seconds"]);
            let name = format!("diagnosis ({said}): fit by mujoco.sysid, {optimizer}");
            table.faster(&name, &[(ours, theirs)], 0.5);
        }
        Ok(())
    }
}

/// Threads on which closed-loop runs are timed.
const THREADS: usize = 2;

impl Bench {
    /// Runs a second of the paper's closed loop, ideal and with effects, and whether they are the
    /// same runs.
    fn closed_loop(&self, rounds: usize, table: &mut Rows) -> Result<(), String> {
        let rk4 = ("mujoco_rk4", 20.0);
        let rigid = ("rigid, ", Robot::Ideal, [rk4, ("numba", 1.0)]);
        let rubbed = ("mujoco_rk4", 10.0);
        let real = (
            "with effects, ",
            Robot::WithEffects,
            [rubbed, ("numba", 1.0)],
        );
        for (name, robot, peers) in [rigid, real] {
            let mut pairs = vec![Vec::new(); peers.len()];
            let mut off = f64::NAN;
            for _ in 0..rounds {
                let before = runs_per_second(robot, THREADS, 2000);
                let threads = THREADS.to_string();
                let mut arguments = vec!["--threads", &threads];
                if robot == Robot::WithEffects {
                    arguments.push("--effects");
                }
                let theirs = self.script("closed_loop.py", &arguments)?;
                let ours = [before, runs_per_second(robot, THREADS, 2000)];
                for (pairs, (peer, _)) in pairs.iter_mut().zip(peers) {
                    let seconds = 1.0 / number(&theirs, &[peer]);
                    pairs.push((2.0 / (ours[0] + ours[1]), seconds));
                }
                let ours = angles_after(robot, 0.5);
                let theirs = &theirs["half_second_rad"]["mujoco_rk4"];
                off = (0..3)
                    .map(|i| (ours[i] - theirs[i].as_f64().unwrap_or(f64::NAN)).abs())
                    .fold(0.0, f64::max);
            }
            for (pairs, (peer, target)) in pairs.iter().zip(peers) {
                let row = format!("closed-loop run of 5 s, {name}2 threads: {peer}");
                table.faster(&row, pairs, target);
            }
            let row = format!("closed loop, {name}after 0.5 s: farthest off MuJoCo's RK4, rad");
            // MuJoCo's friction is soft near rest.
            let (most, said) = match robot {
                Robot::Ideal => (1e-9, "<= 1e-9"),
                Robot::WithEffects => (1e-2, "<= 1e-2"),
            };
            table.add(&row, ["", "", &format!("{off:.1e}"), said], off <= most);
        }
        Ok(())
    }
}

impl Bench {
    /// DLQR syntheses: times by number of states, and how right the gains of 60 states are.
    fn gains(&self, rounds: usize, table: &mut Rows) -> Result<(), String> {
        let fixture = chain_fixture();
        let fixture = fixture.to_string_lossy();
        let targets = [
            ("scipy", 6, 5.0),
            ("drake", 6, 1.0),
            ("scipy", 20, 1.0),
            ("scipy", 60, 1.0),
            ("drake", 60, 1.0),
        ];
        let mut pairs = vec![Vec::new(); targets.len()];
        let mut theirs = Value::Null;
        for _ in 0..rounds {
            let before = targets.map(|(_, states, _)| dlqr_seconds(states / 2));
            theirs = self.script("dlqr.py", &[&fixture])?;
            for (at, (peer, states, _)) in targets.into_iter().enumerate() {
                let ours = 0.5 * (before[at] + dlqr_seconds(states / 2));
                pairs[at].push((ours, number(&theirs, &[peer, &states.to_string()])));
            }
        }
        let there = |peer: &str| !theirs[peer].is_null();
        for (pairs, (peer, states, target)) in pairs.iter().zip(targets) {
            if there(peer) {
                table.faster(&format!("DLQR, {states} states: {peer}"), pairs, target)
            } else {
                table
                    .left_out
                    .push(format!("{peer} is not installed: its rows are left out"))
            }
        }
        let ours = dlqr_off().unwrap_or(f64::NAN);
        for peer in ["scipy", "drake"].into_iter().filter(|peer| there(peer)) {
            let off = number(&theirs, &[peer, "off"]);
            let cells = [&format!("{ours:.1e}"), &format!("{off:.1e}"), "", "<= 1e-6"];
            let name = format!("K of 60 states, off 60 digits: {peer}");
            table.add(&name, cells.map(|cell: &str| cell), ours <= 1e-6);
        }
        Ok(())
    }
}

/// The number at a place of a script's JSON.
fn number(value: &Value, place: &[&str]) -> f64 {
    let found = place.iter().fold(value, |value, key| &value[*key]);
    found.as_f64().unwrap_or(f64::NAN)
}

struct Rows {
    table: Table,
    /// Peers whose rows are missing, and why.
    left_out: Vec<String>,
    missed: bool,
}

impl Default for Rows {
    fn default() -> Self {
        let mut table = Table::new();
        table.load_preset(UTF8_HORIZONTAL_ONLY);
        table.set_header(["task: peer", "ours", "theirs", "ratio", "target", ""]);
        Rows {
            table,
            left_out: Vec::new(),
            missed: false,
        }
    }
}

impl Rows {
    fn add(&mut self, name: &str, [ours, theirs, ratio, target]: [&str; 4], met: bool) {
        self.missed |= !met;
        let verdict = if met { "met" } else { "MISSED" };
        self.table
            .add_row([name, ours, theirs, ratio, target, verdict]);
    }

    /// Pairs of seconds, ours and theirs, taken in turns; theirs must take at least `target` times
    /// as long.
    fn faster(&mut self, name: &str, pairs: &[(f64, f64)], target: f64) {
        let ours = median(pairs.iter().map(|pair| pair.0));
        let theirs = median(pairs.iter().map(|pair| pair.1));
        let ratio = median(pairs.iter().map(|pair| pair.1 / pair.0));
        let cells = [
            format!("{ours:.3e}"),
            format!("{theirs:.3e}"),
            format!("{ratio:.1}"),
            format!(">= {target}"),
        ];
        self.add(name, cells.each_ref().map(String::as_str), ratio >= target);
    }
}

fn median(values: impl Iterator<Item = f64>) -> f64 {
    let mut values: Vec<f64> = values.collect();
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(f64::NAN)
}
