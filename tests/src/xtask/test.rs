//! `cargo xtask test`: everything that must hold, and one closing line: `N passed, N failed`.
//!
//! First says and installs what is needed; `--no-install` leaves that out. Then formatting, lints and
//! documentation count as one test each, as does the firmware's build, and every test of the workspace as one.

use super::firmware;
use super::install;
use super::program::{self, overheard};
use handstand_tests::firmware::Toolchain;
use std::path::Path;
use std::process::Command;

/// Install what the tests need, then run all of them.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// Install nothing
    #[arg(long)]
    no_install: bool,
}

/// Goes on after a failure; whether all passed.
pub fn run(args: &Args) -> bool {
    if !args.no_install {
        install();
    }
    let mut tally = Tally::default();
    for words in CHECKS {
        let mut check = cargo(words);
        tally.count(program::run(check.env("RUSTDOCFLAGS", "-D warnings")));
    }
    firmware(&mut tally);
    tests(&mut tally);
    println!("\n{} passed, {} failed", tally.passed, tally.failed);
    tally.failed == 0
}

const CHECKS: &[&[&str]] = &[
    &["fmt", "--all", "--check"],
    &[
        "clippy",
        "--workspace",
        "--all-targets",
        "--",
        "-D",
        "warnings",
    ],
    &["doc", "--workspace", "--no-deps"],
];

/// Builds the firmware, so that the tests that follow find its ELF.
fn firmware(tally: &mut Tally) {
    println!("\nThe firmware for the AVR:");
    match Toolchain::find() {
        Ok(_) => tally.count(firmware::run(&firmware::Args::default())),
        Err(why) => println!("SKIPPED, and with it the tests of its ELF: {why}"),
    }
    if !handstand_simavr::AVAILABLE && !Path::new("/usr/include/simavr/sim_avr.h").exists() {
        println!("SKIPPED: the tests of the firmware's ELF, for simavr is not installed");
    }
}

#[derive(Debug, Default)]
struct Tally {
    passed: usize,
    failed: usize,
}

impl Tally {
    fn count(&mut self, well: bool) {
        match well {
            true => self.passed += 1,
            false => self.failed += 1,
        }
    }
}

fn cargo(words: &[&str]) -> Command {
    let mut cargo = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    cargo.args(words);
    cargo
}

fn install() {
    println!("Needed: the crates in Cargo.lock. Fetching them where they are not here yet.");
    program::run(&mut cargo(&["fetch", "--locked"]));
    install::all();
}

fn tests(tally: &mut Tally) {
    let failed_before = tally.failed;
    let words = ["test", "--workspace", "--no-fail-fast"];
    let well = overheard(&mut cargo(&words), |line| {
        if let Some((passed, failed)) = result(line) {
            tally.passed += passed;
            tally.failed += failed;
        }
    });
    // What did not even compile has no line of its own.
    if !well && tally.failed == failed_before {
        tally.failed += 1;
    }
}

/// How many passed and failed, of a line `test result: ok. 12 passed; 0 failed; ...`.
fn result(line: &str) -> Option<(usize, usize)> {
    let (_, counts) = line.strip_prefix("test result: ")?.split_once(". ")?;
    let count = |word: &str| {
        let part = counts.split(';').find(|part| part.ends_with(word))?;
        part.trim().split(' ').next()?.parse().ok()
    };
    Some((count(" passed")?, count(" failed")?))
}

#[cfg(test)]
mod tests {
    use super::result;

    #[test]
    fn a_result_line_is_counted_and_others_are_not() {
        let line =
            "test result: FAILED. 12 passed; 3 failed; 1 ignored; 0 measured; 0 filtered out";
        assert_eq!(result(line), Some((12, 3)));
        assert_eq!(result("test a::b ... ok"), None);
    }
}
