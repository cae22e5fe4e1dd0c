//! Building the program: ELF, Intel HEX and the raw bytes a boot loader takes.

use super::toolchain::Toolchain;
use crate::root;
use handstand_shared::crc::extend32;
use handstand_shared::image::mark;
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
    let target = std::env::var_os("CARGO_TARGET_DIR");
    root()
        .join(target.unwrap_or_else(|| "target".into()))
        .join("avr")
}

/// Where the files are put, apart by whether a plan is in them: tests rely on the plain ones.
fn files(has_plan: bool) -> PathBuf {
    folder().join(if has_plan { "with-plan" } else { "plain" })
}

/// Beside the files of a build: [`fingerprint`] of the sources it was made from.
const SOURCES: &str = "sources.crc";

/// The last build without a plan.
///
/// # Errors
/// There is none, or the sources have changed since; with the remedy.
pub fn find_built() -> Result<Built, String> {
    let folder = files(false);
    let built = Built::at(&folder);
    if !built.elf.exists() {
        let elf = built.elf.display();
        return Err(format!(
            "{elf} is missing: `cargo xtask firmware` builds it"
        ));
    }
    let made_from = std::fs::read_to_string(folder.join(SOURCES)).unwrap_or_default();
    if made_from == fingerprint() {
        Ok(built)
    } else {
        Err(format!(
            "{} is older than its sources: `cargo xtask firmware` builds it again",
            built.elf.display()
        ))
    }
}

/// CRC-32 over the names and contents of all sources of the program: times of files say nothing
/// after a checkout.
fn fingerprint() -> String {
    let mut crc = u32::MAX;
    for folder in ["firmware", "shared"] {
        for name in ["Cargo.toml", "build.rs", "src"] {
            crc = with_file(crc, &root().join(folder).join(name));
        }
    }
    format!("{:08x}", !crc)
}

/// Goes on with a CRC-32 over a file, or all files of a folder in the order of their names.
fn with_file(crc: u32, path: &Path) -> u32 {
    let mut inside: Vec<PathBuf> = std::fs::read_dir(path)
        .map(|entries| entries.flatten().map(|entry| entry.path()).collect())
        .unwrap_or_default();
    inside.sort();
    let name = path.file_name().map(|name| name.to_string_lossy());
    let crc = extend32(crc, name.unwrap_or_default().as_bytes());
    let crc = extend32(crc, &std::fs::read(path).unwrap_or_default());
    inside.iter().fold(crc, |crc, path| with_file(crc, path))
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
    let sources = fingerprint();
    let status = cargo.arg(folder()).status();
    if !status.is_ok_and(|status| status.success()) {
        return Err(format!("{} could not build the firmware", toolchain.name));
    }
    let made = Built::at(&folder().join("avr-none/avr"));
    let built = Built::at(&files(plan.is_some()));
    put(&made.elf, &built.elf)?;
    put(&made.law, &built.law)?;
    objcopy(&built.elf, &built.bin, &["-O", "binary"])?;
    put_mark(&built.bin)?;
    objcopy(&built.bin, &built.hex, &["-I", "binary", "-O", "ihex"])?;
    // Last: without it the files do not count as built.
    let stamp = files(plan.is_some()).join(SOURCES);
    std::fs::write(&stamp, sources).map_err(|error| format!("{}: {error}", stamp.display()))?;
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

/// Puts the mark behind a program, without which it is not flashed.
fn put_mark(bin: &Path) -> Result<(), String> {
    let failed = |error: std::io::Error| format!("{}: {error}", bin.display());
    let mut program = std::fs::read(bin).map_err(failed)?;
    program.extend(mark(&program));
    std::fs::write(bin, program).map_err(failed)
}

fn objcopy(from: &Path, to: &Path, formats: &[&str]) -> Result<(), String> {
    let mut objcopy = Command::new("avr-objcopy");
    // The EEPROM, if the ELF ever has any, is no part of the flash.
    objcopy
        .args(formats)
        .args(["-R", ".eeprom", "-R", ".fuse", "-R", ".lock"]);
    match objcopy.arg(from).arg(to).status() {
        Ok(status) if status.success() => Ok(()),
        _ => Err("avr-objcopy (Debian: binutils-avr) failed".into()),
    }
}
