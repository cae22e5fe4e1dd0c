//! A folder of logs stands for the logs in it, one of LeRobot's data sets for its episodes.

use super::foreign::foreign_file;
use super::format::LogFormat;
use super::lerobot::LerobotDataset;
use super::request::LogRequest;
use super::same_rows::{SameBy, SizedRequest};
use crate::error::{Error, Result};
use std::path::PathBuf;

/// The requests as [`unfolded`]; no row may be asked for twice, by one name or as a copy under
/// another, for it would count twice.
///
/// # Errors
/// As [`unfolded`]; rows asked for twice.
pub fn expanded(requests: &[LogRequest]) -> Result<Vec<LogRequest>> {
    let all = unfolded(requests)?;
    told_apart(&all)?;
    Ok(all)
}

/// The requests with each folder replaced by the logs in it, in the order of their names; a data
/// set of LeRobot by its files, in the order of their episodes.
///
/// A folder's own folders are not searched; files of other endings are passed over.
///
/// # Errors
/// A folder without a log, rows of a folder, what the system refuses, and a data set whose
/// description or files are not as LeRobot writes them.
pub fn unfolded(requests: &[LogRequest]) -> Result<Vec<LogRequest>> {
    let mut all = Vec::new();
    for request in requests {
        if request.path.is_dir() {
            all.extend(of_folder(request)?)
        } else {
            all.push(request.clone())
        }
    }
    Ok(all)
}

fn told_apart(requests: &[LogRequest]) -> Result<()> {
    let sized = SizedRequest::all(requests);
    for (index, own) in sized.iter().enumerate() {
        let before = sized[..index].iter();
        let mut before = before.filter_map(|log| Some((log.request, log.same(own)?)));
        let Some((before, by)) = before.next() else {
            continue;
        };
        let request = own.request;
        let message = match (by, before.rows == request.rows) {
            (SameBy::Name, true) => format!("{request} is given twice"),
            (SameBy::Content, true) => format!("{request} is a copy of {before}"),
            (_, false) => format!("{request} shares rows with {before}"),
        };
        return Err(Error::usage(
            format!("{message}{}", by.words()),
            "name each row once, a range includes its end: a row named twice counts twice",
        ));
    }
    Ok(())
}

fn of_folder(request: &LogRequest) -> Result<Vec<LogRequest>> {
    let folder = &request.path;
    if LerobotDataset::is_one(folder) {
        return of_dataset(request);
    }
    let refused = |error| Error::file(folder, "read", error);
    let (mut logs, mut others): (Vec<PathBuf>, Vec<PathBuf>) = Default::default();
    for entry in std::fs::read_dir(folder).map_err(refused)? {
        let path = entry.map_err(refused)?.path();
        match (path.is_file(), LogFormat::is_log(&path)) {
            (false, _) => {}
            (true, true) => logs.push(path),
            (true, false) => others.push(path),
        }
    }
    logs.sort();
    others.sort();
    if request.rows.is_none() && logs.is_empty() {
        let mut known = others.iter();
        if let Some((other, (what, remedy))) =
            known.find_map(|path| Some((path, foreign_file(path)?)))
        {
            let name = other.file_name().unwrap_or_default().to_string_lossy();
            let folder = folder.display();
            let message = format!("{folder}: no log lies in it; of {name}: {what}");
            return Err(Error::usage(message, remedy));
        }
    }
    let message = match (request.rows, logs.is_empty()) {
        (Some(_), _) => format!("{request}: rows of a folder"),
        (None, true) => format!("{}: no log lies in it", folder.display()),
        (None, false) => return Ok(logs.into_iter().map(LogRequest::whole).collect()),
    };
    let endings: Vec<&str> = LogFormat::endings().collect();
    let remedy = format!(
        "name a folder with {} files, or one file",
        endings.join(", ")
    );
    Err(Error::usage(message, remedy))
}

fn of_dataset(request: &LogRequest) -> Result<Vec<LogRequest>> {
    if request.rows.is_some() {
        return Err(rows_of_dataset(request));
    }
    let files = LerobotDataset::open(&request.path)?.files()?;
    Ok(files.into_iter().map(LogRequest::whole).collect())
}

/// Rows are of a file.
pub(super) fn rows_of_dataset(request: &LogRequest) -> Error {
    let remedy = "name one of its files: data/chunk-000/file-000.parquet:0-999";
    Error::usage(format!("{request}: rows of a data set"), remedy)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_folder_is_the_logs_in_it() {
        let folder = tempfile::tempdir().unwrap();
        for name in ["b.csv", "a.MCAP", "notes.md", "c.mat"] {
            std::fs::write(folder.path().join(name), "").unwrap();
        }
        std::fs::create_dir(folder.path().join("inner.csv")).unwrap();
        let other = LogRequest::whole("x.csv");
        let all = expanded(&[LogRequest::whole(folder.path()), other]).unwrap();
        let names: Vec<String> = all.iter().map(LogRequest::name).collect();
        assert_eq!(names, ["a.MCAP", "b.csv", "c.mat", "x.csv"]);
        let rows = LogRequest {
            path: folder.path().to_path_buf(),
            rows: Some((0, 5)),
        };
        assert_eq!(expanded(&[rows]).unwrap_err().exit_code(), 2);
        let inner = folder.path().join("inner.csv");
        let refused = || expanded(&[LogRequest::whole(&inner)]).unwrap_err();
        assert_eq!(refused().exit_code(), 2);
        // What lies there under another ending is named.
        std::fs::write(inner.join("bag_0.db3.zstd"), b"\x28\xb5\x2f\xfd....").unwrap();
        let error = refused();
        assert!(
            error
                .to_string()
                .contains("bag_0.db3.zstd: this is a rosbag2 packed by zstd")
        );
        assert_eq!(
            error.remedy().unwrap(),
            "unpack it first: zstd -d bag_0.db3.zstd"
        );
    }
}
