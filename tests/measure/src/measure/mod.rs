//! The chores that measure. A new one is a file, a line in [`Chore`] and an arm in [`Chores::run`].

mod ablation;
mod bench_firmware;
mod bench_lab;
mod bench_read;
#[cfg(unix)]
mod bench_record;
mod conventions;
mod detection;
mod discover;
mod first_hour;
mod hidden;
mod journal;
mod measured;
mod next;
mod page;
mod peers;
mod program;
mod real;
mod refit;
mod robot_demo;
mod scatter;
mod spoiled;
mod verdicts;
#[cfg(unix)]
mod virtual_cm5;
mod within;

use clap::{Parser, Subcommand};
use handstand_measure::measured::in_project;
use handstand_xtask::root;
use std::process::ExitCode;

/// The project's chores that measure.
#[derive(Debug, Parser)]
#[command(name = "cargo xtask", bin_name = "cargo xtask")]
pub struct Chores {
    #[command(subcommand)]
    chore: Chore,
}

#[derive(Debug, Subcommand)]
enum Chore {
    /// Measure other programs and the library on the same tasks
    Peers(peers::Args),
    /// Measure how often hidden effects are named, missed and invented
    Hidden(hidden::Args),
    /// Measure how weak an effect may be and still be named
    Detection(detection::Args),
    /// Measure how often a law that the library lacks is discovered, and how often one is invented
    Discover(discover::Args),
    /// Renew the pages of docs/measured that take minutes, and name the commands of the others
    Measured(measured::Args),
    /// Measure whether a limited time gives the verdict of the whole search
    Within(within::Args),
    /// Measure what each part of the search for missing effects brings
    Ablation(ablation::Args),
    /// Measure how often one proposed experiment settles an ambiguous diagnosis
    Next(next::Args),
    /// Walk the README's path on drawn rigs
    FirstHour(first_hour::Args),
    /// Diagnose public logs of real rigs
    Real(real::Args),
    /// Measure whether `add` and `fit` leave no more than diagnoses, and hold the truth
    Refit(refit::Args),
    /// Balance virtual robots before and after they were measured
    RobotDemo(robot_demo::Args),
    /// Measure whether a joint's wrong sign, zero or unit is told of an arm in space
    Conventions(conventions::Args),
    /// Spoil logs in every way, and measure what the check finds
    Spoiled(spoiled::Args),
    /// Measure whether verdicts on designs agree with other simulations and with `balance`
    Verdicts(verdicts::Args),
    /// Measure the firmware: cycles, times, losses and frames
    BenchFirmware(bench_firmware::Args),
    /// Measure how soon the lab answers
    BenchLab(bench_lab::Args),
    /// Measure how soon an hour's logs are read, and in how much memory
    BenchRead(bench_read::Args),
    /// Kill recorders, and read what is left of their files
    #[cfg(unix)]
    BenchRecord(bench_record::Args),
    /// Offer the firmware, in simavr or in process, as a serial port
    #[cfg(unix)]
    Virtual(virtual_cm5::Args),
}

impl Chores {
    /// Does the chore; fails if any of it failed.
    pub fn run(&self) -> ExitCode {
        if let Err(why) = writable() {
            eprintln!("{why}");
            return ExitCode::FAILURE;
        }
        let well = match &self.chore {
            Chore::Peers(args) => peers::run(args),
            Chore::Hidden(args) => hidden::run(args),
            Chore::Detection(args) => detection::run(args),
            Chore::Discover(args) => discover::run(args),
            Chore::Measured(args) => measured::run(args),
            Chore::Within(args) => within::run(args),
            Chore::Ablation(args) => ablation::run(args),
            Chore::Next(args) => next::run(args),
            Chore::FirstHour(args) => first_hour::run(args),
            Chore::Real(args) => real::run(args),
            Chore::Refit(args) => refit::run(args),
            Chore::RobotDemo(args) => robot_demo::run(args),
            Chore::Spoiled(args) => spoiled::run(args),
            Chore::Conventions(args) => conventions::run(args),
            Chore::Verdicts(args) => verdicts::run(args),
            Chore::BenchFirmware(args) => bench_firmware::run(args),
            Chore::BenchLab(args) => bench_lab::run(args),
            Chore::BenchRead(args) => bench_read::run(args),
            #[cfg(unix)]
            Chore::BenchRecord(args) => bench_record::run(args),
            #[cfg(unix)]
            Chore::Virtual(args) => virtual_cm5::run(args),
        };
        if well {
            ExitCode::SUCCESS
        } else {
            ExitCode::FAILURE
        }
    }
}

/// Refuses, before anything is measured, to write a page whose command would name a path outside of
/// the project.
fn writable() -> Result<(), String> {
    let mut words = std::env::args().skip(1);
    if !words.any(|word| word == "--write") {
        return Ok(());
    }
    let mut words = std::env::args().skip(1);
    words.try_for_each(|word| in_project(&word, root()).map(drop))
}
