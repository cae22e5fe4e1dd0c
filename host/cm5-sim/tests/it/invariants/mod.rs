//! The state machine under random commands, times and faults: docs/firmware.md, "Invariants", each
//! checked after every step.
//!
//! Two tests, which run beside each other, of 500 runs of 1000 steps; `PROPTEST_CASES` sets another
//! number of runs.

mod acts;
mod judge;
mod judged;
mod steps;

use handstand_shared::message::{ArmLimits, Mode, VERSION};
use judged::Judged;
use proptest::prelude::*;
use proptest::test_runner::{RngAlgorithm, TestRng, TestRunner};
use proptest_state_machine::{ReferenceStateMachine, StateMachineTest};
use steps::{Step, Steps, Token, Upload};

/// Runs in each of two tests, of [`STEPS`] each.
const RUNS: u32 = 500;
const STEPS: usize = 1000;

/// The servos of the list: those a plan drives, and one more.
const IDS: [u8; 5] = [1, 2, 11, 12, 5];

impl StateMachineTest for Judged {
    type SystemUnderTest = Judged;
    type Reference = Steps;

    fn init_test((): &()) -> Judged {
        Judged::new()
    }

    fn apply(mut judged: Judged, (): &(), step: Step) -> Judged {
        judged.step(&step);
        judged
    }
}

fn the_invariants_hold(seed: u8) {
    let mut config = ProptestConfig {
        failure_persistence: None,
        max_shrink_iters: 300,
        ..ProptestConfig::default()
    };
    if std::env::var_os("PROPTEST_CASES").is_none() {
        config.cases = RUNS;
    }
    let rng = TestRng::from_seed(RngAlgorithm::ChaCha, &[seed; 32]);
    let mut runner = TestRunner::new_with_rng(config.clone(), rng);
    let outcome = runner.run(
        &Steps::sequential_strategy(STEPS),
        |(initial, transitions, seen)| {
            Judged::test_sequential(config.clone(), initial, transitions, seen);
            Ok(())
        },
    );
    if let Err(why) = outcome {
        panic!("{why}");
    }
}

#[test]
fn the_invariants_hold_whatever_happens() {
    the_invariants_hold(1);
}

#[test]
fn the_invariants_hold_whatever_else_happens() {
    the_invariants_hold(2);
}

/// What was found among ten million steps: a greeting while torque falls, a change of the mode that
/// arrives during a tick, and arming, all taken at its end.
#[test]
fn torque_off_and_on_again_between_two_looks_is_a_new_arming() {
    let mut judged = Judged::new();
    let steps = [
        Step::Wait(7.533492278783457),
        Step::Hello(VERSION),
        Step::Wait(12.0),
        Step::Wait(0.0),
        Step::Ready(Mode::Stream),
        Step::Chunk(0, Upload::Part),
        Step::Hello(VERSION),
        Step::Mode(Mode::Stream),
        Step::Wait(70.0),
        Step::Arm(Token::Last, ArmLimits::FULL),
        Step::Wait(150.0),
    ];
    for step in &steps {
        judged.step(step);
    }
    assert!(judged.armed, "it is armed again");
}
