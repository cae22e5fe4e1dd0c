//! Finding a Rust compiler that can build `core` for the AVR.

use std::path::{Path, PathBuf};
use std::process::Command;

/// A compiler, its cargo, and where it came from.
#[derive(Debug, Clone)]
pub struct Toolchain {
    /// Said to people.
    pub name: &'static str,
    cargo: PathBuf,
    rustc: PathBuf,
}

/// The workspace's `rust-version`.
const OLDEST: &str = env!("CARGO_PKG_RUST_VERSION");

/// What to do when there is none.
pub const REMEDY: &str = "install one of:\n  rustup toolchain install nightly --component rust-src, and gcc-avr, binutils-avr, avr-libc\n  apt-get install rustc-web rust-web-src cargo-web gcc-avr binutils-avr avr-libc";

impl Toolchain {
    /// A rustup nightly with its sources, or Debian's `rustc-web` with its; and `avr-gcc` to link.
    ///
    /// # Errors
    /// What is missing, and how to install it.
    pub fn find() -> Result<Toolchain, String> {
        if output(Command::new("avr-gcc").arg("--version")).is_none() {
            return Err(format!("there is no avr-gcc to link with: {REMEDY}"));
        }
        compiler().ok_or_else(|| {
            format!(
                "there is no Rust compiler from {OLDEST} on with the sources of `core` for the AVR: {REMEDY}"
            )
        })
    }

    /// Whether there is a compiler, whatever links.
    pub fn is_there() -> bool {
        compiler().is_some()
    }

    /// Its cargo, set up to use its own compiler only.
    pub fn cargo(&self) -> Command {
        let mut cargo = Command::new(&self.cargo);
        // What runs this may be another toolchain's cargo, which leaves its marks.
        for name in [
            "RUSTUP_TOOLCHAIN",
            "CARGO",
            "CARGO_ENCODED_RUSTFLAGS",
            "RUSTDOC",
            "RUSTC_WRAPPER",
        ] {
            cargo.env_remove(name);
        }
        cargo
            .env("RUSTC", &self.rustc)
            .env("RUSTC_BOOTSTRAP", "1")
            .env("RUSTFLAGS", "-C target-cpu=atmega128");
        cargo
    }
}

fn compiler() -> Option<Toolchain> {
    nightly().or_else(debian)
}

fn nightly() -> Option<Toolchain> {
    let which = |name| {
        let path = output(Command::new("rustup").args(["which", "--toolchain", "nightly", name]))?;
        Some(PathBuf::from(path))
    };
    complete(Toolchain {
        name: "rustup nightly",
        cargo: which("cargo")?,
        rustc: which("rustc")?,
    })
}

fn debian() -> Option<Toolchain> {
    complete(Toolchain {
        name: "Debian's rustc-web",
        cargo: "/usr/bin/cargo".into(),
        rustc: "/usr/bin/rustc".into(),
    })
}

/// The toolchain, if it is not too old, its sources are there and it knows the AVR.
fn complete(toolchain: Toolchain) -> Option<Toolchain> {
    let ask = |words: &[&str]| output(Command::new(&toolchain.rustc).args(words));
    let sysroot = ask(&["--print", "sysroot"])?;
    let library = Path::new(&sysroot).join("lib/rustlib/src/rust/library");
    let knows = ask(&["--print", "target-list"])?
        .lines()
        .any(|line| line == "avr-none");
    let recent = minor(ask(&["--version"])?.strip_prefix("rustc ")?)? >= minor(OLDEST)?;
    let whole =
        recent && knows && library.join("core/Cargo.toml").exists() && toolchain.cargo.exists();
    whole.then_some(toolchain)
}

/// 88 of `1.88.0-nightly (..)`.
fn minor(version: &str) -> Option<u32> {
    version.strip_prefix("1.")?.split('.').next()?.parse().ok()
}

/// What a program prints, if it is there and succeeds.
pub fn output(command: &mut Command) -> Option<String> {
    let output = command
        .output()
        .ok()
        .filter(|output| output.status.success())?;
    Some(String::from_utf8_lossy(&output.stdout).trim().to_string())
}
