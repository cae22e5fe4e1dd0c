//! Outcomes kept in a file of JSON lines, so that a run that was stopped goes on.

use serde::Serialize;
use serde::de::DeserializeOwned;
use std::fs::OpenOptions;
use std::io::{ErrorKind, Write as _};
use std::path::Path;

/// The outcomes of a file; none where there is no file yet.
///
/// # Errors
/// A file that cannot be read, and the first line that is no outcome.
pub(super) fn read<T: DeserializeOwned>(path: &Path) -> Result<Vec<T>, String> {
    let said = |why: String| format!("{}: {why}", path.display());
    let text = match std::fs::read_to_string(path) {
        Ok(text) => text,
        Err(error) if error.kind() == ErrorKind::NotFound => return Ok(Vec::new()),
        Err(error) => return Err(said(error.to_string())),
    };
    let lines = text.lines().enumerate().map(|(k, line)| {
        serde_json::from_str(line)
            .map_err(|why| said(format!("line {} is no outcome: {why}", k + 1)))
    });
    lines.collect()
}

/// Appends an outcome; of several threads each writes whole lines.
///
/// # Errors
/// A file that cannot be written.
pub(super) fn append<T: Serialize>(path: &Path, outcome: &T) -> Result<(), String> {
    let said = |why: String| format!("{}: {why}", path.display());
    let text = serde_json::to_string(outcome).map_err(|why| said(why.to_string()))?;
    let file = OpenOptions::new().append(true).create(true).open(path);
    let written = file.and_then(|mut file| file.write_all(format!("{text}\n").as_bytes()));
    written.map_err(|why| said(why.to_string()))
}
