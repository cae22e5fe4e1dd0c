//! First power-on of a CM-5: the checklist of `docs/bring-up.md`, what of it the line can check, and
//! what a person has to.
//!
//! Torque comes on with a tenth of its limit, at one servo, which holds its position.

mod checks;
mod steps;

pub use steps::{STEPS, StepKind};

use super::port::SerialLink;
use crate::error::Result;
use serde::Serialize;
use steps::Check;

/// What came of a step.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum StepOutcome {
    /// As it should be.
    Passed,
    /// Not as it should be.
    Failed,
    /// Nobody checked it.
    NotDone,
}

/// A step, and what was found.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct StepResult {
    /// Its name, as in the checklist.
    pub id: &'static str,
    /// What has to be so.
    pub title: &'static str,
    /// What came of it.
    pub outcome: StepOutcome,
    /// What was found, or what the person said.
    pub found: String,
}

/// Who answers for what the line cannot check.
pub trait Person {
    /// Whether it is as `instruction` wants it; none where nobody checked. What was said beside it is
    /// for the report.
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
        let (outcome, found) = match step.kind {
            StepKind::ByHand => {
                let (is_so, said) = person.confirms(step.title, step.instruction)?;
                let outcome = match is_so {
                    Some(true) => StepOutcome::Passed,
                    Some(false) => StepOutcome::Failed,
                    None => StepOutcome::NotDone,
                };
                (outcome, said)
            }
            StepKind::Measured(check) => match stops(check, &results) {
                Some(earlier) => (StepOutcome::NotDone, earlier),
                None => checks::measured(check, link, ids, person)?,
            },
        };
        let result = StepResult {
            id: step.id,
            title: step.title,
            outcome,
            found,
        };
        person.hear(&result);
        results.push(result);
    }
    Ok(results)
}

/// Why a step that gives torque is not done: an earlier one, which has to stop the robot, did not
/// pass.
fn stops(check: Check, results: &[StepResult]) -> Option<String> {
    let open = (results.iter()).find(|result| result.outcome != StepOutcome::Passed)?;
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
    let mut text =
        format!("# Bring-up of the CM-5 at {port}\n\n| Step | | Found |\n|---|---|---|\n");
    for result in results {
        let outcome = match result.outcome {
            StepOutcome::Passed => "passed",
            StepOutcome::Failed => "FAILED",
            StepOutcome::NotDone => "not done",
        };
        let found = result.found.replace('|', "/").replace('\n', " ");
        text += &format!("| {} | {outcome} | {found} |\n", result.title);
    }
    text
}

#[cfg(test)]
#[cfg(feature = "virtual-cm5")]
mod tests;
