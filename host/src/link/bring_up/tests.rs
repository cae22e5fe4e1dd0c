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

/// Who confirms all but one step and allows torque.
struct Present<'a> {
    denies: &'a str,
}

impl Person for Present<'_> {
    fn confirms(&mut self, title: &str, _how: &str) -> Result<(Option<bool>, String)> {
        Ok((Some(!title.contains(self.denies)), String::new()))
    }

    fn allows_torque(&mut self, _id: u8) -> Result<bool> {
        Ok(true)
    }

    fn hear(&mut self, _result: &StepResult) {}
}

fn of(text: &str, ids: &[u8]) -> Vec<StepResult> {
    with(text, ids, &mut Present { denies: "nothing" })
}

fn with(text: &str, ids: &[u8], person: &mut dyn Person) -> Vec<StepResult> {
    let bus = set_up(&spec(text).unwrap()).unwrap();
    bring_up(&mut SimLink(Cm5Port::new(bus)), ids, person).unwrap()
}

fn outcome<'a>(results: &'a [StepResult], id: &str) -> (StepOutcome, &'a str) {
    let result = results.iter().find(|result| result.id == id).unwrap();
    (result.outcome, &result.found)
}

#[test]
fn a_sound_robot_passes_all_that_the_line_can_check() {
    let results = of("ids=1-18,delay=0", &[1]);
    for result in &results {
        assert_eq!(result.outcome, StepOutcome::Passed, "{result:?}");
    }
    assert!(outcome(&results, "goal").1.contains("it does"));
    let limits = "it holds limits of 102 and 1023";
    assert!(outcome(&results, "torque").1.contains(limits));
    assert!(
        outcome(&results, "link-loss")
            .1
            .contains("log: the link was lost")
    );
    let page = markdown("sim-cm5", &results);
    assert_eq!(page.matches("| passed |").count(), STEPS.len(), "{page}");
}

/// Whether it failed or was not checked: what would stop the robot is not known to work.
#[test]
fn no_torque_before_every_earlier_step_passed() {
    let sound = "ids=1-18,delay=0";
    let absent = with(sound, &[1], &mut Absent);
    let denied = with(sound, &[1], &mut Present { denies: "charger" });
    let low = of("ids=1-18,delay=0,supply=8.0", &[1]);
    for (results, open) in [(absent, "fuses"), (denied, "charger"), (low, "supply")] {
        for step in STEPS {
            let StepKind::Measured(check) = step.kind else {
                continue;
            };
            let (outcome, found) = outcome(&results, step.id);
            if check.gives_torque() {
                assert_eq!(outcome, StepOutcome::NotDone, "{}", step.id);
                assert!(found.contains(&format!("`{open}`")), "{found}");
            } else {
                let expected = step.id != open;
                assert_eq!(outcome == StepOutcome::Passed, expected, "{}", step.id);
            }
        }
    }
}

#[test]
fn what_is_wrong_fails_its_own_step() {
    for (text, ids, failing) in [
        ("ids=1-18,delay=0,supply=8.0", &[1][..], &["supply"][..]),
        ("ids=1-18,delay=0,dead=2", &[1, 2], &["servos"]),
        (
            "ids=1-18,delay=254",
            &(1..=18).collect::<Vec<u8>>(),
            &["ticks"],
        ),
        ("ids=1-18,delay=0,hot=1", &[1], &["torque"]),
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
