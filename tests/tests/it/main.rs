//! Benchmarks sampled, the firmware run, the guides followed. One test program: each more would
//! link the library again.

mod contributing;
mod dependencies;
#[cfg(all(unix, simavr))]
mod deploy;
mod discover;
mod firmware;
mod first_hour;
mod fuzz;
mod hidden;
mod import;
mod intervals;
#[cfg(unix)]
mod kills;
mod mjcf;
mod next;
mod simulators;
mod space;
mod space_export;
mod space_gains;
mod space_gains_told;
mod space_linear;
mod space_names;
mod space_next;
mod space_payload;
mod space_search;
mod space_view;
mod spoiled;
mod verdicts;

/// The program that the workspace's build left beside the tests.
fn program() -> std::path::PathBuf {
    let here = std::env::current_exe().unwrap();
    let program = here.ancestors().nth(2).unwrap().join("handstand");
    assert!(program.exists(), "build it first: cargo build -p handstand");
    program
}
