//! `meta/info.json`: version, where the episodes are, and what their columns hold.

use super::data_path::DataPath;
use super::element_names::ElementNames;
use crate::error::{Error, Place, Result};
use crate::output::shortened;
use crate::table::LogTable;
use serde_json::Value;
use std::path::{Path, PathBuf};

/// Largest description of a data set, bytes.
const LARGEST: u64 = 64 << 20;
/// Versions that are read, and whether several episodes share a file.
const VERSIONS: [(&str, bool); 3] = [("v2.0", false), ("v2.1", false), ("v3.0", true)];

/// What a data set says of itself.
#[derive(Debug)]
pub(super) struct DatasetInfo {
    file: PathBuf,
    value: Value,
    /// Whether several episodes share a file.
    pub is_v3: bool,
}

/// A JSON file's value.
///
/// # Errors
/// What the system refuses, more than 64 MiB, and what is no JSON, with its line and column.
pub(super) fn json(file: &Path) -> Result<Value> {
    let refused = |source| Error::file(file, "read", source);
    if std::fs::metadata(file).map_err(refused)?.len() > LARGEST {
        let remedy = "name a data set's own file: it is some kB long";
        return Err(Error::data(Place::file(file), "more than 64 MiB", remedy));
    }
    let bytes = std::fs::read(file).map_err(refused)?;
    serde_json::from_slice(&bytes).map_err(|error| {
        let place = Place::at(file, error.line().max(1), error.column().max(1));
        let remedy = "fetch the file again: it is not as LeRobot wrote it";
        Error::data(place, format!("no JSON: {error}"), remedy)
    })
}

/// What a JSON value is, in a few words.
pub(super) fn found(value: Option<&Value>) -> String {
    match value {
        None => "nothing".into(),
        Some(Value::Null) => "null".into(),
        Some(Value::Array(all)) => format!("a list of {}", all.len()),
        Some(Value::Object(all)) => format!("an object of {} keys", all.len()),
        Some(Value::String(text)) => format!("{:?}", shortened(text)),
        Some(plain) => shortened(&plain.to_string()).into_owned(),
    }
}

impl DatasetInfo {
    /// Reads the file.
    ///
    /// # Errors
    /// As [`json`]; a version that is not read.
    pub fn read(file: &Path) -> Result<DatasetInfo> {
        let value = json(file)?;
        let version = value.get("codebase_version");
        let known = version.and_then(Value::as_str);
        let known = known.and_then(|own| VERSIONS.iter().find(|(name, _)| *name == own));
        let is_v3 = known.map(|(_, is_v3)| *is_v3);
        let info = DatasetInfo {
            file: file.to_path_buf(),
            is_v3: is_v3.unwrap_or(false),
            value,
        };
        if is_v3.is_some() {
            return Ok(info);
        }
        let names = VERSIONS.map(|(name, _)| name).join(", ");
        let remedy = format!(
            "a data set of {names} is read; LeRobot's own scripts convert others: \
             lerobot.datasets.v30.convert_dataset_v21_to_v30 and those before it"
        );
        Err(info.wrong("codebase_version", remedy))
    }

    /// The template of the files' paths.
    ///
    /// # Errors
    /// No text, or one that leads out of the folder or names no files.
    pub fn data_path(&self) -> Result<DataPath> {
        let (names, usual) = if self.is_v3 {
            (
                ["chunk_index", "file_index"],
                "data/chunk-{chunk_index:03d}/file-{file_index:03d}.parquet",
            )
        } else {
            (
                ["episode_chunk", "episode_index"],
                "data/chunk-{episode_chunk:03d}/episode_{episode_index:06d}.parquet",
            )
        };
        let remedy = format!("write a path within the folder, usually {usual}");
        let text = self.value.get("data_path").and_then(Value::as_str);
        let text = text.ok_or_else(|| self.wrong("data_path", &remedy))?;
        DataPath::parse(text, names).map_err(|why| {
            let what = format!("data_path: {:?}: {why}", shortened(text));
            Error::data(Place::file(&self.file), what, remedy)
        })
    }

