//! `cargo xtask mutants`: are the tests of `shared` and `firmware` such that they fail when the
//! code is wrong?
//!
//! cargo-mutants changes the code in every way it knows and runs the tests in process, without the
//! random steps of the invariants, which alone take half a minute; `.cargo/mutants.toml` has those
//! that change nothing a test could see, each with the reason. `listed` has mutants that are kept
//! by hand, those of assembler and registers on the ELF. Each runs in a copy of the tree. Fails
//! where fewer than 97 % of the viable mutants are caught, or a listed one survives.

mod listed;
mod trial;

use handstand_xtask::{program, root};
use listed::{Bench, LISTED};
use serde_json::{Value, json};
use std::path::Path;
use std::process::Command;
use std::time::{Duration, Instant};
use trial::{Copy, Verdict};

/// Find code that no test misses.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// Only the listed mutants
    #[arg(long)]
    listed: bool,
    /// Only the listed mutants whose name holds this
    #[arg(long, requires = "listed")]
    only: Option<String>,
    /// Leave out those that need the ELF in simavr
    #[arg(long)]
    logic: bool,
    /// Only this part of cargo-mutants' mutants, such as 1/8
    #[arg(long, value_name = "K/N")]
    shard: Option<String>,
    /// Only mutants of lines that changed since this commit
    #[arg(long, value_name = "COMMIT")]
    since: Option<String>,
    /// Print the outcomes as JSON
    #[arg(long)]
    json: bool,
}

/// Least share of the viable mutants that must be caught.
const CAUGHT: f64 = 0.97;

/// Whether enough were caught.
pub fn run(args: &Args) -> bool {
    let begun = Instant::now();
    let listed = match of_list(args) {
        Ok(listed) => listed,
        Err(why) => {
            eprintln!("{why}");
            return false;
        }
    };
    let survived: Vec<&str> = (listed.iter())
        .filter(|(_, verdict)| *verdict != Verdict::Caught)
        .map(|(name, _)| *name)
        .collect();
    let made = if args.listed {
        None
    } else {
        match of_cargo_mutants(args.shard.as_deref(), args.since.as_deref()) {
            Ok(made) => Some(made),
            Err(why) => {
                eprintln!("{why}");
                return false;
            }
        }
    };
    show(args, &listed, made.as_ref(), begun.elapsed());
    survived.is_empty() && made.is_none_or(|made| made.share() >= CAUGHT)
}

