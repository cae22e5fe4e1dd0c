//! `cargo xtask python`: Python's package, installed as its users install it, and its tests;
//! `cargo xtask wheel`: the file that installs it where there is no compiler.

use handstand_xtask::program;
use handstand_xtask::{cargo, root};
use std::path::PathBuf;
use std::process::Command;

/// The environment of the package and its tests.
fn venv() -> PathBuf {
    root().join("target/python/venv")
}

fn python() -> Command {
    Command::new(venv().join("bin/python"))
}

/// Whether what builds and tests the package is installed.
pub fn is_ready() -> bool {
    let modules = "import maturin, control, ipykernel, mypy, nbclient, numpy, pandas, pytest";
    let output = python().args(["-c", modules]).output();
    output.is_ok_and(|output| output.status.success())
}

/// Installs what builds and tests the package; what cannot be is said.
pub fn install() {
    let wanted_for = "Python's package and its tests";
    if is_ready() {
        println!("maturin, pytest and others, for {wanted_for}: here already.");
        return;
    }
    println!("maturin, pytest and others (PyPI), for {wanted_for}: installing into target/python.");
    let list = root().join("host/python/requirements-test.txt");
    let pip = ["-m", "pip", "install", "--quiet", "--requirement"];
    let well = program::run(
        Command::new("python3")
            .args(["-m", "venv", "--clear"])
            .arg(venv()),
    ) && program::run(python().args(pip).arg(list));
    if !well {
        println!("They could not be installed; these tests are skipped.");
    }
}

/// Builds the package, installs it and runs its tests; whether all passed. The tests hold its
/// answers against those of the command, which cargo builds first.
pub fn run() -> bool {
    if !is_ready() {
        install();
    }
    let program = std::env::current_exe().map(|own| own.with_file_name("handstand"));
    program::run(&mut cargo(&["test", "--workspace", "--no-run", "--quiet"]))
        && is_ready()
        && program::run(
            python()
                .args(["-m", "pip", "install", "--quiet", "--force-reinstall"])
                .args(["--no-deps", "--no-build-isolation"])
                // The profile of the other tests: what they built serves here too.
                .arg("--config-settings=build-args=--profile=dev")
                .arg(root().join("host/python"))
                .env("PATH", with_own_programs()),
        )
        && program::run(
            python()
                .args(["-m", "pytest", "-q", "-p", "no:cacheprovider"])
                .arg(root().join("host/python/tests"))
                .env("PYTHONDONTWRITEBYTECODE", "1")
                .env("HANDSTAND", program.unwrap_or_default()),
        )
}

/// Builds the package, optimised, as a wheel; whether that went well.
pub fn wheel() -> bool {
    if !is_ready() {
        install();
    }
    let maturin = ["-m", "maturin", "build", "--release", "--manifest-path"];
    is_ready()
        && program::run(
            python()
                .args(maturin)
                .arg(root().join("host/python/Cargo.toml"))
                .arg("--out")
                .arg(root().join("target/wheels"))
                .env("PATH", with_own_programs()),
        )
}

/// The path, with the environment's programs first: pip calls `maturin`.
fn with_own_programs() -> std::ffi::OsString {
    let path = std::env::var_os("PATH").unwrap_or_default();
    let folders = std::iter::once(venv().join("bin")).chain(std::env::split_paths(&path));
    std::env::join_paths(folders).unwrap_or(path)
}
