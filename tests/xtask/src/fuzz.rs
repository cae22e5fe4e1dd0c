//! `cargo xtask fuzz`: mutates the saved cases of every parser, guided by coverage, for some
//! seconds each.
//!
//! libFuzzer needs no nightly compiler: the pass that counts edges is part of every rustc, and the
//! parsers are safe Rust, so that no sanitizer is needed. A case that makes a target panic, hang or
//! eat memory is kept under `target/fuzz/found`; put it into `tests/fuzz/corpus`, and the tests
//! fail until the parser is mended.

use handstand_xtask::{cargo, program, root};
use std::path::{Path, PathBuf};
use std::process::Command;

/// Fuzz the parsers with libFuzzer.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// Only these targets, folders of tests/fuzz/corpus; all of them without
    targets: Vec<String>,
    /// Seconds for each target
    #[arg(long, default_value_t = 20)]
    seconds: u64,
    /// Replace the saved corpus by the fewest cases that cover as much
    #[arg(long)]
    save: bool,
}

/// Counts edges and follows comparisons.
const FLAGS: &str = "-Cpasses=sancov-module -Cllvm-args=-sanitizer-coverage-level=4 \
    -Cllvm-args=-sanitizer-coverage-inline-8bit-counters \
    -Cllvm-args=-sanitizer-coverage-pc-table -Cllvm-args=-sanitizer-coverage-trace-compares";

/// Longest case, bytes: recordings and models are a few thousand.
const LONGEST: u32 = 16_384;
/// What a single case may take, s and MB; no parser needs a hundredth of either.
const LIMITS: [&str; 2] = ["-timeout=10", "-rss_limit_mb=2048"];

/// Whether no target failed.
pub fn run(args: &Args) -> bool {
    let saved = root().join("tests/fuzz/corpus");
    let known = match folders(&saved) {
        Ok(known) => known,
        Err(error) => {
            eprintln!("{}: {error}", saved.display());
            return false;
        }
    };
    if let Some(unknown) = args.targets.iter().find(|name| !known.contains(name)) {
        eprintln!(
            "there is no target `{unknown}`; there are: {}",
            known.join(", ")
        );
        return false;
    }
    let Some(engine) = built() else {
        return false;
    };
    let wanted = |name: &&String| args.targets.is_empty() || args.targets.contains(name);
    let mut failed = Vec::new();
    for name in known.iter().filter(wanted) {
        let well = fuzz(&engine, name, &saved.join(name), args.seconds);
        if !well {
            failed.push(name.as_str());
        } else if args.save && !save(&engine, name, &saved.join(name)) {
            eprintln!("{name}: the corpus could not be reduced; it is as it was");
        }
    }
    if failed.is_empty() {
        println!("\nNo target failed.")
    } else {
        println!(
            "\nFailed: {}. The cases lie in target/fuzz/found; copy each into tests/fuzz/corpus/TARGET.",
            failed.join(", ")
        )
    }
    failed.is_empty()
}

/// Names of the folders within one, in order.
fn folders(within: &Path) -> std::io::Result<Vec<String>> {
    let entries = std::fs::read_dir(within)?.filter_map(Result::ok);
    let mut names: Vec<String> = entries
        .filter(|entry| entry.path().is_dir())
        .map(|entry| entry.file_name().to_string_lossy().into_owned())
        .collect();
    names.sort();
    Ok(names)
}

fn folder(name: &str) -> PathBuf {
    root().join("target/fuzz").join(name)
}

/// The engine with all targets, built with coverage in a folder of its own.
fn built() -> Option<PathBuf> {
    let host = host()?;
    // With a target named, build scripts and procedural macros are left without the counters.
    // The checks of the development profile stay on; its programs are optimised.
    let mut cargo = cargo(&[
        "build",
        "--package",
        "handstand-fuzz",
        "--features",
        "engine",
    ]);
    cargo
        .args(["--bin", "fuzz", "--target", &host, "--target-dir"])
        .arg(folder("build"))
        .env("RUSTFLAGS", FLAGS);
    let program = folder("build").join(&host).join("debug/fuzz");
    program::run(&mut cargo).then_some(program)
}

/// The triple of the machine that compiles.
fn host() -> Option<String> {
    let output = Command::new("rustc").arg("-vV").output().ok()?;
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    let line = text.lines().find_map(|line| line.strip_prefix("host: "))?;
    Some(line.to_string())
}

/// The engine on a target; nothing but its failures is said.
fn engine(program: &Path, name: &str) -> Command {
    let mut command = Command::new(program);
    command.env("HANDSTAND_FUZZ_TARGET", name).args(LIMITS);
    command.args([format!("-max_len={LONGEST}"), "-verbosity=0".into()]);
    command
}

fn fuzz(program: &Path, name: &str, saved: &Path, seconds: u64) -> bool {
    let (grown, found) = (folder("corpus").join(name), folder("found"));
    if let Err(error) =
        std::fs::create_dir_all(&grown).and_then(|()| std::fs::create_dir_all(&found))
    {
        eprintln!("{}: {error}", grown.display());
        return false;
    }
    let mut command = engine(program, name);
    command
        .arg(format!("-max_total_time={seconds}"))
        .arg(format!("-artifact_prefix={}/{name}-", found.display()))
        .arg("-print_final_stats=1")
        .args([&grown, &saved.to_path_buf()]);
    program::run(&mut command)
}

/// Puts the fewest cases that cover what all cover in place of the saved ones.
fn save(program: &Path, name: &str, saved: &Path) -> bool {
    let least = folder("least").join(name);
    let _ = std::fs::remove_dir_all(&least);
    let made = std::fs::create_dir_all(&least);
    let mut command = engine(program, name);
    command
        .arg("-merge=1")
        .arg(&least)
        .args([saved.to_path_buf(), folder("corpus").join(name)]);
    made.is_ok() && program::run(&mut command) && replace(saved, &least).is_ok()
}

fn replace(saved: &Path, by: &Path) -> std::io::Result<()> {
    for case in std::fs::read_dir(saved)? {
        std::fs::remove_file(case?.path())?;
    }
    for case in std::fs::read_dir(by)? {
        let case = case?;
        std::fs::copy(case.path(), saved.join(case.file_name()))?;
    }
    Ok(())
}
