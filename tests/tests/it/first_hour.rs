//! A sample of `cargo xtask first-hour`: from a drawn rig's logs to a better model.

use super::program;
use handstand_tests::first_hour::{DrawnRig, End, Hidden, walk};

fn walked(seed: u64) -> (Hidden, End) {
    let rig = DrawnRig::draw(seed);
    let folder = tempfile::tempdir().unwrap();
    let walk = walk(&program(), &rig, folder.path(), "200s").unwrap();
    (rig.hidden, walk.end)
}

/// A spring that mass and inertia, both guessed, nearly take the place of; a dead zone whose width
/// does not show beside its punch; a delay whose drive's figures are guessed; friction behind
/// goals, read in counts whose number a turn is not named; a short pendulum that the air brakes.
#[test]
fn first_models_lead_to_what_is_hidden() {
    for (seed, in_first_model) in [(6, false), (7, false), (12, false), (18, true), (25, false)] {
        let (hidden, end) = walked(seed);
        let expected = if in_first_model {
            End::InFirstModel
        } else {
            End::Found
        };
        assert_eq!(end, expected, "seed {seed}, {hidden:?}");
    }
}