type Listed = Vec<(&'static str, Verdict)>;

fn of_list(args: &Args) -> Result<Listed, String> {
    let wanted = |name: &str| args.only.as_ref().is_none_or(|only| name.contains(only));
    let chosen = LISTED
        .iter()
        .filter(|mutant| wanted(mutant.name) && !(args.logic && mutant.bench == Bench::Elf));
    let copy = Copy::of_tree()?;
    let mut verdicts = Vec::new();
    for mutant in chosen {
        let verdict = copy.try_out(mutant)?;
        eprintln!("{}: {}", mutant.name, verdict.word());
        verdicts.push((mutant.name, verdict));
    }
    Ok(verdicts)
}

/// What cargo-mutants counted.
struct Made {
    caught: usize,
    missed: Vec<String>,
    timeout: Vec<String>,
    unviable: usize,
}

impl Made {
    /// Share of the viable ones that were caught; one that runs for ever is noticed, too.
    fn share(&self) -> f64 {
        let noticed = self.caught + self.timeout.len();
        noticed as f64 / (noticed + self.missed.len()).max(1) as f64
    }
}

/// What changed of the firmware and what it shares since a commit, as a file.
fn changes(since: &str, file: &Path) -> Result<(), String> {
    let diff = Command::new("git")
        .current_dir(root())
        .args(["diff", since, "--", "firmware/src", "shared/src"])
        .output()
        .map_err(|error| format!("git cannot be run: {error}"))?;
    if !diff.status.success() {
        let why = String::from_utf8_lossy(&diff.stderr).into_owned();
        return Err(format!("git knows no changes since {since}: {why}"));
    }
    if diff.stdout.is_empty() {
        return Err(format!(
            "nothing of firmware and shared changed since {since}: name an earlier commit"
        ));
    }
    let refused = |error| format!("{}: {error}", file.display());
    std::fs::create_dir_all(file.parent().unwrap_or(file)).map_err(refused)?;
    std::fs::write(file, diff.stdout).map_err(refused)
}

fn of_cargo_mutants(shard: Option<&str>, since: Option<&str>) -> Result<Made, String> {
    if !program::found(&["cargo-mutants"]) {
        return Err(
            "cargo-mutants is missing: `cargo install cargo-mutants --locked`; --listed \
                    does without"
                .to_string(),
        );
    }
    let folder = root().join("target/mutants");
    let mut command = Command::new("cargo");
    command
        .current_dir(root())
        .args(["mutants", "--output"])
        .arg(&folder);
    command.args(["-p", "handstand-shared", "-p", "handstand-firmware"]);
    // The firmware's logic is tested on the simulated board.
    command.args([
        "--test-package",
        "handstand-shared,handstand-firmware,handstand-cm5-sim",
    ]);
    // Neither is compiled for the PC.
    command.args([
        "--exclude",
        "firmware/src/atmega128/**",
        "--exclude",
        "shared/src/law/avr.rs",
    ]);
    command.args([
        "--exclude",
        "firmware/src/bin/**",
        "--exclude",
        "firmware/src/main.rs",
    ]);
    // The tests take 4 s, on a busy machine a few times that; a clock that stands still none ends.
    command.args(["--timeout", "30", "--jobs"]);
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    command.arg(cores.to_string());
    if let Some(since) = since {
        let file = folder.join("changes.diff");
        changes(since, &file)?;
        command.arg("--in-diff").arg(file);
    }
    if let Some(shard) = shard {
        command.args(["--shard", shard]);
    }
    command.args([
        "--cargo-test-arg=--tests",
        "--",
        "--",
        "--skip",
        "invariant",
    ]);
    // It fails where one is missed; what it counted says how many.
    program::run(&mut command);
    outcomes(&folder.join("mutants.out/outcomes.json"))
}

fn outcomes(file: &Path) -> Result<Made, String> {
    let name = file.display();
    let text = std::fs::read_to_string(file).map_err(|error| format!("{name}: {error}"))?;
    let value: Value = serde_json::from_str(&text).map_err(|error| format!("{name}: {error}"))?;
    let outcomes = value["outcomes"].as_array();
    let outcomes = outcomes.ok_or_else(|| format!("{name}: there are no `outcomes`"))?;
    let of = |summary: &str| -> Vec<String> {
        let those = outcomes.iter().filter(|it| it["summary"] == summary);
        those
            .map(|it| {
                it["scenario"]["Mutant"]["name"]
                    .as_str()
                    .unwrap_or("?")
                    .to_string()
            })
            .collect()
    };
    Ok(Made {
        caught: of("CaughtMutant").len(),
        missed: of("MissedMutant"),
        timeout: of("Timeout"),
        unviable: of("Unviable").len(),
    })
}

fn show(args: &Args, listed: &Listed, made: Option<&Made>, took: Duration) {
    let minutes = took.as_secs_f64() / 60.0;
    if args.json {
        let listed: Vec<Value> = (listed.iter())
            .map(|(name, verdict)| json!({ "name": name, "outcome": verdict.word() }))
            .collect();
        let made = made.map(|made| {
            json!({
                "caught": made.caught, "missed": made.missed, "timeout": made.timeout,
                "unviable": made.unviable, "caught_share": made.share(),
            })
        });
        println!(
            "{}",
            json!({ "listed": listed, "made": made, "minutes": minutes })
        );
        return;
    }
    let caught = listed
        .iter()
        .filter(|(_, verdict)| *verdict == Verdict::Caught);
    println!("Listed: {} of {} caught", caught.count(), listed.len());
    if let Some(made) = made {
        made.missed
            .iter()
            .for_each(|name| println!("missed: {name}"));
        // A busy machine is slow, too: who doubts it tries these again.
        made.timeout
            .iter()
            .for_each(|name| println!("took too long: {name}"));
        println!(
            "cargo-mutants: {} caught, {} missed, {} timeouts, {} not viable; {:.1} % caught, at \
             least {:.0} % wanted",
            made.caught,
            made.missed.len(),
            made.timeout.len(),
            made.unviable,
            100.0 * made.share(),
            100.0 * CAUGHT
        );
    }
    println!("It took {minutes:.1} minutes.");
}
