//! The checklist on a simulated CM-5, sound and not.

use super::*;
use crate::link::virtual_cm5::{Cm5Port, SimLink, set_up, spec};

/// Who confirms nothing and allows torque.
struct Absent;

impl Person for Absent {
    fn confirms(&mut self, _title: &str, _how: &str) -> Result<(Option<bool>, String)> {
        Ok((None, String::new()))
    }

    fn allows_torque(&mut self, _id: u8) -> Result<bool> {
        Ok(true)
    }

    fn hear(&mut self, _result: &StepResult) {}
}

fn of(text: &str, ids: &[u8]) -> Vec<StepResult> {
    let bus = set_up(&spec(text).unwrap()).unwrap();
    bring_up(&mut SimLink(Cm5Port::new(bus)), ids, &mut Absent).unwrap()
}

fn outcome<'a>(results: &'a [StepResult], id: &str) -> (StepOutcome, &'a str) {
    let result = results.iter().find(|result| result.id == id).unwrap();
    (result.outcome, &result.found)
}

#[test]
fn a_sound_robot_passes_all_that_the_line_can_check() {
    let results = of("ids=1-18,delay=0", &[1]);
    for (step, result) in STEPS.iter().zip(&results) {
        let expected = match step.kind {
            StepKind::ByHand => StepOutcome::NotDone,
            StepKind::Measured(_) => StepOutcome::Passed,
        };
        assert_eq!(result.outcome, expected, "{result:?}");
    }
    assert!(
        outcome(&results, "link-loss")
            .1
            .contains("log: the link was lost")
    );
    let page = markdown("sim-cm5", &results);
    assert_eq!(page.matches("| passed |").count(), 8, "{page}");
}

#[test]
fn what_is_wrong_fails_its_own_step() {
    for (text, ids, failing) in [
        (
            "ids=1-18,delay=0,supply=8.0",
            &[1][..],
            &["supply", "torque", "link-loss"][..],
        ),
        ("ids=1-18,delay=0,dead=2", &[1, 2], &["servos"]),
        (
            "ids=1-18,delay=254",
            &(1..=18).collect::<Vec<u8>>(),
            &["ticks"],
        ),
        ("ids=1-18,delay=0,hot=1", &[1], &["torque", "link-loss"]),
        // Arming writes a torque limit, which ends an overload of before.
        ("ids=1-18,delay=0,overload=1", &[1], &[]),
    ] {
        let results = of(text, ids);
        for result in &results {
            let fails = result.outcome == StepOutcome::Failed;
            assert_eq!(fails, failing.contains(&result.id), "{text}: {result:?}");
        }
    }
}
