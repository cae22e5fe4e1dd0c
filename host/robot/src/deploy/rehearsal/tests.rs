//! Rehearsals of plans for the paper's robot.

use super::*;
use crate::deploy::{Board, PlanBasis, ToldDrives};
use crate::synth::controllers::BoardTiming;
use std::path::Path;

/// The paper's robot on drives of 2 N m, with these effects at all of them.
fn robot(kind: &str, values: &str) -> Model {
    let effect = format!("[[effect]]\nkind = \"{kind}\"\njoint = \"all\"\n{values}\n");
    let text = include_str!("../basis/robot.toml").replace("# effects", &effect);
    Model::parse(&text, Path::new("robot.toml")).unwrap()
}

fn rehearsed(robot: &Model, believed: &Model) -> (Rehearsal, Plan) {
    let (board, timing) = (Board::BIOLOID, BoardTiming::HOST_ATTITUDE);
    let basis = PlanBasis::of(believed, &board, &timing, &ToldDrives::default()).unwrap();
    let plan = basis.plan(believed).unwrap();
    (
        Rehearsal::of(robot, &plan, &Setting::default(), 1).unwrap(),
        plan,
    )
}

/// The plan for a late drive holds the robot that has it; that of the clean model does not.
#[test]
fn a_late_drive_is_held_by_the_plan_that_knows_of_it() {
    let late = robot("delay", "delay_s = 0.018");
    let clean = Model {
        effects: Vec::new(),
        ..late.clone()
    };
    let (knows, plan) = rehearsed(&late, &late);
    assert!(knows.holds, "{}", knows.words(&plan));
    let (ignores, plan) = rehearsed(&late, &clean);
    assert_eq!(ignores.stood, 0);
    let words = ignores.words(&plan);
    assert!(
        words.contains("does NOT hold this robot: 0 of 10"),
        "{words}"
    );
}

/// The same twice, and other starts by another seed.
#[test]
fn a_seed_is_one_rehearsal() {
    let weak = robot("torque_scale", "factor = 0.7");
    let (first, plan) = rehearsed(&weak, &weak);
    let again = Rehearsal::of(&weak, &plan, &Setting::default(), 1).unwrap();
    assert_eq!(first.attempts[0].samples, again.attempts[0].samples);
    let other = Rehearsal::of(&weak, &plan, &Setting::default(), 2).unwrap();
    assert_ne!(first.attempts[0].samples, other.attempts[0].samples);
}
