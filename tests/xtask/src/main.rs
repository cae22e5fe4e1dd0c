//! `cargo xtask`: the project's own chores. What measures is another program, built when it is
//! asked for: the chores here start at once.

mod checks;
mod fuzz;
mod image;
mod install;
mod lane;
mod mutants;
mod npm;
mod python;
mod python_package;
mod test;

use clap::{Parser, Subcommand};
use handstand_xtask::cargo;
use std::ffi::OsString;
use std::process::ExitCode;

/// The project's own chores.
#[derive(Debug, Parser)]
#[command(name = "cargo xtask", bin_name = "cargo xtask")]
struct Chores {
    #[command(subcommand)]
    chore: Chore,
}

#[derive(Debug, Subcommand)]
enum Chore {
    /// Install what the tests need, then run all of them
    Test(test::Args),
    /// Install what the builds and the tests need, without running them
    Install(install::Args),
    /// Fuzz the parsers with libFuzzer
    Fuzz(fuzz::Args),
    /// Change the firmware's code, and see whether the tests notice
    Mutants(mutants::Args),
    /// Install Python's package in an environment of its own, and run its tests
    Python,
    /// Build Python's package as one wheel for every CPython from 3.10 on, into target/wheels
    Wheel,
    /// Build the CM-5's program: ELF, HEX and BIN
    Firmware(image::Args),
    /// Measure the firmware: cycles, times, losses and frames
    BenchFirmware(Words),
    /// Measure how soon the lab answers
    BenchLab(Words),
    /// Measure how soon an hour's logs are read, and in how much memory
    BenchRead(Words),
    /// Kill recorders, and read what is left of their files
    BenchRecord(Words),
    /// Measure how weak an effect may be and still be named
    Detection(Words),
    /// Measure how often a law that the library lacks is discovered, and how often one is invented
    Discover(Words),
    /// Measure how often hidden effects are named, missed and invented
    Hidden(Words),
    /// Renew the pages of docs/measured that take minutes, and name the commands of the others
    Measured(Words),
    /// Measure other programs and the library on the same tasks
    Peers(Words),
    /// Measure how often one proposed experiment settles an ambiguous diagnosis
    Next(Words),
    /// Walk the README's path on drawn rigs
    FirstHour(Words),
    /// Diagnose public logs of real rigs
    Real(Words),
    /// Measure whether `add` and `fit` leave no more than diagnoses, and hold the truth
    Refit(Words),
    /// Balance virtual robots before and after they were measured
    RobotDemo(Words),
    /// Measure whether a joint's wrong sign, zero or unit is told of an arm in space
    Conventions(Words),
    /// Spoil logs in every way, and measure what the check finds
    Spoiled(Words),
    /// Measure whether verdicts on designs agree with other simulations and with `balance`
    Verdicts(Words),
    /// Offer the firmware, in simavr or in process, as a serial port
    Virtual(Words),
    /// Measure whether a limited time gives a diagnosis the verdict of the whole search
    Within(Words),
    /// Measure what each part of the search for missing effects brings
    Ablation(Words),
}

/// What the measuring program reads for itself.
#[derive(Debug, clap::Args)]
#[command(disable_help_flag = true)]
struct Words {
    /// See --help
    #[arg(trailing_var_arg = true, allow_hyphen_values = true)]
    words: Vec<OsString>,
}

fn main() -> ExitCode {
    let chores = Chores::parse();
    let (name, words) = match chores.chore {
        Chore::Test(args) => return code(test::run(&args)),
        Chore::Install(args) => {
            install::run(&args);
            return ExitCode::SUCCESS;
        }
        Chore::Fuzz(args) => return code(fuzz::run(&args)),
        Chore::Mutants(args) => return code(mutants::run(&args)),
        Chore::Python => return code(python_package::run()),
        Chore::Wheel => return code(python_package::wheel()),
        Chore::Firmware(args) => return code(image::run(&args)),
        Chore::BenchFirmware(words) => ("bench-firmware", words),
        Chore::BenchLab(words) => ("bench-lab", words),
        Chore::BenchRead(words) => ("bench-read", words),
        Chore::BenchRecord(words) => ("bench-record", words),
        Chore::Conventions(words) => ("conventions", words),
        Chore::Detection(words) => ("detection", words),
        Chore::Discover(words) => ("discover", words),
        Chore::Hidden(words) => ("hidden", words),
        Chore::Measured(words) => ("measured", words),
        Chore::Peers(words) => ("peers", words),
        Chore::Next(words) => ("next", words),
        Chore::FirstHour(words) => ("first-hour", words),
        Chore::Real(words) => ("real", words),
        Chore::Refit(words) => ("refit", words),
        Chore::RobotDemo(words) => ("robot-demo", words),
        Chore::Spoiled(words) => ("spoiled", words),
        Chore::Verdicts(words) => ("verdicts", words),
        Chore::Virtual(words) => ("virtual", words),
        Chore::Within(words) => ("within", words),
        Chore::Ablation(words) => ("ablation", words),
    };
    measure(name, &words.words)
}

/// Other programs are met as a library user can build this one at best; all else is measured as
/// `cargo install` builds it.
fn profile(chore: &str) -> &'static str {
    if chore == "peers" { "dist" } else { "release" }
}

/// Builds the measuring program if need be, and becomes it: its exit code is ours.
fn measure(name: &str, words: &[OsString]) -> ExitCode {
    let mut cargo = cargo(&["run", "--profile", profile(name), "--quiet"]);
    cargo.args(["--package", "handstand-measure", "--bin", "measure"]);
    cargo.args(["--", name]).args(words);
    match cargo.status() {
        Ok(status) => {
            let code = status.code().and_then(|code| u8::try_from(code).ok());
            code.map_or(ExitCode::FAILURE, ExitCode::from)
        }
        Err(error) => {
            eprintln!("cargo cannot be run: {error}");
            ExitCode::FAILURE
        }
    }
}

fn code(well: bool) -> ExitCode {
    if well {
        ExitCode::SUCCESS
    } else {
        ExitCode::FAILURE
    }
}
