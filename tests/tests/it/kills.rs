//! `record` survives `kill -9`: a sample of what `cargo xtask bench-record` does a thousand times.

use super::program;
use handstand_measure::kills::kill_recorders;

#[test]
fn a_killed_recorder_leaves_a_file_that_lacks_a_second_at_most() {
    let tally = kill_recorders(&program(), 32, 4, 7, |_| ()).unwrap();
    println!("{tally:?}");
    assert_eq!((tally.kills, tally.unreadable.len()), (32, 0), "{tally:?}");
    assert!(
        tally.worst_lost_s <= 1.0 && tally.samples > 500,
        "{tally:?}"
    );
    assert!(
        tally.torn > 0,
        "an MCAP file that was killed has no end: {tally:?}"
    );
}
