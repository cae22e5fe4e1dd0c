//! The checklist on a simulated CM-5, sound and not.

use super::*;
use crate::virtual_cm5::{Cm5Port, SimLink, set_up, spec};

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
    for (results, open) in [(absent, "aref"), (denied, "charger"), (low, "supply")] {
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

fn result(results: &[StepResult], id: &str) -> StepResult {
    let found = results.iter().find(|result| result.id == id);
    found.expect("a step of that name").clone()
}

/// Boards that deviate: each gets an honest answer, with its number, and torque all the same.
#[test]
fn what_nobody_publishes_is_measured() {
    let of_gap = |text: &str| {
        let results = of(text, &[1]);
        assert_eq!(outcome(&results, "torque").0, StepOutcome::Passed, "{text}");
        let gap = result(&results, "gap");
        (gap.outcome, gap.value.expect("a number"))
    };
    // The line's own: a byte of 57600 baud.
    let (outcome_of, gap_us) = of_gap("ids=1-18,delay=0");
    assert_eq!(outcome_of, StepOutcome::Passed);
    assert!((gap_us - 163.6).abs() < 0.1, "{gap_us}");
    // A byte more on the line is 173.6 us.
    for (needs_us, least_us) in [(150, 163.6), (300, 337.2), (1000, 1031.7)] {
        let (outcome_of, gap_us) = of_gap(&format!("ids=1-18,delay=0,write_us={needs_us}"));
        let is_passed = needs_us < 200;
        assert_eq!(outcome_of == StepOutcome::Passed, is_passed, "{needs_us}");
        assert_eq!(
            outcome_of == StepOutcome::Deviates,
            !is_passed,
            "{needs_us}"
        );
        assert!((gap_us - least_us).abs() < 0.5, "{needs_us}: {gap_us}");
    }
}

#[test]
fn the_rate_is_that_of_the_bus() {
    let all: Vec<u8> = (1..=18).collect();
    for (text, ids, expected) in [
        ("ids=1-18,delay=0", &all[..], StepOutcome::Passed),
        // 200 us of return delay each.
        ("ids=1-6,delay=100", &all[..6], StepOutcome::Deviates),
        ("ids=1-18,delay=0,drop=0.3", &all[..], StepOutcome::Failed),
    ] {
        let rate = result(&of(text, ids), "rate");
        assert_eq!(rate.outcome, expected, "{text}: {rate:?}");
        assert!(rate.value.is_some_and(|per_s| per_s > 90.0), "{rate:?}");
    }
}

/// What a boot loader leaves of the reset's flags, and what a person measured.
#[test]
fn flags_and_what_a_person_says_are_told_as_numbers() {
    for (flags, expected) in [(1, StepOutcome::Passed), (0, StepOutcome::Deviates)] {
        let bus = set_up(&spec("ids=1-18,delay=0").unwrap()).unwrap();
        let mut port = Cm5Port::new(bus);
        port.set_reset_cause(flags);
        let mut person = Present { denies: "nothing" };
        let results = bring_up(&mut SimLink(port), &[1], &mut person).unwrap();
        let told = result(&results, "reset-flags");
        assert_eq!(
            (told.outcome, told.value),
            (expected, Some(f64::from(flags)))
        );
        assert!(!told.otherwise.is_empty());
        assert_eq!(outcome(&results, "torque").0, StepOutcome::Passed);
        let page = markdown("sim-cm5", &results);
        assert_eq!(page.contains("DEVIATES"), flags == 0, "{page}");
    }
    assert_eq!(number("yes, 48.5 ms"), Some(48.5));
    assert_eq!(number("yes"), None);
}

#[test]
fn what_is_wrong_fails_its_own_step() {
    for (text, ids, failing) in [
        ("ids=1-18,delay=0,supply=8.0", &[1][..], &["supply"][..]),
        ("ids=1-18,delay=0,dead=2", &[1, 2], &["servos", "rate"]),
        (
            "ids=1-18,delay=254",
            &(1..=18).collect::<Vec<u8>>(),
            &["ticks", "rate"],
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
