//! `cargo xtask bench-record`: recorders killed a thousand times; no file may be lost, nor more than a second of any.

use handstand_tests::kills::kill_recorders;
use handstand_xtask::{cargo, program};
use std::path::PathBuf;

/// Kill recorders, and read what is left
#[derive(Debug, clap::Args)]
pub struct Args {
    /// How many
    #[arg(long, default_value_t = 1000)]
    kills: usize,
    /// How many run at once
    #[arg(long, default_value_t = 8, value_parser = clap::value_parser!(u64).range(1..=64))]
    at_once: u64,
    /// Seed of the moments
    #[arg(long, default_value_t = 1)]
    seed: u64,
}

/// Whether every file was read and lost a second at most.
pub fn run(args: &Args) -> bool {
    let Some(program) = built() else {
        eprintln!("handstand could not be built");
        return false;
    };
    let told = |done: usize| {
        if done.is_multiple_of(50) {
            eprintln!("{done} of {}", args.kills);
        }
    };
    match kill_recorders(&program, args.kills, args.at_once as usize, args.seed, told) {
        Ok(tally) => {
            for why in &tally.unreadable {
                println!("{why}");
            }
            println!(
                "{} recorders killed: {} files unreadable, {} torn, at most {:.3} s lost of one (limit 1), {} samples read",
                tally.kills,
                tally.unreadable.len(),
                tally.torn,
                tally.worst_lost_s,
                tally.samples
            );
            tally.unreadable.is_empty() && tally.worst_lost_s <= 1.0
        }
        Err(why) => {
            eprintln!("{why}");
            false
        }
    }
}

/// The program beside this one.
fn built() -> Option<PathBuf> {
    let here = std::env::current_exe().ok()?;
    let mut cargo = cargo(&[
        "build",
        "--release",
        "--package",
        "handstand",
        "--bin",
        "handstand",
    ]);
    program::run(&mut cargo).then(|| here.with_file_name("handstand"))
}
