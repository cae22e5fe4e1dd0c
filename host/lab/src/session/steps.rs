//! Models one after the other: undone, done again, noted, written as files.

use super::LabSession;
use super::saved::SavedStep;
use crate::error::{Error, Result};
use crate::model::Model;
use crate::output::write_new;

impl LabSession {
    /// Puts a model in force after the present one; steps that were undone are gone.
    ///
    /// # Errors
    /// A text that is no model, the system's refusal.
    pub fn push_step(&self, step: SavedStep) -> Result<()> {
        Model::parse(&step.toml, &self.model_path(0))?;
        self.change(|saved| {
            // What was undone is gone; the first step takes nothing away.
            saved
                .steps
                .truncate((saved.current + 1).min(saved.steps.len()));
            saved.steps.push(step);
            saved.current = saved.steps.len() - 1;
            Ok(())
        })?;
        self.write_models()
    }

    /// Puts an earlier or later step in force.
    ///
    /// # Errors
    /// There is no such step.
    pub fn go_to_step(&self, step: usize) -> Result<()> {
        self.change(|saved| {
            if step >= saved.steps.len() {
                return Err(no_step(step));
            }
            saved.current = step;
            Ok(())
        })?;
        self.write_models()
    }

    /// Writes a note to a step.
    ///
    /// # Errors
    /// There is no such step.
    pub fn note(&self, step: usize, note: &str) -> Result<()> {
        self.change(|saved| {
            let step = saved.steps.get_mut(step).ok_or_else(|| no_step(step))?;
            step.note = note.to_string();
            Ok(())
        })
    }

    /// The models as files beside the logs, so that the commands shown can be typed there.
    pub(super) fn write_models(&self) -> Result<()> {
        for (index, step) in self.saved().steps.iter().enumerate() {
            write_new(&self.model_path(index), &step.toml, true)?;
        }
        Ok(())
    }
}

fn no_step(step: usize) -> Error {
    Error::usage(format!("there is no step {step}"), "reload the page")
}
