//! `cargo xtask test`: everything that must hold; at its end what failed, by name, and `N passed, N failed`.
//!
//! First says and installs what is needed; `--no-install` leaves that out. Then formatting, lints and
//! documentation count as one test each, as does the firmware's build, and every test of the workspace as one.

use super::{image, install};
use handstand_xtask::cargo;
use handstand_xtask::firmware::Toolchain;
use handstand_xtask::program::{self, overheard};
use std::path::Path;

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
        let well = program::run(check.env("RUSTDOCFLAGS", "-D warnings"));
        tally.count(well, &format!("cargo {}", words[0]));
    }
    firmware(&mut tally);
    tests(&mut tally);
    tally.tell();
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
        Ok(_) => tally.count(image::run(&image::Args::default()), "cargo xtask firmware"),
        Err(why) => println!("SKIPPED, and with it the tests of its ELF: {why}"),
    }
    if !Path::new("/usr/include/simavr/sim_avr.h").exists() {
        println!("SKIPPED: the tests of the firmware's ELF, for simavr is not installed");
    }
}

#[derive(Debug, Default)]
struct Tally {
    passed: usize,
    failed: usize,
    /// What failed, by name, and what the tests among it printed.
    failures: Vec<String>,
}

impl Tally {
    fn count(&mut self, well: bool, name: &str) {
        match well {
            true => self.passed += 1,
            false => {
                self.failed += 1;
                self.failures.push(name.into());
            }
        }
    }

    /// Repeats the failures, which else lie far up, and counts.
    fn tell(&self) {
        if !self.failures.is_empty() {
            println!("\nWhat failed:\n{}", self.failures.join("\n"));
        }
        println!("\n{} passed, {} failed", self.passed, self.failed);
    }
}

fn install() {
    println!("Needed: the crates in Cargo.lock. Fetching them where they are not here yet.");
    program::run(&mut cargo(&["fetch", "--locked"]));
    install::all();
}

fn tests(tally: &mut Tally) {
    let failed_before = tally.failed;
    let words = ["test", "--workspace", "--no-fail-fast"];
    let mut in_failures = false;
    let well = overheard(&mut cargo(&words), |line| {
        // Between this line and the result lies what the failed tests printed, then their names.
        in_failures |= line == "failures:";
        if let Some((passed, failed)) = result(line) {
            tally.passed += passed;
            tally.failed += failed;
            in_failures = false;
        }
        if in_failures {
            tally.failures.push(line.into());
        }
    });
    // What did not even compile has no line of its own.
    if !well && tally.failed == failed_before {
        tally.count(false, "cargo test: did not compile, or was killed");
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
