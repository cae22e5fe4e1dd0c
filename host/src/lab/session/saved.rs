//! What a session keeps on disk: `session.json`, written whole or not at all.

use super::card::SavedDiagnosis;
use super::round::Round;
use crate::error::{Error, Place, Result};
use crate::fitting::Horizon;
use crate::output::write_new;
use serde::{Deserialize, Serialize};
use std::path::Path;

/// Format of the file.
const VERSION: u32 = 1;
const FILE: &str = "session.json";

/// Everything a person did.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct SavedSession {
    version: u32,
    /// Logs, in the folder `logs` of the session.
    pub logs: Vec<SavedLog>,
    /// Models, from the first to the last that was made.
    pub steps: Vec<SavedStep>,
    /// The one in force.
    pub current: usize,
    /// How long models run without correction.
    pub window: ChosenWindow,
    /// The last diagnosis.
    pub diagnosis: Option<SavedDiagnosis>,
    /// The challenge, in a session that was begun as one.
    pub round: Option<Round>,
}

/// How long models run without correction at most.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ChosenWindow {
    /// As long as the last diagnosis judged over; whole motions before there is one.
    #[default]
    Automatic,
    /// Whole motions.
    Whole,
    /// This long, s.
    Seconds(f64),
}

impl ChosenWindow {
    /// The horizon that was chosen by hand.
    pub fn by_hand(self) -> Option<Horizon> {
        match self {
            ChosenWindow::Automatic => None,
            ChosenWindow::Whole => Some(Horizon::Whole),
            ChosenWindow::Seconds(seconds) => Some(Horizon::Seconds(seconds)),
        }
    }
}

/// A log of the session.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct SavedLog {
    /// Name of the file.
    pub file: String,
    /// First and last data row wanted; all without.
    pub rows: Option<(usize, usize)>,
    /// Whether it judges and is not fitted.
    pub held_out: bool,
}

/// A model, and how it came about.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SavedStep {
    /// What was done: "as given", "coulomb@1 added".
    pub title: String,
    /// The model's file.
    pub toml: String,
    /// The command line that does the same, if there is one.
    pub command: Option<String>,
    /// What a person wrote down.
    pub note: String,
}

impl Default for SavedSession {
    fn default() -> Self {
        SavedSession {
            version: VERSION,
            logs: Vec::new(),
            steps: Vec::new(),
            current: 0,
            window: ChosenWindow::Automatic,
            diagnosis: None,
            round: None,
        }
    }
}

impl SavedSession {
    /// Reads the session of a folder.
    ///
    /// # Errors
    /// A file that cannot be read, or that another version wrote.
    pub fn load(folder: &Path) -> Result<SavedSession> {
        let path = folder.join(FILE);
        let text =
            std::fs::read_to_string(&path).map_err(|error| Error::file(&path, "read", error))?;
        let broken = |what: String| {
            let place = Place::file(&path);
            Error::data(
                place,
                what,
                "move the folder away, or name another --session",
            )
        };
        let saved: SavedSession =
            serde_json::from_str(&text).map_err(|error| broken(error.to_string()))?;
        if saved.version != VERSION || saved.current > saved.steps.len().saturating_sub(1) {
            return Err(broken("another version of this program wrote it".into()));
        }
        Ok(saved)
    }

    /// Writes the session: a reader, or a crash, finds this one or the one before.
    ///
    /// # Errors
    /// The system's refusal.
    pub fn save(&self, folder: &Path) -> Result<()> {
        let text = serde_json::to_string_pretty(self)
            .map_err(|error| Error::file(folder.join(FILE), "write", error.into()))?;
        write_new(&folder.join(FILE), &text, true)
    }

    /// The horizon over which models are compared and fitted.
    pub fn horizon(&self) -> Horizon {
        let judged = self.diagnosis.as_ref().and_then(|said| said.horizon_s);
        self.window
            .by_hand()
            .unwrap_or(Horizon::from_seconds(judged))
    }

    /// The step in force.
    pub fn step(&self) -> Option<&SavedStep> {
        self.steps.get(self.current)
    }
}
