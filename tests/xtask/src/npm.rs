//! The npm package that a test needs, under `target`.

use handstand_xtask::program::{self, found};
use handstand_xtask::root;
use std::process::Command;

/// axe-core judges whether pages can be used by everybody.
const PACKAGE: &str = "axe-core@4.10.3";

/// Installs what is not there yet; what cannot be is said, and that check left out.
pub fn all() {
    let wanted_for = "the check of the lab's pages for labels and contrast";
    let folder = root().join("target/npm");
    if folder.join("node_modules/axe-core/axe.min.js").exists() {
        println!("axe-core, for {wanted_for}: here already.");
        return;
    }
    println!("axe-core (npm), for {wanted_for}: installing into target/npm.");
    // npm writes into the nearest folder that has a package.json, which must be this one.
    let made = std::fs::create_dir_all(&folder)
        .and_then(|()| std::fs::write(folder.join("package.json"), "{ \"private\": true }\n"));
    let words = [
        "install",
        "--no-audit",
        "--no-fund",
        "--ignore-scripts",
        PACKAGE,
    ];
    let well = made.is_ok()
        && found(&["npm"])
        && program::run(Command::new("npm").args(words).current_dir(&folder));
    if !well {
        println!("It could not be installed; the check is left out.");
    }
}