    /// How many episodes it declares.
    ///
    /// # Errors
    /// No whole number above 0.
    pub fn episodes(&self) -> Result<u64> {
        self.count(
            "total_episodes",
            "record an episode, or write how many there are",
        )
    }

    /// How many files a chunk has.
    ///
    /// # Errors
    /// No whole number above 0.
    pub fn chunk_size(&self) -> Result<u64> {
        self.count(
            "chunks_size",
            "write how many files a folder holds, usually 1000",
        )
    }

    fn count(&self, key: &str, remedy: &str) -> Result<u64> {
        let number = self.value.get(key).and_then(Value::as_u64);
        let number = number.filter(|number| *number > 0);
        number.ok_or_else(|| self.wrong(key, remedy))
    }

    /// The kind of robot.
    pub fn robot_type(&self) -> Option<&str> {
        self.value.get("robot_type").and_then(Value::as_str)
    }

    /// What the elements of a list are called.
    ///
    /// # Errors
    /// As [`ElementNames::of`]; features that are no object.
    pub fn names(&self, list: &str) -> Result<Option<ElementNames>> {
        let features = self.value.get("features").and_then(Value::as_object);
        let remedy = "LeRobot writes an object of columns there: take the file that it wrote";
        let features = features.ok_or_else(|| self.wrong("features", remedy))?;
        let Some(feature) = features.get(list) else {
            return Ok(None);
        };
        ElementNames::of(list, feature, &self.file)
    }

    /// The key holds something else.
    fn wrong(&self, key: &str, remedy: impl Into<String>) -> Error {
        let what = format!("{key}: {}", found(self.value.get(key)));
        Error::data(Place::file(&self.file), what, remedy)
    }

    /// A file that it declares is not there.
    pub fn missing(&self, file: &Path) -> Error {
        let what = format!("it declares {}, which is not there", file.display());
        let remedy = "fetch the whole data set: `data` and `meta` of it; videos are not needed";
        Error::data(Place::file(&self.file), what, remedy)
    }

    /// It declares more than is read at once.
    pub fn many(&self, key: &str, declared: u64, most: u64) -> Error {
        let what = format!("{key}: {declared}, and at most {most} are read at once");
        let remedy = "give some of its files, or a folder of them, such as data/chunk-000";
        Error::data(Place::file(&self.file), what, remedy)
    }

    /// It declares another number of episodes than are listed.
    pub fn other_count(&self, declared: u64, listed: u64) -> Error {
        let what = format!("total_episodes: {declared}, but meta/episodes lists {listed}");
        let remedy = "fetch the whole of meta/episodes, of one version of the data set";
        Error::data(Place::file(&self.file), what, remedy)
    }
}

/// Chunk and number of the file of each episode that a table of `meta/episodes` lists.
///
/// # Errors
/// A table without these columns, or with other numbers than whole ones from 0 to 10^6.
pub(super) fn listed(table: &LogTable, file: &Path) -> Result<Vec<(u64, u64)>> {
    let remedy = "fetch the data set again: LeRobot writes there which file holds each episode";
    let column = |name: &str| -> Result<Vec<u64>> {
        let index = table.names.iter().position(|own| own == name);
        let index = index
            .ok_or_else(|| Error::data(Place::file(file), format!("no column {name:?}"), remedy))?;
        let whole = |value: &f64| {
            let is_whole = (0.0..=1e6).contains(value) && value.fract() == 0.0;
            let what = || format!("column {name:?}: {value}, no number of a file");
            is_whole
                .then_some(*value as u64)
                .ok_or_else(|| Error::data(Place::file(file), what(), remedy))
        };
        table.columns[index].iter().map(whole).collect()
    };
    let (chunks, files) = (column("data/chunk_index")?, column("data/file_index")?);
    Ok(chunks.into_iter().zip(files).collect())
}
