//! Reads a file line by line and hashes it; holds one line at a time.

use super::fault::RowFault;
use super::foreign::{HEAD, foreign, unknown_binary};
use super::format::LogFormat;
use super::standard_input::{is_standard_input, standard_input};
use crate::error::{Error, Place, Result};
use crate::output::number::hex;
use sha2::{Digest, Sha256};
use std::collections::VecDeque;
use std::fs::File;
use std::io::{BufRead, BufReader, Read};
use std::path::{Path, PathBuf};

/// Longest line accepted, bytes; a longer one is no log and would fill the memory.
pub(super) const LONGEST_LINE: usize = 1 << 20;

/// Most bytes that are read ahead.
const AHEAD: usize = 1 << 20;

/// A line that is not UTF-8, and the field in which it is not.
pub(super) struct NoText {
    pub place: Place,
    pub fault: RowFault,
}

/// Lines of a text file without their ends (LF, CR LF, or CR alone) and without a byte-order mark.
pub(super) struct Lines {
    path: PathBuf,
    reader: Box<dyn BufRead + Send>,
    hash: Sha256,
    /// The last byte of each line.
    end: u8,
    line: Vec<u8>,
    /// Lines that were read ahead, with their ends.
    ahead: VecDeque<Vec<u8>>,
    /// The present line's number, counted from 1; 0 before the first.
    pub number: usize,
    /// Bytes of the lines so far.
    pub bytes: usize,
}

impl Lines {
    /// Opens `path`; `-` is the standard input.
    ///
    /// # Errors
    /// What the system refuses; bytes of another program's file, with what it is.
    pub fn open(path: &Path) -> Result<Self> {
        let mut reader: Box<dyn BufRead + Send> = if is_standard_input(path) {
            Box::new(standard_input()?)
        } else {
            let file = File::open(path).map_err(|source| Error::file(path, "read", source))?;
            Box::new(BufReader::new(file))
        };
        let head = reader
            .fill_buf()
            .map_err(|source| Error::file(path, "read", source))?;
        let head = &head[..head.len().min(HEAD)];
        let other = foreign(path, head, LogFormat::Csv).or_else(|| unknown_binary(path, head));
        if let Some(error) = other {
            return Err(error);
        }
        let is_end = |end: u8| head.contains(&end);
        let end = if is_end(b'\r') && !is_end(b'\n') {
            b'\r'
        } else {
            b'\n'
        };
        Ok(Lines {
            path: path.to_path_buf(),
            reader,
            hash: Sha256::new(),
            end,
            line: Vec::new(),
            ahead: VecDeque::new(),
            number: 0,
            bytes: 0,
        })
    }

    /// The next line, or `None` at the end.
    ///
    /// # Errors
    /// A line that is too long or not UTF-8, with its place; the system's refusal.
    pub fn next(&mut self) -> Result<Option<&str>> {
        match self.next_line()? {
            Some(Err(NoText { place, fault })) => Err(fault.problem().at(place)),
            Some(Ok(text)) => Ok(Some(text)),
            None => Ok(None),
        }
    }

    /// The same where the reading goes on behind a line that is not UTF-8.
    ///
    /// # Errors
    /// A line that is too long, with its place; the system's refusal.
    pub fn next_line(&mut self) -> Result<Option<Result<&str, NoText>>> {
        match self.ahead.pop_front() {
            Some(line) => self.line = line,
            None => {
                self.line.clear();
                read_line(&mut self.reader, self.end, &mut self.line, &self.path)?;
            }
        }
        if self.line.is_empty() {
            return Ok(None);
        }
        self.number += 1;
        self.bytes += self.line.len();
        self.hash.update(&self.line);
        if self.line.len() > LONGEST_LINE {
            let place = Place::at(&self.path, self.number, 1);
            return Err(Error::data(
                place,
                format!("a line longer than {LONGEST_LINE} bytes"),
                "this is no CSV log; name a text file with one sample per line",
            ));
        }
        let line = bare(&self.line, self.number);
        match std::str::from_utf8(line) {
            Ok(text) => Ok(Some(Ok(text))),
            // Comments are for people: an odd letter in one does no harm.
            Err(_) if matches!(line.trim_ascii_start().first(), Some(b'#' | b'%')) => {
                Ok(Some(Ok("#")))
            }
            Err(error) => {
                let before = &line[..error.valid_up_to()];
                let separators = before.iter().filter(|byte| b",;\t|".contains(byte));
                let place = Place::at(&self.path, self.number, separators.count() + 1);
                let fault = RowFault::NoText(line[before.len()]);
                Ok(Some(Err(NoText { place, fault })))
            }
        }
    }

    /// The lines that come next, up to `count` of them, with their numbers; they stay to be read.
    /// Fewer where they are long.
    ///
    /// # Errors
    /// The system's refusal.
    pub fn peek(&mut self, count: usize) -> Result<Vec<(usize, String)>> {
        let mut bytes: usize = self.ahead.iter().map(Vec::len).sum();
        while self.ahead.len() < count && bytes < AHEAD {
            let mut line = Vec::new();
            read_line(&mut self.reader, self.end, &mut line, &self.path)?;
            if line.is_empty() {
                break;
            }
            bytes += line.len();
            self.ahead.push_back(line);
        }
        let numbered = (self.number + 1..).zip(&self.ahead);
        let text = |(number, line): (usize, &Vec<u8>)| {
            (
                number,
                String::from_utf8_lossy(bare(line, number)).into_owned(),
            )
        };
        Ok(numbered.map(text).collect())
    }

    /// SHA-256 of all bytes read, lower-case hexadecimal.
    pub fn sha256(self) -> String {
        hex(self.hash.finalize())
    }
}

/// Adds a line with its end, one byte more than is accepted at most; nothing at the end.
fn read_line(reader: &mut dyn BufRead, end: u8, line: &mut Vec<u8>, path: &Path) -> Result<()> {
    reader
        .take(LONGEST_LINE as u64 + 1)
        .read_until(end, line)
        .map(|_| ())
        .map_err(|source| Error::file(path, "read", source))
}

/// The line of this number without its end and byte-order mark.
fn bare(line: &[u8], number: usize) -> &[u8] {
    let line = line.strip_suffix(b"\n").unwrap_or(line);
    let line = line.strip_suffix(b"\r").unwrap_or(line);
    match number {
        1 => line.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(line),
        _ => line,
    }
}
