//! `bus doctor --bring-up`: the checklist of `docs/bring-up.md`, step by step, and a report.

use crate::cli::port::AnyLink;
use crate::cli::{Console, ExitStatus};
use handstand::link::SerialLink as _;
use handstand::link::bring_up::{Person, StepOutcome, StepResult, bring_up, markdown};
use handstand::{Error, Result, output};
use std::io::IsTerminal as _;
use std::path::Path;

/// Walks through the checklist; exit code 1 unless every step passed.
pub fn run(
    mut link: AnyLink,
    ids: &[u8],
    report: Option<&Path>,
    yes: bool,
    console: &Console,
) -> Result<ExitStatus> {
    if let Some(file) = report {
        output::vacant(file, false)?;
    }
    let port = link.name().to_string();
    let mut person = Attendant {
        can_be_asked: std::io::stdin().is_terminal(),
        yes,
        console,
    };
    let results = bring_up(&mut link, ids, &mut person)?;
    if let Some(file) = report {
        console.write(file, &markdown(&port, &results), false)?;
    }
    let count = |outcome| results.iter().filter(|it| it.outcome == outcome).count();
    let [passed, deviate, failed, open] = [
        StepOutcome::Passed,
        StepOutcome::Deviates,
        StepOutcome::Failed,
        StepOutcome::NotDone,
    ]
    .map(count);
    console.result(&results, || {
        format!("{passed} steps passed, {deviate} deviate, {failed} failed, {open} not done")
    })?;
    Ok(ExitStatus::answer(deviate + failed + open == 0))
}

/// Who sits at the terminal.
struct Attendant<'a> {
    can_be_asked: bool,
    /// Torque is allowed beforehand.
    yes: bool,
    console: &'a Console,
}

impl Attendant<'_> {
    fn answer(&self, question: &str) -> Result<String> {
        eprint!("{question} ");
        let mut answer = String::new();
        let read = std::io::stdin().read_line(&mut answer);
        read.map_err(|error| Error::file(Path::new("standard input"), "read", error))?;
        Ok(answer.trim().to_string())
    }
}

impl Person for Attendant<'_> {
    fn confirms(&mut self, title: &str, instruction: &str) -> Result<(Option<bool>, String)> {
        if !self.can_be_asked {
            return Ok((None, "to be checked by hand".to_string()));
        }
        self.console.say(&format!("\n{title}\n  {instruction}"));
        let answer = self.answer("  yes or no, and what you measured (Enter: not done):")?;
        let is_so = match answer.split([' ', ',']).next() {
            Some("yes") => Some(true),
            Some("no") => Some(false),
            _ => None,
        };
        Ok((is_so, answer))
    }

    fn allows_torque(&mut self, id: u8) -> Result<bool> {
        if self.yes || !self.can_be_asked {
            return Ok(self.yes);
        }
        let answer = self.answer(&format!(
            "\nServo {id} gets a tenth of its torque. Type yes:"
        ))?;
        Ok(answer == "yes")
    }

    fn hear(&mut self, result: &StepResult) {
        let outcome = match result.outcome {
            StepOutcome::Passed => "passed",
            StepOutcome::Deviates => "DEVIATES",
            StepOutcome::Failed => "FAILED",
            StepOutcome::NotDone => "not done",
        };
        let found = if result.found.is_empty() {
            String::new()
        } else {
            format!(": {}", result.found)
        };
        self.console
            .say(&format!("{outcome:8} {}{found}", result.title));
        if let StepOutcome::Deviates | StepOutcome::Failed = result.outcome {
            let (expected, otherwise) = (result.expected, result.otherwise);
            self.console.say(&format!(
                "         expected: {expected}; otherwise: {otherwise}"
            ));
        }
    }
}
