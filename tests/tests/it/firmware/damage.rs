//! Power cuts while gains are written, and damaged frames.

use handstand_measure::bench::*;

#[test]
fn a_power_cut_leaves_the_old_or_the_new_gains() {
    let tally = power_cuts(&[0x00, 0xff, 0x5a]);
    assert_eq!(tally.neither, 0, "{tally:?}");
    assert!(tally.cuts > 180 && tally.old > 0, "{tally:?}");
}

#[test]
fn damaged_frames_are_refused() {
    assert_eq!(patterns(4, 1).wrong, 0);
    let flips = bit_flips(12, 10, 2);
    assert_eq!(flips.wrong, 0, "{flips:?}");
    let random = random_bytes(10_000_000, 3);
    assert_eq!(random.critical, 0, "{random:?}");
    assert!(resynchronised(1000, 4) <= 2);
}
