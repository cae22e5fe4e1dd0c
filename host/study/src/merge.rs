//! From journals to one table.

use super::journal::{self, Header};
use super::summary::Summary;
use crate::error::{Error, Place, Result};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// A whole study.
#[derive(Debug, Clone)]
pub struct Merged {
    /// Which study.
    pub header: Header,
    rows: Vec<String>,
}

/// What is not there.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Missing {
    /// Chunks, in order.
    pub chunks: Vec<usize>,
    /// Runs in them, as ranges from first to last.
    pub runs: Vec<(usize, usize)>,
    /// Journals whose end is torn, with the bytes that are lost.
    pub torn: Vec<(PathBuf, u64)>,
}

/// Puts journals together; the inner error lists what is missing.
///
/// # Errors
/// Files that are no journals or cannot be read, journals of different studies, chunks that differ
/// though they should not.
pub fn merge(files: &[PathBuf]) -> Result<Result<Merged, Missing>> {
    let mut found: Option<(Header, PathBuf)> = None;
    let mut rows: BTreeMap<usize, (String, PathBuf)> = BTreeMap::new();
    let mut torn = Vec::new();
    for file in journals(files)? {
        let content = journal::read(&file)?;
        if content.length > content.whole {
            torn.push((file.clone(), content.length - content.whole));
        }
        match &found {
            Some((header, first)) if *header != content.header => {
                return Err(Error::data(
                    Place::file(&file),
                    format!("this is another study than {}", first.display()),
                    "merge shards of one study, all by the same version of the program",
                ));
            }
            Some(_) => {}
            None => found = Some((content.header, file.clone())),
        }
        for (chunk, text) in content.rows {
            match rows.get(&chunk) {
                Some((other, first)) if *other != text => {
                    return Err(Error::data(
                        Place::file(&file),
                        format!("chunk {chunk} differs from that in {}", first.display()),
                        "the same run must give the same row: one of the two was changed, or \
                         computed on a machine whose arithmetic differs",
                    ));
                }
                Some(_) => {}
                None => {
                    rows.insert(chunk, (text, file.clone()));
                }
            }
        }
    }
    let Some((header, first)) = found else {
        return Err(Error::usage(
            "there is no journal to merge",
            "name .journal files, or folders with such files",
        ));
    };
    let chunks = header.chunks();
    if let Some((&chunk, (_, file))) = rows.range(chunks..).next() {
        return Err(Error::data(
            Place::file(file),
            format!("chunk {chunk} of a study of {chunks} chunks"),
            format!("compare the file with {}", first.display()),
        ));
    }
    let missing: Vec<usize> = (0..chunks)
        .filter(|chunk| !rows.contains_key(chunk))
        .collect();
    Ok(if missing.is_empty() {
        Ok(Merged {
            rows: rows.into_values().map(|(text, _)| text).collect(),
            header,
        })
    } else {
        Err(Missing {
            runs: runs(&header, &missing),
            chunks: missing,
            torn,
        })
    })
}

/// The files, and the journals in the folders, in order of their names.
fn journals(files: &[PathBuf]) -> Result<Vec<PathBuf>> {
    let mut found = Vec::new();
    for file in files {
        if !file.is_dir() {
            found.push(file.clone());
            continue;
        }
        let refused = |error| Error::file(file, "read", error);
        let mut inside = Vec::new();
        for entry in std::fs::read_dir(file).map_err(refused)? {
            let path = entry.map_err(refused)?.path();
            if path.extension().is_some_and(|ending| ending == "journal") {
                inside.push(path);
            }
        }
        inside.sort();
        found.append(&mut inside);
    }
    Ok(found)
}

fn runs(header: &Header, chunks: &[usize]) -> Vec<(usize, usize)> {
    let mut ranges: Vec<(usize, usize)> = Vec::new();
    for chunk in chunks {
        let first = chunk * header.chunk;
        let last = (first + header.chunk).min(header.runs) - 1;
        match ranges.last_mut() {
            Some(range) if range.1 + 1 == first => range.1 = last,
            _ => ranges.push((first, last)),
        }
    }
    ranges
}

impl Merged {
    /// The table, with a line of columns.
    pub fn csv(&self) -> String {
        let mut text = self.header.columns.join(",");
        text.push('\n');
        text.extend(self.rows.iter().map(String::as_str));
        text
    }

    /// Values of the table, not-a-number where a field is empty.
    ///
    /// # Errors
    /// A row that does not fit the columns.
    pub fn values(&self, file: &Path) -> Result<Vec<Vec<f64>>> {
        let lines = self.rows.iter().flat_map(|rows| rows.lines());
        lines
            .enumerate()
            .map(|(line, text)| {
                let fields = text.split(',').map(|field| match field {
                    "" => Ok(f64::NAN),
                    field => field.parse::<f64>(),
                });
                let row: Option<Vec<f64>> = fields.map(Result::ok).collect();
                let row = row.filter(|row| row.len() == self.header.columns.len());
                let place = || Place::at(file, line + 2, 1);
                row.ok_or_else(|| {
                    Error::data(
                        place(),
                        "this row does not fit the columns",
                        "run the shard again",
                    )
                })
            })
            .collect()
    }

    /// The study in a few figures.
    ///
    /// # Errors
    /// As [`Merged::values`].
    pub fn summary(&self, file: &Path) -> Result<Summary> {
        let values = self.values(file)?;
        Ok(Summary::of(
            &self.header.fingerprint,
            &self.header.columns,
            &values,
        ))
    }
}
