//! The saved cases of every fuzz target, as they are and damaged a little: `cargo xtask fuzz` looks
//! further.

use handstand_fuzz::{TARGETS, Target, corpus};
use std::collections::BTreeSet;
use std::panic::{AssertUnwindSafe, catch_unwind};

/// Bytes put in place of others: those with a meaning in one of the formats.
const BYTES: [u8; 6] = [0, 0xff, b'-', b'"', b'\n', b'9'];
/// Damaged cases of one saved case, at most.
const DAMAGED: usize = 400;

/// Names and contents of the saved cases.
fn saved(target: &Target) -> Vec<(String, Vec<u8>)> {
    let folder = corpus(target);
    let entries = std::fs::read_dir(&folder).unwrap_or_else(|error| panic!("{folder:?}: {error}"));
    let mut cases: Vec<_> = entries
        .map(|entry| entry.unwrap().path())
        .map(|path| (path.display().to_string(), std::fs::read(path).unwrap()))
        .collect();
    cases.sort();
    cases
}

/// The target on these bytes; what it panics with goes on with the case that made it.
fn run(target: &Target, name: &str, bytes: &[u8]) {
    let ran = catch_unwind(AssertUnwindSafe(|| (target.run)(bytes)));
    assert!(ran.is_ok(), "{name}: {:?}", String::from_utf8_lossy(bytes));
}

#[test]
fn every_target_has_saved_cases_and_no_folder_is_without_a_target() {
    let parent = corpus(&TARGETS[0]).parent().unwrap().to_path_buf();
    let folders = std::fs::read_dir(parent).unwrap();
    let folders: BTreeSet<String> = folders
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    let names = TARGETS.iter().map(|target| target.name.to_string());
    assert_eq!(folders, names.collect());
    for target in TARGETS {
        assert!(!saved(target).is_empty(), "{}", target.name);
    }
}

#[test]
fn saved_cases_are_survived() {
    for target in TARGETS {
        for (name, bytes) in saved(target) {
            run(target, &name, &bytes);
        }
    }
}

#[test]
fn beginnings_of_saved_cases_and_single_changed_bytes_are_survived() {
    for target in TARGETS {
        for (name, bytes) in saved(target) {
            let step = (bytes.len() / DAMAGED).max(1);
            for at in (0..bytes.len()).step_by(step) {
                run(target, &name, &bytes[..at]);
                let mut changed = bytes.clone();
                changed[at] = BYTES[at % BYTES.len()];
                run(target, &name, &changed);
            }
        }
    }
}
