//! The targets with libFuzzer around them: `HANDSTAND_FUZZ_TARGET` names the one to run, the
//! arguments are libFuzzer's.
//!
//! libFuzzer brings `main`. One program for all targets, for each would link the library again.
#![no_main]

use handstand_fuzz::{TARGETS, Target, named};
use std::sync::LazyLock;

static TARGET: LazyLock<&'static Target> = LazyLock::new(|| {
    let name = std::env::var("HANDSTAND_FUZZ_TARGET").unwrap_or_default();
    named(&name).unwrap_or_else(|| {
        let names: Vec<_> = TARGETS.iter().map(|target| target.name).collect();
        eprintln!("HANDSTAND_FUZZ_TARGET must be one of {}", names.join(", "));
        std::process::exit(2)
    })
});

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| (TARGET.run)(bytes));
