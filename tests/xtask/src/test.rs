//! `cargo xtask test`: everything that must hold; at its end what failed, by name, and `N passed, N
//! failed`.
//!
//! First says and installs what the builds need; `--no-install` leaves that out. Then each check of
//! the sources counts as one test, as does the firmware's build, and every test of the workspace as
//! one. The firmware is built, and what only the tests need installed, beside the checks: either
//! alone keeps one core waiting.

use super::checks::CHECKS;
use super::install;
use super::lane::Lane;
use super::python_package;
use handstand_xtask::cargo;
use handstand_xtask::firmware::Toolchain;
use handstand_xtask::program::{self, overheard};
use std::path::Path;
use std::time::Instant;

/// Tests at a time: of libtest.
const TEST_THREADS: &str = "RUST_TEST_THREADS";

/// Half the time of a test is spent waiting: for a timer, a line, a child.
const THREADS_PER_CORE: usize = 2;

/// Install what the tests need, then run all of them.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// Install nothing
    #[arg(long)]
    no_install: bool,
}

/// Goes on after a failure; whether all passed.
pub fn run(args: &Args) -> bool {
    let mut clock = Clock::start();
    if !args.no_install {
        install::for_builds();
        clock.lap("installing for the builds");
    }
    let install = (!args.no_install).then(|| Lane::start(&["install", "--only-tests"]));
    let firmware = firmware();
    let mut tally = Tally::default();
    for (name, holds) in CHECKS {
        tally.count(holds(), name);
        clock.lap(name);
    }
    program::run(&mut cargo(&["test", "--workspace", "--no-run"]));
    clock.lap("building the tests");
    // The tests that follow find the firmware's ELF, and what was installed.
    if let Some(firmware) = firmware {
        tally.count(firmware.end(), "cargo xtask firmware");
    }
    if let Some(install) = install {
        install.end();
    }
    clock.lap("waiting for the firmware and the installation");
    let python = python_package();
    tests(&mut tally);
    clock.lap("running the tests");
    if let Some(python) = python {
        tally.count(python.end(), "cargo xtask python");
        clock.lap("waiting for Python's package and its tests");
    }
    clock.tell();
    tally.tell();
    tally.failed == 0
}

/// Begins to build the firmware, if that can be.
fn firmware() -> Option<Lane> {
    if !Path::new("/usr/include/simavr/sim_avr.h").exists() {
        println!("SKIPPED: the tests of the firmware's ELF, for simavr is not installed");
    }
    match Toolchain::find() {
        Ok(_) => Some(Lane::start(&["firmware"])),
        Err(why) => {
            println!("SKIPPED: the firmware for the AVR, and with it the tests of its ELF: {why}");
            None
        }
    }
}

/// Begins to build Python's package and to run its tests, if that can be.
fn python_package() -> Option<Lane> {
    if python_package::is_ready() {
        return Some(Lane::start(&["python"]));
    }
    println!("SKIPPED: Python's package and its tests, for what they need is not installed");
    None
}

/// Seconds of each phase, told at the end.
struct Clock {
    last: Instant,
    laps: Vec<(String, f64)>,
}

impl Clock {
    fn start() -> Clock {
        Clock {
            last: Instant::now(),
            laps: Vec::new(),
        }
    }

    fn lap(&mut self, name: &str) {
        self.laps
            .push((name.into(), self.last.elapsed().as_secs_f64()));
        self.last = Instant::now();
    }

    fn tell(&self) {
        println!("\nSeconds:");
        for (name, seconds) in &self.laps {
            println!("{seconds:7.1}  {name}");
        }
        println!(
            "{:7.1}  in all",
            self.laps.iter().map(|lap| lap.1).sum::<f64>()
        );
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
        if well {
            self.passed += 1
        } else {
            self.failed += 1;
            self.failures.push(name.into());
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

fn tests(tally: &mut Tally) {
    let failed_before = tally.failed;
    let mut tests = cargo(&["test", "--workspace", "--no-fail-fast"]);
    if std::env::var_os(TEST_THREADS).is_none() {
        let cores = std::thread::available_parallelism().map_or(1, |cores| cores.get());
        tests.env(TEST_THREADS, (THREADS_PER_CORE * cores).to_string());
    }
    let mut in_failures = false;
    let well = overheard(&mut tests, |line| {
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
