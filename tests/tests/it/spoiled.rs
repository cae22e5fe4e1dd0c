//! A sample of `cargo xtask spoiled`: the right remedy on spoiled logs, silence on good ones.

use handstand::challenge::Motions;
use handstand_measure::spoiled::{Answer, Spoiling, bundled, judge, simulated, unspoiled};

#[test]
fn a_spoiled_arm_gets_the_right_remedy() {
    let rig = simulated(Motions::Arm, "coulomb", 1).unwrap();
    for spoiling in [Spoiling::PositionSign(0), Spoiling::Milliseconds] {
        let outcome = judge(&rig, spoiling);
        assert_eq!(outcome.answer, Answer::Right, "{outcome:#?}");
    }
}

#[test]
fn spoiled_joints_of_a_chain_are_told_apart() {
    let rig = simulated(Motions::Hanging, "viscous", 2).unwrap();
    let outcome = judge(&rig, Spoiling::PositionSign(1));
    assert_eq!(outcome.answer, Answer::Right, "{outcome:#?}");
}

#[test]
fn logs_as_they_are_raise_no_alarm() {
    let arms = [
        "delay",
        "base_tilt",
        "encoder_zero",
        "torque_scale",
        "backlash",
    ];
    let rigs = arms
        .into_iter()
        .zip(1..)
        .filter_map(|(kind, seed)| simulated(Motions::Arm, kind, seed));
    for rig in rigs.chain([bundled().unwrap()]) {
        let outcome = unspoiled(&rig);
        assert_eq!(outcome.answer, Answer::Right, "{outcome:#?}");
    }
}

#[test]
fn a_free_pendulum_mirrored_cannot_be_told_and_is_not_accused() {
    let outcome = judge(&bundled().unwrap(), Spoiling::PositionSign(0));
    assert_eq!(outcome.answer, Answer::Unseen, "{outcome:#?}");
}
