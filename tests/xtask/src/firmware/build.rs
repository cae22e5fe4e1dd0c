//! Building the program: ELF, Intel HEX and the raw bytes a boot loader takes.

use super::toolchain::Toolchain;
use crate::root;
use std::path::{Path, PathBuf};
use std::process::Command;

/// The files of one build, beside each other.
#[derive(Debug, Clone)]
pub struct Built {
    /// With symbols, for simavr and debuggers.
    pub elf: PathBuf,
    /// For avrdude.
    pub hex: PathBuf,
    /// For the CM-5's boot loader.
    pub bin: PathBuf,
    /// The control law alone, for the bench.
    pub law: PathBuf,
}

impl Built {
    fn at(folder: &Path) -> Self {
        let file = |ending| folder.join("handstand-firmware").with_extension(ending);
        Built {
            elf: file("elf"),
            hex: file("hex"),
            bin: file("bin"),
            law: folder.join("law.elf"),
        }
    }
}

/// Where builds go: a folder of their own, for another compiler would spoil the host's.
fn folder() -> PathBuf {
    root().join("target/avr")
}

/// Where the files are put, apart by whether a plan is in them: tests rely on the plain ones.
fn files(has_plan: bool) -> PathBuf {
    folder().join(if has_plan { "with-plan" } else { "plain" })
}

/// The last build without a plan, if there is one.
pub fn find_built() -> Option<Built> {
    let built = Built::at(&files(false));
    built.elf.exists().then_some(built)
}

/// Builds it, with a plan compiled in if one is given. The first time the register definitions are
/// generated too, which takes minutes.
///
/// # Errors
/// What failed; the compiler's own messages go to stderr.
pub fn build(toolchain: &Toolchain, plan: Option<&Path>) -> Result<Built, String> {
    let mut cargo = toolchain.cargo();
    cargo.current_dir(root()).args([
        "build",
        "--locked",
        "--package",
        "handstand-firmware",
        "--bins",
        "--profile",
        "avr",
        "--target",
        "avr-none",
        "-Zbuild-std=core",
        "--target-dir",
    ]);
    match plan.map(Path::canonicalize) {
        // The firmware's build script reads it.
        Some(Ok(plan)) => cargo.env("HANDSTAND_PLAN", plan),
        Some(Err(error)) => return Err(format!("the plan cannot be read: {error}")),
        None => cargo.env_remove("HANDSTAND_PLAN"),
    };
    let status = cargo.arg(folder()).status();
    if !status.is_ok_and(|status| status.success()) {
        return Err(format!("{} could not build the firmware", toolchain.name));
    }
    let made = Built::at(&folder().join("avr-none/avr"));
    let built = Built::at(&files(plan.is_some()));
    put(&made.elf, &built.elf)?;
    put(&made.law, &built.law)?;
    objcopy(&built.elf, &built.hex, "ihex")?;
    objcopy(&built.elf, &built.bin, "binary")?;
    Ok(built)
}

/// A copy of a file, its folder included.
fn put(from: &Path, to: &Path) -> Result<(), String> {
    let failed = |error: std::io::Error| format!("{}: {error}", to.display());
    to.parent()
        .map_or(Ok(()), std::fs::create_dir_all)
        .map_err(failed)?;
    std::fs::copy(from, to).map_err(failed)?;
    Ok(())
}

fn objcopy(elf: &Path, to: &Path, format: &str) -> Result<(), String> {
    let mut objcopy = Command::new("avr-objcopy");
    // The EEPROM, if the ELF ever has any, is no part of the flash.
    objcopy.args(["-O", format, "-R", ".eeprom", "-R", ".fuse", "-R", ".lock"]);
    match objcopy.arg(elf).arg(to).status() {
        Ok(status) if status.success() => Ok(()),
        _ => Err("avr-objcopy (Debian: binutils-avr) failed".into()),
    }
}
