//! Builds the shim over libsimavr where its headers are installed; elsewhere the crate is empty and
//! says so.

use std::path::Path;

/// Debian's `libsimavr-dev`.
const HEADER: &str = "/usr/include/simavr/sim_avr.h";

fn main() {
    println!("cargo::rustc-check-cfg=cfg(simavr)");
    println!("cargo::rerun-if-changed={HEADER}");
    println!("cargo::rerun-if-changed=src/shim.c");
    if !Path::new(HEADER).exists() {
        // Packages bring files older than the last build; only what is not there is looked for
        // again.
        println!("cargo::rerun-if-changed={HEADER}.missing");
        return;
    }
    println!("cargo::rustc-cfg=simavr");
    println!("cargo::metadata=available=1");
    cc::Build::new()
        .file("src/shim.c")
        .include("/usr/include/simavr")
        .opt_level(2)
        .warnings(false)
        .compile("simavr_shim");
    println!("cargo::rustc-link-lib=simavr");
}
