//! A sample of `cargo xtask first-hour`: from a drawn rig's logs to a better model, by commands and
//! by the lab's pages.

use super::program;
use handstand_measure::first_hour::{DrawnRig, DriveKind, End, Hidden, Walk, walk, walk_in_lab};
use std::time::Duration;

fn walked(seed: u64) -> (Hidden, End) {
    let rig = DrawnRig::draw(seed);
    let folder = tempfile::tempdir().unwrap();
    let walk = walk(&program(), &rig, folder.path(), "200s").unwrap();
    (rig.hidden, walk.end)
}

/// Springs that mass and inertia, both guessed, or a scale of the encoder nearly take the place of;
/// a dead zone whose width does not show beside its punch, at one link and at two, where friction
/// hides behind it; a delay whose drive's figures are guessed; friction behind goals, read in
/// counts whose number a turn is not named; a short pendulum that the air brakes; two links that
/// swing freely, one of which rubs.
#[test]
fn first_models_lead_to_what_is_hidden() {
    let found = [1, 6, 7, 11, 12, 25].map(|seed| (seed, false));
    let rubbing = [5, 18].map(|seed| (seed, true));
    for (seed, in_first_model) in found.into_iter().chain(rubbing) {
        let (hidden, end) = walked(seed);
        let expected = if in_first_model {
            End::InFirstModel
        } else {
            End::Found
        };
        assert_eq!(end, expected, "seed {seed}, {hidden:?}");
    }
}

/// Of each drive a rig: a spring, a dead zone, a delay, an offset, air. What was added leaves what
/// noise and resolution leave.
#[test]
fn the_labs_pages_lead_there_too() {
    for (seed, drive) in [
        (6, DriveKind::Torque),
        (7, DriveKind::Duty),
        (3, DriveKind::Position),
        (19, DriveKind::Speed),
        (25, DriveKind::Passive),
    ] {
        let rig = DrawnRig::draw(seed);
        assert_eq!(rig.drive, drive);
        let folder = tempfile::tempdir().unwrap();
        let walk = walk_in_lab(&program(), &rig, folder.path(), Duration::from_secs(200)).unwrap();
        let Walk {
            end,
            error_mrad: [Some(before), Some(after)],
            floor_mrad: Some(floor),
            ..
        } = &walk
        else {
            panic!("seed {seed}, {:?}: {walk:?}", rig.hidden);
        };
        assert_eq!(*end, End::Found, "seed {seed}, {:?}: {walk:?}", rig.hidden);
        assert!(*before > 3.0 * floor, "seed {seed}: {walk:?}");
        assert!(*after < 1.3 * floor, "seed {seed}: {walk:?}");
    }
}
