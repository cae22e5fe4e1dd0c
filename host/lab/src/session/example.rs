//! Examples to begin with: a bench arm with a known effect missing from its model.

use super::{ChosenWindow, LabSession};
use crate::challenge::{Hidden, generate};
use crate::error::Result;

/// An example.
#[derive(Debug)]
pub struct Example {
    /// Name in forms.
    pub id: &'static str,
    /// What it shows.
    pub title: &'static str,
    seed: u64,
    hidden: Hidden,
}

/// Every example.
pub const EXAMPLES: &[Example] = &[
    Example {
        id: "delay",
        title: "Servo arm whose commands arrive late",
        seed: 3,
        hidden: Hidden::Effect("delay"),
    },
    Example {
        id: "coulomb",
        title: "Servo arm with dry friction",
        seed: 3,
        hidden: Hidden::Effect("coulomb"),
    },
    Example {
        id: "backlash",
        title: "Servo arm with play in its gear",
        seed: 5,
        hidden: Hidden::Effect("backlash"),
    },
    Example {
        id: "complete",
        title: "Servo arm whose model is complete but for its friction's size",
        seed: 4,
        hidden: Hidden::Nothing,
    },
];

impl LabSession {
    /// Brings an example into the session; its last log judges. What was there is gone.
    ///
    /// # Errors
    /// The system's refusal.
    pub fn bring_example(&self, example: &Example) -> Result<()> {
        let made = generate(example.seed, example.hidden);
        self.bring_bench(&made.model_toml, &made.logs)
    }

    /// Brings a bench arm's model and logs; the last log judges.
    pub(super) fn bring_bench(&self, model: &str, logs: &[(String, String)]) -> Result<()> {
        self.change(|saved| {
            saved.logs.clear();
            saved.window = ChosenWindow::Automatic;
            Ok(())
        })?;
        self.begin_model("as given", model)?;
        for (name, text) in logs {
            self.add_log(name, text.as_bytes())?;
        }
        match self.saved().logs.last() {
            Some(last) => self.hold_out(&last.name(), true),
            None => Ok(()),
        }
    }
}
