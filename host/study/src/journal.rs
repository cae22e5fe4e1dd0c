//! Finished chunks on disk, so that a killed study goes on where it was.
//!
//! A line of JSON that says which study it is, then chunks: a line with the chunk's number, the
//! length of its rows in bytes and their SHA-256, then the rows. Each is appended and synced whole;
//! what does not match its sum at the end was torn by a crash and is cut off.

use super::monte_carlo::{CHUNK, columns};
use super::parse::Study;
use crate::error::{Error, Place, Result};
use crate::output::append_file::AppendFile;
use crate::output::number::hex;
use serde::{Deserialize, Serialize};
use sha2::{Digest as _, Sha256};
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

/// Which study a journal belongs to.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Header {
    /// Version of the format.
    pub handstand_study: u32,
    /// SHA-256 of all that decides the rows.
    pub fingerprint: String,
    /// Runs of the whole study.
    pub runs: usize,
    /// Runs in a chunk.
    pub chunk: usize,
    /// Columns of the rows.
    pub columns: Vec<String>,
}

/// Version of the format.
const FORMAT: u32 = 1;
/// Most chunks of a study: some thousand million runs. A damaged header may say any number, and the
/// missing ones are listed.
const MOST_CHUNKS: usize = 10_000_000;

impl Header {
    /// The header of a study's journals.
    pub fn of(study: &Study) -> Header {
        Header {
            handstand_study: FORMAT,
            fingerprint: study.fingerprint(),
            runs: study.judging.runs,
            chunk: CHUNK,
            columns: columns(study),
        }
    }

    /// Number of chunks of the whole study.
    pub fn chunks(&self) -> usize {
        self.runs.div_ceil(self.chunk.max(1))
    }
}

/// What a journal's file holds.
#[derive(Debug, Clone)]
pub(super) struct Content {
    pub header: Header,
    /// Rows by chunk.
    pub rows: BTreeMap<usize, String>,
    /// Bytes up to the end of the last whole chunk.
    pub whole: u64,
    /// Bytes of the file.
    pub length: u64,
}

/// An open journal.
#[derive(Debug)]
pub struct Journal {
    file: AppendFile,
    /// Chunks it holds already.
    pub done: BTreeSet<usize>,
    /// Bytes of a torn chunk that were cut off on opening.
    pub torn_bytes: u64,
}

impl Journal {
    /// Opens a study's journal or begins it; other programs are kept out until it is dropped.
    ///
    /// # Errors
    /// A journal of another study, one that another program is writing, or what the system refuses.
    pub fn open(path: &Path, header: &Header) -> Result<Journal> {
        let Some((file, bytes)) = AppendFile::open(path)? else {
            return Err(Error::usage(
                format!("{}: another program is writing it", path.display()),
                "wait for it, or give this one another folder",
            ));
        };
        let mut journal = Journal {
            done: BTreeSet::new(),
            torn_bytes: 0,
            file,
        };
        if !bytes.contains(&b'\n') {
            // New, or killed before the first line was whole.
            journal.file.cut(0)?;
            let line = serde_json::to_string(header)
                .map_err(|error| Error::file(path, "write", error.into()))?;
            journal.file.append(&(line + "\n"))?;
            return Ok(journal);
        }
        let found = content(&bytes, path)?;
        if found.header != *header {
            return Err(Error::data(
                Place::file(path),
                "this is the journal of another study, or of another version of the program",
                "give this study another folder, or delete the journal",
            ));
        }
        journal.torn_bytes = found.length - found.whole;
        journal.done = found.rows.into_keys().collect();
        journal.file.cut(found.whole)?;
        Ok(journal)
    }

    /// Adds a finished chunk, safe on disk when this returns.
    ///
    /// # Errors
    /// What the system refuses.
    pub fn add(&mut self, chunk: usize, rows: &str) -> Result<()> {
        let text = format!(
            "chunk {chunk} bytes {} sha256 {}\n{rows}",
            rows.len(),
            sum(rows)
        );
        self.file.append(&text)?;
        self.done.insert(chunk);
        Ok(())
    }
}

/// Reads a journal.
///
/// # Errors
/// A file that is no journal, or what the system refuses.
pub(super) fn read(path: &Path) -> Result<Content> {
    let bytes = std::fs::read(path).map_err(|error| Error::file(path, "read", error))?;
    content(&bytes, path)
}

fn content(bytes: &[u8], path: &Path) -> Result<Content> {
    let line = bytes.split(|byte| *byte == b'\n').next().unwrap_or(bytes);
    let header: Header = serde_json::from_slice(line)
        .ok()
        .filter(|header: &Header| header.handstand_study == FORMAT && header.chunk > 0)
        .filter(|header| header.chunks() <= MOST_CHUNKS)
        .filter(|_| line.len() < bytes.len())
        .ok_or_else(|| {
            Error::data(
                Place::at(path, 1, 1),
                "this is no journal of a study",
                "name a .journal file that `handstand study monte-carlo` wrote, or its folder",
            )
        })?;
    let mut place = line.len() + 1;
    let mut rows = BTreeMap::new();
    while let Some((chunk, text, end)) = chunk_at(bytes, place) {
        rows.insert(chunk, text);
        place = end;
    }
    Ok(Content {
        header,
        rows,
        whole: place as u64,
        length: bytes.len() as u64,
    })
}

/// The chunk that begins at a place, and where it ends; none if it is not whole.
fn chunk_at(bytes: &[u8], place: usize) -> Option<(usize, String, usize)> {
    let rest = bytes.get(place..)?;
    let end = rest.iter().position(|byte| *byte == b'\n')?;
    let line = std::str::from_utf8(&rest[..end]).ok()?;
    let words: Vec<&str> = line.split(' ').collect();
    let ["chunk", chunk, "bytes", length, "sha256", sha256] = words[..] else {
        return None;
    };
    let length: usize = length.parse().ok()?;
    let rows = rest.get(end + 1..)?.get(..length)?;
    let rows = std::str::from_utf8(rows).ok()?;
    (sum(rows) == sha256).then_some(())?;
    Some((
        chunk.parse().ok()?,
        rows.to_string(),
        place + end + 1 + length,
    ))
}

fn sum(rows: &str) -> String {
    hex(Sha256::digest(rows))
}
