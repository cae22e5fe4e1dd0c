//! Reads a file line by line and hashes it; holds one line at a time.

use super::reason::LogReason;
use super::standard_input::{is_standard_input, standard_input};
use crate::error::{Error, Place, Result};
use crate::output::number::hex;
use sha2::{Digest, Sha256};
use std::fs::File;
use std::io::{BufRead, BufReader, Read};
use std::path::{Path, PathBuf};

/// Longest line accepted, bytes; a longer one is no log and would fill the memory.
pub(super) const LONGEST_LINE: usize = 1 << 20;

/// Lines of a text file without their ends (LF or CR LF) and without a byte-order mark.
pub(super) struct Lines {
    path: PathBuf,
    reader: Box<dyn BufRead + Send>,
    hash: Sha256,
    line: Vec<u8>,
    /// The present line's number, counted from 1; 0 before the first.
    pub number: usize,
}

impl Lines {
    /// Opens `path`; `-` is the standard input.
    pub fn open(path: &Path) -> Result<Self> {
        let reader: Box<dyn BufRead + Send> = match is_standard_input(path) {
            true => Box::new(standard_input()?),
            false => {
                let file = File::open(path).map_err(|source| Error::file(path, "read", source))?;
                Box::new(BufReader::new(file))
            }
        };
        Ok(Lines {
            path: path.to_path_buf(),
            reader,
            hash: Sha256::new(),
            line: Vec::new(),
            number: 0,
        })
    }

    /// The next line, or `None` at the end.
    ///
    /// # Errors
    /// A line that is too long or not UTF-8, with its place; the system's refusal.
    pub fn next(&mut self) -> Result<Option<&str>> {
        self.line.clear();
        let read = (&mut self.reader)
            .take(LONGEST_LINE as u64 + 1)
            .read_until(b'\n', &mut self.line)
            .map_err(|source| Error::file(&self.path, "read", source))?;
        if read == 0 {
            return Ok(None);
        }
        self.number += 1;
        self.hash.update(&self.line);
        if read > LONGEST_LINE {
            let place = Place::at(&self.path, self.number, 1);
            return Err(Error::refused(place, LogReason::LineTooLong));
        }
        let mut line = &self.line[..];
        line = line.strip_suffix(b"\n").unwrap_or(line);
        line = line.strip_suffix(b"\r").unwrap_or(line);
        if self.number == 1 {
            line = line.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(line);
        }
        match std::str::from_utf8(line) {
            Ok(text) => Ok(Some(text)),
            // Comments are for people: an odd letter in one does no harm.
            Err(_) if line.trim_ascii_start().starts_with(b"#") => Ok(Some("#")),
            Err(error) => {
                let before = &line[..error.valid_up_to()];
                let separators = before.iter().filter(|byte| b",;\t".contains(byte));
                let place = Place::at(&self.path, self.number, separators.count() + 1);
                let byte = line[before.len()];
                Err(Error::refused(place, LogReason::NotUtf8 { byte }))
            }
        }
    }

    /// SHA-256 of all bytes read, lower-case hexadecimal.
    pub fn sha256(self) -> String {
        hex(self.hash.finalize())
    }
}
