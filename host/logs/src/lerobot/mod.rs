//! Data sets of LeRobot: a folder with `meta/info.json`, whose Parquet files hold the episodes.
//!
//! Read are the versions v2.0, v2.1 (a file per episode) and v3.0 (files of several episodes, which
//! `meta/episodes` lists), as `datasets/utils.py` and `datasets/dataset_metadata.py` of
//! huggingface/lerobot 0.4.4 write them.

mod calibration;
mod data_path;
mod element_names;
mod info;
mod raw;

pub use calibration::{COUNT_RAD, Calibration, DEGREES_PER_TURN, MotorCalibration};
pub use element_names::ElementNames;
pub use raw::DatasetFacts;
pub(crate) use raw::raw_log;

use super::format::LogFormat;
use super::table::LogTable;
use crate::error::Result;
use info::DatasetInfo;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// Where a data set says what it is.
const INFO: &str = "meta/info.json";
/// Most files of one data set: rows of all of them are held at once.
const MOST_FILES: u64 = 10_000;
/// The lists of numbers that are read by their elements' names.
pub(crate) const LISTS: [&str; 4] = [STATE, "observation.velocity", "observation.effort", ACTION];
/// The list of what was measured.
pub(crate) const STATE: &str = "observation.state";
/// The list of what was commanded.
pub(crate) const ACTION: &str = "action";
/// The column that tells one episode from another.
pub(crate) const EPISODE: &str = "episode_index";

/// A data set's folder, and what its `meta/info.json` says.
#[derive(Debug)]
pub(crate) struct LerobotDataset {
    folder: PathBuf,
    info: DatasetInfo,
}

/// The files of a data set that are read, relative to its folder: what it says of itself, lists of
/// episodes, and these; none of a folder that is no data set. Videos are not among them.
///
/// # Errors
/// As for reading it: a description or files that are not as LeRobot writes them.
pub fn dataset_files(folder: &Path) -> Result<Option<Vec<PathBuf>>> {
    if !LerobotDataset::is_one(folder) {
        return Ok(None);
    }
    let dataset = LerobotDataset::open(folder)?;
    let mut files = vec![PathBuf::from(INFO)];
    if dataset.info.is_v3 {
        let chunk = dataset.info.chunk_size()?;
        let lists = (0..=MOST_FILES).map(|index| PathBuf::from(list_file(index, chunk)));
        files.extend(lists.take_while(|file| folder.join(file).is_file()));
    }
    let data = dataset.files()?;
    let data = data
        .iter()
        .filter_map(|file| file.strip_prefix(folder).ok());
    files.extend(data.map(Path::to_path_buf));
    Ok(Some(files))
}

/// One of the files that list a data set's episodes, relative to its folder.
fn list_file(index: u64, chunk: u64) -> String {
    let (chunk, file) = (index / chunk, index % chunk);
    format!("meta/episodes/chunk-{chunk:03}/file-{file:03}.parquet")
}

impl LerobotDataset {
    /// Whether a folder is a data set of LeRobot.
    pub fn is_one(folder: &Path) -> bool {
        folder.join(INFO).is_file()
    }

    /// Reads what a data set says of itself.
    ///
    /// # Errors
    /// `meta/info.json` that is no JSON, of a version that is not known, or lacks what says where
    /// the episodes are.
    pub fn open(folder: &Path) -> Result<LerobotDataset> {
        Ok(LerobotDataset {
            folder: folder.to_path_buf(),
            info: DatasetInfo::read(&folder.join(INFO))?,
        })
    }

    /// Its Parquet files, in the order of their episodes.
    ///
    /// # Errors
    /// More than 10,000 of them, one that is not there, and a path that leads out of the folder.
    pub fn files(&self) -> Result<Vec<PathBuf>> {
        let chunks = if self.info.is_v3 {
            self.listed_files()?
        } else {
            self.episode_files()?
        };
        let path = self.info.data_path()?;
        let mut files = Vec::with_capacity(chunks.len());
        for (chunk, number) in chunks {
            let file = self.folder.join(path.of(chunk, number));
            if !file.is_file() {
                return Err(self.info.missing(&file));
            }
            files.push(file);
        }
        Ok(files)
    }

    /// Chunk and number of each episode, which is a file.
    fn episode_files(&self) -> Result<Vec<(u64, u64)>> {
        let (episodes, chunk) = (self.info.episodes()?, self.info.chunk_size()?);
        if episodes > MOST_FILES {
            return Err(self.info.many("total_episodes", episodes, MOST_FILES));
        }
        Ok((0..episodes).map(|own| (own / chunk, own)).collect())
    }

    /// Chunk and number of each file of several episodes, as `meta/episodes` lists them.
    fn listed_files(&self) -> Result<Vec<(u64, u64)>> {
        let chunk = self.info.chunk_size()?;
        let (mut found, mut episodes) = (BTreeSet::new(), 0);
        for index in 0..=MOST_FILES {
            let file = self.folder.join(list_file(index, chunk));
            if !file.is_file() {
                if index == 0 {
                    return Err(self.info.missing(&file));
                }
                break;
            }
            let table = LogTable::read(&file, LogFormat::Parquet, None)?;
            episodes += table.rows() as u64;
            found.extend(info::listed(&table, &file)?);
            if found.len() as u64 > MOST_FILES {
                let count = found.len() as u64;
                return Err(self.info.many("files", count, MOST_FILES));
            }
        }
        let declared = self.info.episodes()?;
        if declared != episodes {
            return Err(self.info.other_count(declared, episodes));
        }
        Ok(found.into_iter().collect())
    }

    /// What the elements of a list are called; none where the data set does not have the list, or
    /// gives its elements no names.
    ///
    /// # Errors
    /// A feature of another shape than a list's, and names that are no list of them.
    pub fn names(&self, list: &str) -> Result<Option<ElementNames>> {
        self.info.names(list)
    }

    /// The kind of robot, where the data set says it: `so101_follower`.
    pub fn robot_type(&self) -> Option<&str> {
        self.info.robot_type()
    }

    /// Where it says what it is, for errors.
    pub fn info_file(&self) -> PathBuf {
        self.folder.join(INFO)
    }
}

/// The number behind a list's name, `3` of `action_3`; nothing behind that of a list of one.
pub(crate) fn element_of(column: &str, list: &str) -> Option<String> {
    let rest = column.strip_prefix(list)?;
    if rest.is_empty() {
        return Some(String::new());
    }
    let number = rest.strip_prefix('_')?;
    let is_number = !number.is_empty() && number.bytes().all(|byte| byte.is_ascii_digit());
    is_number.then(|| number.to_string())
}
