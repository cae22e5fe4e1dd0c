//! Says which commit this is built from, and whether simavr is there, as the crate over it found.

use std::path::{Path, PathBuf};
use std::process::Command;

fn main() {
    println!("cargo::rustc-env=HANDSTAND_VERSION={}", version());
    println!("cargo::rustc-check-cfg=cfg(simavr)");
    println!("cargo::rerun-if-env-changed=DEP_HANDSTAND_SIMAVR_AVAILABLE");
    if std::env::var_os("DEP_HANDSTAND_SIMAVR_AVAILABLE").is_some() {
        println!("cargo::rustc-cfg=simavr");
    }
}

/// Version of the project, with the commit where one is known, asked again when a source that is
/// built into the measuring program or the commit changes.
fn version() -> String {
    let crates = std::fs::read_dir("../../host")
        .into_iter()
        .flatten()
        .flatten();
    let crates = crates.map(|entry| entry.path().join("src"));
    let others = [
        "src",
        "../../host/src",
        "../../shared/src",
        "../../firmware/src",
    ]
    .map(PathBuf::from);
    for sources in crates.filter(|folder| folder.is_dir()).chain(others) {
        println!("cargo::rerun-if-changed={}", sources.display());
    }
    let moves = git(&["rev-parse", "--git-path", "logs/HEAD"]);
    // What is named and not there would be built again every time.
    if let Some(moves) = moves.filter(|moves| Path::new(moves).exists()) {
        println!("cargo::rerun-if-changed={moves}");
    }
    let version = env!("CARGO_PKG_VERSION");
    match git(&["describe", "--always", "--dirty"]) {
        Some(commit) => format!("{version} ({commit})"),
        None => version.to_string(),
    }
}

fn git(words: &[&str]) -> Option<String> {
    let said = Command::new("git").args(words).output().ok()?;
    let said = said.status.success().then_some(said.stdout)?;
    Some(String::from_utf8(said).ok()?.trim().to_string())
}
