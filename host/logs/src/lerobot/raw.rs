//! A data set's columns as they stand in its files, and what it calls them.

use super::{LISTS, LerobotDataset, element_of};
use crate::error::{Error, Place, Result};
use crate::folder::rows_of_dataset;
use crate::table::MOST_CELLS;
use crate::{LogRequest, RawLog};
use std::path::{Path, PathBuf};

/// What a data set says of its columns.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct DatasetFacts {
    /// Where it says it: its `meta/info.json`.
    pub info: PathBuf,
    /// Columns of lists and what their elements are called: `observation.state_1`,
    /// `shoulder_pan.pos`.
    pub called: Vec<(String, String)>,
    /// Why elements of the measured list have no names, where they have none.
    pub unnamed: Option<String>,
    /// The kind of robot: `so101_follower`.
    pub robot_type: Option<String>,
}

impl DatasetFacts {
    /// What an element of a list is called, by its column.
    pub fn name_of(&self, column: &str) -> Option<&str> {
        let mut called = self.called.iter();
        let found = called.find(|(own, _)| own == column);
        found.map(|(_, name)| name.as_str())
    }
}

/// All rows of a data set, its episodes one after the other.
///
/// # Errors
/// As [`LerobotDataset::open`] and [`LerobotDataset::files`]; rows asked for; files of other
/// columns than the first; lists that are not as long as `meta/info.json` says; more than 200
/// million numbers.
pub(crate) fn raw_log(folder: &Path, checked: Option<&LogRequest>) -> Result<RawLog> {
    if let Some(request) = checked.filter(|request| request.rows.is_some()) {
        return Err(rows_of_dataset(request));
    }
    let dataset = LerobotDataset::open(folder)?;
    let mut all: Option<RawLog> = None;
    for file in dataset.files()? {
        let request = checked.map(|_| LogRequest::whole(&file));
        let log = RawLog::read_checked(&file, request.as_ref())?;
        let Some(all) = &mut all else {
            all = Some(log);
            continue;
        };
        if log.names != all.names {
            let other = log.names.iter().find(|name| !all.names.contains(name));
            let lacks = all.names.iter().find(|name| !log.names.contains(name));
            let what = match (other, lacks) {
                (Some(other), _) => format!("a column {other:?} that the files before lack"),
                (None, Some(lacks)) => format!("no column {lacks:?}, which the files before have"),
                (None, None) => "the columns of the files before, in another order".into(),
            };
            let remedy = "fetch the data set again: its files are of several versions";
            return Err(Error::data(Place::file(&file), what, remedy));
        }
        for (column, more) in all.columns.iter_mut().zip(log.columns) {
            column.extend(more);
        }
        let cells = all.names.len() * all.columns.first().map_or(0, Vec::len);
        if cells > MOST_CELLS {
            let what = format!("more than {MOST_CELLS} numbers");
            return Err(Error::data(
                Place::file(folder),
                what,
                "name one of its files",
            ));
        }
    }
    let mut all = all.unwrap_or_default();
    all.dataset = Some(facts(&dataset, &all.names)?);
    Ok(all)
}

/// What the data set says of these columns.
fn facts(dataset: &LerobotDataset, columns: &[String]) -> Result<DatasetFacts> {
    let mut facts = DatasetFacts {
        info: dataset.info_file(),
        robot_type: dataset.robot_type().map(str::to_string),
        ..DatasetFacts::default()
    };
    for list in LISTS {
        let mut own = columns
            .iter()
            .filter(|column| element_of(column, list).is_some());
        // What no file holds need not be described as a list.
        if list != super::STATE && own.clone().next().is_none() {
            continue;
        }
        let Some(names) = dataset.names(list)? else {
            if list == super::STATE {
                facts.unnamed = Some(format!("features[{list:?}] gives no names"));
            }
            continue;
        };
        let found = own.clone().count();
        if found != names.count {
            let shape = format!("features[{list:?}].shape: [{}]", names.count);
            let what = format!("{shape}, but the files' lists have {found} elements");
            let remedy = "fetch the data set again: its files are of several versions";
            return Err(Error::data(Place::file(&facts.info), what, remedy));
        }
        if names.is_whole() {
            let called = names.names.into_iter();
            let called = called.filter_map(|name| Some((own.next()?.clone(), name)));
            facts.called.extend(called);
        } else if list == super::STATE {
            let (names, count) = (names.names.join(", "), names.count);
            let names = crate::output::shortened(&names).into_owned();
            let what = format!("features[{list:?}].names: {names:?}, no name for each of {count}");
            facts.unnamed = Some(what);
        }
    }
    Ok(facts)
}
