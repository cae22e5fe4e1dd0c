//! The firmware with a plan compiled in.

use handstand::{Error, Result};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// Builds the firmware of the repository at `root` with this plan; the raw binary.
///
/// # Errors
/// There is no repository, no cargo, or the build fails.
pub fn build(root: &Path, plan: &Path) -> Result<PathBuf> {
    if !root.join("firmware/Cargo.toml").exists() {
        return Err(Error::usage(
            format!("{}: here is no source of the firmware", root.display()),
            "run this in Handstand's repository, or name it: --firmware DIR",
        ));
    }
    let plan = plan
        .canonicalize()
        .map_err(|error| Error::file(plan, "read", error))?;
    let output = Command::new("cargo")
        .args(["xtask", "firmware", "--json", "--plan"])
        .arg(&plan)
        .current_dir(root)
        .stderr(Stdio::inherit())
        .output()
        .map_err(|error| {
            Error::device(
                format!("cargo cannot be run: {error}"),
                "install Rust (rustup.rs), or upload to a firmware that runs: leave --flash out",
            )
        })?;
    let said: Option<serde_json::Value> = serde_json::from_slice(&output.stdout).ok();
    let bin = said.and_then(|said| said["bin"].as_str().map(PathBuf::from));
    match bin {
        Some(bin) if output.status.success() => Ok(bin),
        _ => Err(Error::device(
            "the firmware could not be built: cargo's own words are above",
            "`cargo xtask firmware` says which toolchain is missing; or upload to a firmware that \
             runs: leave --flash out",
        )),
    }
}
