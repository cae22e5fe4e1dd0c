//! What a session keeps on disk: `session.json`, written whole or not at all.

use super::card::SavedDiagnosis;
use super::kept::KeptDiagnosis;
use super::round::Round;
use super::view::LeftOutLog;
use crate::discover::TermPicture;
use crate::error::{Error, Place, Result};
use crate::fitting::{FittedValue, Horizon};
use crate::log::LogRequest;
use crate::output::write_new;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Format of the file.
const VERSION: u32 = 1;
const FILE: &str = "session.json";

/// Everything a person did.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct SavedSession {
    version: u32,
    /// What a person calls it; empty without a name.
    #[serde(default)]
    pub name: String,
    /// Logs, in the folder `logs` of the session.
    pub logs: Vec<SavedLog>,
    /// Where robots' files were copied from, by their names here: their meshes lie beside them.
    #[serde(default)]
    pub robots_from: BTreeMap<String, PathBuf>,
    /// Models, from the first to the last that was made.
    pub steps: Vec<SavedStep>,
    /// The one in force.
    pub current: usize,
    /// How long models run without correction.
    pub window: ChosenWindow,
    /// Every diagnosis that was made, the last one last.
    #[serde(default)]
    pub kept: Vec<KeptDiagnosis>,
    /// The one of them that belongs to the logs and to a model among the steps.
    pub diagnosis: Option<SavedDiagnosis>,
    /// The challenge, in a session that was begun as one.
    pub round: Option<Round>,
    /// Logs that the model in force cannot read: found anew each time.
    #[serde(skip)]
    pub left_out: Vec<LeftOutLog>,
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
    /// SHA-256 of its bytes, in hexadecimal.
    #[serde(default)]
    pub sha256: String,
}

impl SavedLog {
    /// Its name, with the rows where a part is wanted: `drop.csv:26-139`.
    pub fn name(&self) -> String {
        LogRequest {
            path: self.file.clone().into(),
            rows: self.rows,
        }
        .name()
    }
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
    /// Values that a fit gave it, with their intervals.
    #[serde(default)]
    pub values: Vec<SavedValue>,
    /// Terms of a discovered law beside what the motions say.
    #[serde(default)]
    pub pictures: Vec<TermPicture>,
}

/// A fitted value with its 95 % interval, in SI units.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SavedValue {
    /// Its address: `coulomb@1.torque_nm`.
    pub path: String,
    /// Its unit, for people.
    pub unit: String,
    /// Fitted value.
    pub value: f64,
    /// Lower end of the interval.
    pub low: Option<f64>,
    /// Upper end of the interval.
    pub high: Option<f64>,
    /// Whether it lies on a bound: a warning, not a result.
    pub on_bound: bool,
}

impl From<&FittedValue> for SavedValue {
    fn from(fitted: &FittedValue) -> Self {
        // JSON has no number for what is unbounded.
        let end = |value: f64| Some(value).filter(|value| value.is_finite());
        SavedValue {
            path: fitted.path.clone(),
            unit: fitted.unit.clone(),
            value: fitted.value,
            low: end(fitted.low),
            high: end(fitted.high),
            on_bound: fitted.on_bound,
        }
    }
}

impl From<&SavedValue> for FittedValue {
    fn from(saved: &SavedValue) -> Self {
        let key = saved.path.rsplit('.').next();
        FittedValue {
            path: saved.path.clone(),
            key: key.unwrap_or_default().to_string(),
            unit: saved.unit.clone(),
            value: saved.value,
            low: saved.low.unwrap_or(f64::NEG_INFINITY),
            high: saved.high.unwrap_or(f64::INFINITY),
            on_bound: saved.on_bound,
        }
    }
}

impl SavedStep {
    /// A model that a person brought or wrote.
    pub fn by_hand(title: impl Into<String>, toml: impl Into<String>) -> SavedStep {
        SavedStep {
            title: title.into(),
            toml: toml.into(),
            command: None,
            note: String::new(),
            values: Vec::new(),
            pictures: Vec::new(),
        }
    }
}

impl Default for SavedSession {
    fn default() -> Self {
        SavedSession {
            version: VERSION,
            name: String::new(),
            logs: Vec::new(),
            robots_from: BTreeMap::new(),
            steps: Vec::new(),
            current: 0,
            window: ChosenWindow::Automatic,
            kept: Vec::new(),
            diagnosis: None,
            round: None,
            left_out: Vec::new(),
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
        if saved.is_sound() {
            Ok(saved)
        } else {
            Err(broken("another version of this program wrote it".into()))
        }
    }

    /// Whether this version of the program wrote it, and what it names is there.
    pub fn is_sound(&self) -> bool {
        self.version == VERSION && self.current <= self.steps.len().saturating_sub(1)
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
