//! First power-on of a CM-5: the checklist of `docs/bring-up.md`, what of it the line can check,
//! and what a person has to.
//!
//! Torque comes on with a tenth of its limit, at one servo, which holds its position.

mod checks;
mod steps;
mod unknowns;

pub use steps::{STEPS, StepKind};

use super::port::SerialLink;
use crate::error::Result;
use checks::Found;
use serde::Serialize;
use steps::{Check, Step};

/// What came of a step.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum StepOutcome {
    /// As it should be.
    Passed,
    /// Safe, but not as the firmware was made for: `otherwise` says what to do.
    Deviates,
    /// Not as it should be.
    Failed,
    /// Nobody checked it.
    NotDone,
}

/// A step, and what was found.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct StepResult {
    /// Its name, as in the checklist.
    pub id: &'static str,
    /// What has to be so.
    pub title: &'static str,
    /// What came of it.
    pub outcome: StepOutcome,
    /// What was found, or what the person said.
    pub found: String,
    /// What is expected.
    pub expected: &'static str,
    /// The number that was found or said, if there is one.
    pub value: Option<f64>,
    /// Its unit.
    pub unit: &'static str,
    /// What to do where it is not so.
    pub otherwise: &'static str,
}

impl StepOutcome {
    /// Whether torque may come on after it.
    fn lets_torque(self) -> bool {
        matches!(self, StepOutcome::Passed | StepOutcome::Deviates)
    }
}

impl StepResult {
    fn of(step: &Step, found: Found) -> Self {
        StepResult {
            id: step.id,
            title: step.title,
            outcome: found.outcome,
            found: found.text,
            expected: step.expected,
            value: found.value,
            unit: step.unit,
            otherwise: step.otherwise,
        }
    }
}

/// The first number that a person says.
fn number(said: &str) -> Option<f64> {
    let words = said.split(|c: char| !(c.is_ascii_digit() || ".-".contains(c)));
    words.into_iter().find_map(|word| word.parse().ok())
}

/// Who answers for what the line cannot check.
pub trait Person {
    /// Whether it is as `instruction` wants it; none where it was not checked. What was said beside
    /// it is for the report.
    fn confirms(&mut self, title: &str, instruction: &str) -> Result<(Option<bool>, String)>;
    /// Whether this servo may get a tenth of its torque now.
    fn allows_torque(&mut self, id: u8) -> Result<bool>;
    /// Hears what was found before the next step begins.
    fn hear(&mut self, result: &StepResult);
}

/// Walks through the checklist with the servos `ids`, of which the first gets torque.
///
/// # Errors
/// The port failed, or the person cannot be asked. A step that fails is a result, no error.
pub fn bring_up<L: SerialLink>(
    link: &mut L,
    ids: &[u8],
    person: &mut dyn Person,
) -> Result<Vec<StepResult>> {
    let mut results = Vec::new();
    for step in STEPS {
        let found = match step.kind {
            StepKind::ByHand => {
                let (is_so, said) = person.confirms(step.title, step.instruction)?;
                let outcome = match is_so {
                    Some(true) => StepOutcome::Passed,
                    Some(false) => StepOutcome::Failed,
                    None => StepOutcome::NotDone,
                };
                Found {
                    outcome,
                    value: number(&said),
                    text: said,
                }
            }
            StepKind::Measured(check) => match stops(check, &results) {
                Some(earlier) => Found {
                    outcome: StepOutcome::NotDone,
                    ..Found::of(false, &earlier)
                },
                None => checks::measured(check, link, ids, person)?,
            },
        };
        let result = StepResult::of(step, found);
        person.hear(&result);
        results.push(result);
    }
    Ok(results)
}

/// Why a step that gives torque is not done: an earlier one, which has to stop the robot, did not
/// pass.
fn stops(check: Check, results: &[StepResult]) -> Option<String> {
    let open = (results.iter()).find(|result| !result.outcome.lets_torque())?;
    let why = match open.outcome {
        StepOutcome::Failed => "failed",
        _ => "is not done",
    };
    let earlier = format!(
        "no torque before every earlier step passed: `{}` {why}",
        open.id
    );
    check.gives_torque().then_some(earlier)
}

/// The results as a page in Markdown, for the robot's papers.
pub fn markdown(port: &str, results: &[StepResult]) -> String {
    let mut text = format!(
        "# Bring-up of the CM-5 at {port}\n\n| Step | | Found | Expected |\n|---|---|---|---|\n"
    );
    for result in results {
        let outcome = match result.outcome {
            StepOutcome::Passed => "passed",
            StepOutcome::Deviates => "DEVIATES",
            StepOutcome::Failed => "FAILED",
            StepOutcome::NotDone => "not done",
        };
        let found = result.found.replace('|', "/").replace('\n', " ");
        let expected = match result.outcome {
            StepOutcome::Deviates | StepOutcome::Failed => {
                format!("{}; otherwise: {}", result.expected, result.otherwise)
            }
            StepOutcome::Passed | StepOutcome::NotDone => result.expected.to_string(),
        };
        text += &format!("| {} | {outcome} | {found} | {expected} |\n", result.title);
    }
    text
}

#[cfg(test)]
#[cfg(feature = "virtual-cm5")]
mod tests;
