//! A sample of `cargo xtask first-hour`: from a drawn rig's logs to a better model.

use super::program;
use handstand_tests::first_hour::{DrawnRig, End, Hidden, walk};

fn walked(seed: u64) -> (Hidden, End) {
    let rig = DrawnRig::draw(seed);
    let folder = tempfile::tempdir().unwrap();
    let walk = walk(&program(), &rig, folder.path(), "200s").unwrap();
    (rig.hidden, walk.end)
}

/// Springs that mass and inertia, both guessed, or a scale of the encoder nearly take the place of;
/// a dead zone whose width does not show beside its punch, at one link and at two, where friction
/// hides behind it; a delay whose drive's figures are guessed; friction behind goals, read in counts
/// whose number a turn is not named; a short pendulum that the air brakes; two links that swing
/// freely, one of which rubs.
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
