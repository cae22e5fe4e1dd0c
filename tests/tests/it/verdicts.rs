//! A sample of `cargo xtask verdicts`: what `gains` says of a robot, against a simulation that
//! shares no equation and no step with the library's.

use handstand_measure::verdicts::judge;
use handstand_measure::verdicts::robot::{NonIdeality, Robot};

/// The paper's weights hold the robot with a late drive that they know of, and not the one whose
/// shoulder has a dead zone; both simulations say so.
#[test]
fn both_simulations_say_the_same() {
    let late = judge(Robot::paper(NonIdeality::Delay(0.012)), 10, 1).unwrap();
    assert!(late.gains && late.stands(), "{late:?}");
    let deaf = judge(Robot::paper(NonIdeality::DeadZone(1, 0.2, 0.0)), 10, 2).unwrap();
    assert!(!deaf.gains && !deaf.stands(), "{deaf:?}");
    assert!(late.agrees() && deaf.agrees());
}
