//! Says whether simavr is there, as the crate over it found.

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    println!("cargo::rustc-check-cfg=cfg(simavr)");
    println!("cargo::rerun-if-env-changed=DEP_HANDSTAND_SIMAVR_AVAILABLE");
    if std::env::var_os("DEP_HANDSTAND_SIMAVR_AVAILABLE").is_some() {
        println!("cargo::rustc-cfg=simavr");
    }
}
