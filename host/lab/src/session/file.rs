//! A session as one file to take along: what "Save session" writes, and what becomes a session
//! again where it is dropped.

use super::LabSession;
use super::saved::SavedSession;
use crate::error::{Error, Place, Result};
use crate::model::Model;
use base64::Engine as _;
use base64::engine::general_purpose::STANDARD as BASE64;
use serde::de::IgnoredAny;
use serde::{Deserialize, Serialize};
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

/// Logs of more bytes than this together are named, not held.
const MOST_HELD_BYTES: u64 = 128 << 20;

/// A session with its logs.
#[derive(Debug, Serialize, Deserialize)]
pub struct SessionFile {
    #[serde(flatten)]
    saved: SavedSession,
    /// The logs' contents by their names, `my_set/meta/info.json` of a data set; those it lacks are
    /// named alone.
    #[serde(default)]
    files: BTreeMap<String, Contents>,
    /// The robots' files that models in space name.
    #[serde(default)]
    robots: BTreeMap<String, String>,
}

/// What a file holds.
#[derive(Debug, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
enum Contents {
    /// Text as it stands.
    Text(String),
    /// Other bytes.
    Base64(String),
}

impl Contents {
    fn of(bytes: Vec<u8>) -> Contents {
        match String::from_utf8(bytes) {
            Ok(text) => Contents::Text(text),
            Err(other) => Contents::Base64(BASE64.encode(other.as_bytes())),
        }
    }

    fn bytes(self) -> Option<Vec<u8>> {
        match self {
            Contents::Text(text) => Some(text.into_bytes()),
            Contents::Base64(text) => BASE64.decode(text).ok(),
        }
    }
}

impl SessionFile {
    /// Whether a file of this name and these bytes is meant to be one.
    pub fn is_meant(name: &str, bytes: &[u8]) -> bool {
        #[derive(Deserialize)]
        struct Probe {
            logs: Option<IgnoredAny>,
            steps: Option<IgnoredAny>,
        }
        let json = Path::new(name).extension();
        json.is_some_and(|ending| ending.eq_ignore_ascii_case("json"))
            && serde_json::from_slice::<Probe>(bytes)
                .is_ok_and(|probe| probe.logs.is_some() && probe.steps.is_some())
    }

    /// Reads it; `name` stands in errors.
    ///
    /// # Errors
    /// Another version's, or one that was changed so that it is none.
    pub fn read(name: &str, bytes: &[u8]) -> Result<SessionFile> {
        let refused = |place: Place, what: String| {
            Error::data(place, what, "save it again with the program that wrote it")
        };
        let file: SessionFile = serde_json::from_slice(bytes).map_err(|why| {
            let place = Place::at(name, why.line(), why.column());
            refused(place, format!("this is no session: {why}"))
        })?;
        if !file.saved.is_sound() {
            let what = "another version of this program wrote this session";
            return Err(refused(Place::file(name), what.into()));
        }
        Ok(file)
    }
}

/// Files of a session, each by its name.
type Named = BTreeMap<String, Vec<u8>>;

/// The data sets, and the logs that are a file each.
fn sorted(files: BTreeMap<String, Contents>) -> Result<(BTreeMap<String, Named>, Named)> {
    let (mut datasets, mut tables) = (BTreeMap::<String, Named>::new(), Named::new());
    for (file, contents) in files {
        let bytes = contents.bytes().ok_or_else(|| {
            let what = format!("what it holds of {file} is no base64");
            Error::data(Place::file("session.json"), what, "save the session again")
        })?;
        let (into, name) = match file.split_once('/') {
            Some((dataset, part)) => (datasets.entry(dataset.into()).or_default(), part.into()),
            None => (&mut tables, file),
        };
        into.insert(name, bytes);
    }
    Ok((datasets, tables))
}

impl LabSession {
    /// This session as a file; logs that are too large together are named alone.
    pub fn to_file(&self, saved: SavedSession) -> SessionFile {
        let logs: BTreeSet<String> = saved
            .logs
            .iter()
            .flat_map(|log| self.files_of_log(&log.file))
            .collect();
        let size = |file: &String| std::fs::metadata(self.log_path(file)).map_or(0, |it| it.len());
        let mut files = BTreeMap::new();
        if logs.iter().map(size).sum::<u64>() <= MOST_HELD_BYTES {
            for file in &logs {
                // A log that is gone is named alone.
                if let Ok(bytes) = std::fs::read(self.log_path(file)) {
                    files.insert(file.clone(), Contents::of(bytes));
                }
            }
        }
        let robots = self.robots_of(saved.steps.iter().map(|step| step.toml.as_str()));
        SessionFile {
            saved,
            files,
            robots,
        }
    }

    /// Fills this session, which is empty, with a file's. A round that it holds stays where it was
    /// played. Logs that the file only names are lacking until they are brought.
    ///
    /// # Errors
    /// A model that is none, a log with a name that no log has, the system's refusal.
    pub fn fill_from(&self, file: SessionFile) -> Result<()> {
        let SessionFile {
            mut saved,
            files,
            robots,
        } = file;
        let (datasets, tables) = sorted(files)?;
        for log in saved
            .logs
            .iter()
            .filter(|log| !datasets.contains_key(&log.file))
        {
            self.vacant_log(&log.file)?;
        }
        for (name, text) in &robots {
            self.keep_robot(name, text)?;
        }
        for step in &mut saved.steps {
            step.toml = self.with_robot(Path::new("session.json"), &step.toml, None)?;
            Model::parse(&step.toml, &self.model_path(0))?;
        }
        let mut names = BTreeMap::new();
        for (name, parts) in datasets {
            let kept = self.write_dataset(&name, &parts)?;
            names.insert(name, kept);
        }
        for (file, bytes) in tables {
            let kept = self.keep_log(&file, &bytes)?;
            names.insert(file, kept);
        }
        for log in &mut saved.logs {
            if let Some(kept) = names.get(&log.file) {
                log.file.clone_from(kept);
                log.sha256.clear();
            }
        }
        saved.round = None;
        // Paths of another machine.
        saved.robots_from.clear();
        self.take_up(&mut saved);
        self.change(|own| {
            *own = saved;
            Ok(())
        })?;
        self.write_models()
    }
}
