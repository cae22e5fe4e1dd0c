//! Reads the header of a CSV log: separator, column names, constants in comments.

use super::lines::Lines;
use super::reason::LogReason;
use super::table::LogTable;
use crate::error::{Error, Place, Result};
use std::borrow::Cow;
use std::path::{Path, PathBuf};

/// Columns and constants of one file.
#[derive(Debug)]
pub(super) struct LogHeader {
    /// The file, for errors.
    path: PathBuf,
    /// Between two fields: `,`, `;` or tab.
    pub separator: u8,
    /// Column names in the file's order, trimmed.
    pub names: Vec<String>,
    /// Line of the names, counted from 1.
    line: usize,
    /// `# key = value` before the names, with their line.
    constants: Vec<(String, f64, usize)>,
    /// Columns of a table that hold no numbers a row, and what they hold.
    left_out: Vec<(String, &'static str)>,
}

/// Where a quantity's value comes from.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum LogCell {
    /// Field of each row, counted from 0.
    Field(usize),
    /// One number for the whole file, from the comment on this line.
    Constant(f64, usize),
}

impl LogCell {
    /// The field counted from 1, as places count; 1 for a constant.
    pub fn column(&self) -> usize {
        match self {
            LogCell::Field(index) => index + 1,
            LogCell::Constant(..) => 1,
        }
    }
}

impl LogHeader {
    /// Reads up to and including the names. Also returns the first data line where the names stood
    /// in a comment just above it, as numpy writes them.
    ///
    /// # Errors
    /// An empty file, UTF-16, or data without names.
    pub fn read(path: &Path, lines: &mut Lines, time: &str) -> Result<(LogHeader, Option<String>)> {
        let mut constants = Vec::new();
        let mut comment = None;
        loop {
            let number = lines.number + 1;
            let Some(text) = lines.next()? else {
                return Err(Error::refused(Place::file(path), LogReason::NoHeader));
            };
            if text.trim().is_empty() {
                continue;
            }
            if let Some(words) = text.trim_start().strip_prefix('#') {
                if let Some((key, value)) = constant(words) {
                    constants.push((key, value, number));
                }
                comment = Some((words.to_string(), number));
                continue;
            }
            let (names, line, first) = match comment.filter(|_| is_data(text)) {
                Some((words, line)) if names(&words).contains(&time.to_string()) => {
                    (words, line, Some(text.to_string()))
                }
                _ => (text.to_string(), number, None),
            };
            let header = LogHeader {
                path: path.to_path_buf(),
                separator: separator(&names),
                names: self::names(&names),
                line,
                constants,
                left_out: Vec::new(),
            };
            return Ok((header, first));
        }
    }

    /// The header of a table.
    pub fn of_table(path: &Path, table: &LogTable) -> LogHeader {
        let constants = table.constants.iter();
        LogHeader {
            path: path.to_path_buf(),
            separator: b',',
            names: table.names.clone(),
            line: 1,
            constants: constants
                .map(|(name, value)| (name.clone(), *value, 1))
                .collect(),
            left_out: table.left_out.clone(),
        }
    }

    /// Where the column of this name is.
    ///
    /// # Errors
    /// No such column, with those found and the likeliest meant; a name that stands there twice.
    pub fn cell(&self, name: &str) -> Result<LogCell> {
        let mut found = (0..self.names.len()).filter(|&i| self.names[i] == name);
        match (found.next(), found.next()) {
            (Some(_), Some(second)) => {
                let column = name.to_string();
                let place = Place::at(&self.path, self.line, second + 1);
                Err(Error::refused(place, LogReason::ColumnTwice { column }))
            }
            (Some(index), None) => Ok(LogCell::Field(index)),
            (None, _) => match self.constants.iter().find(|(key, ..)| key == name) {
                Some((_, value, line)) => Ok(LogCell::Constant(*value, *line)),
                None => Err(self.missing(name)),
            },
        }
    }

    fn missing(&self, name: &str) -> Error {
        let place = Place::at(&self.path, self.line, 1);
        let column = name.to_string();
        if let Some((_, holds)) = self.left_out.iter().find(|(left_out, _)| left_out == name) {
            return Error::refused(place, LogReason::ColumnLeftOut { column, holds });
        }
        let is_number = |name: &String| number(name, self.separator).is_some();
        if self.names.iter().all(is_number) {
            return Error::refused(place, LogReason::NoNames { column });
        }
        let plain = |name: &str| -> String {
            let letters = name.chars().filter(|letter| letter.is_alphanumeric());
            letters.flat_map(char::to_lowercase).collect()
        };
        let likeness = |known: &str| strsim::jaro_winkler(&plain(known), &plain(name));
        let constants = self.constants.iter().map(|(key, ..)| key);
        let nearest = self
            .names
            .iter()
            .chain(constants)
            .max_by(|a, b| likeness(a).total_cmp(&likeness(b)))
            .filter(|known| likeness(known) > 0.8);
        let reason = LogReason::NoColumn {
            column,
            nearest: nearest.cloned(),
            found: self.names.clone(),
        };
        Error::refused(place, reason)
    }
}

/// Splits a line at separators outside quotes.
pub(super) fn fields(line: &str, separator: u8) -> Vec<Cow<'_, str>> {
    if !line.contains('"') {
        return line
            .split(char::from(separator))
            .map(|field| Cow::Borrowed(field.trim()))
            .collect();
    }
    let mut reader = ::csv::ReaderBuilder::new()
        .delimiter(separator)
        .has_headers(false)
        .buffer_capacity(line.len())
        .from_reader(line.as_bytes());
    let mut record = ::csv::StringRecord::new();
    match reader.read_record(&mut record) {
        Ok(true) => record
            .iter()
            .map(|field| Cow::Owned(unquoted(field.trim()).to_string()))
            .collect(),
        _ => vec![Cow::Borrowed(line)],
    }
}

/// Without the quotes that the csv crate leaves on when a blank stands before them.
fn unquoted(field: &str) -> &str {
    let inner = field
        .strip_prefix('"')
        .and_then(|rest| rest.strip_suffix('"'));
    inner.unwrap_or(field)
}

/// The number in a field; a comma counts as the decimal point where it cannot separate fields.
pub(super) fn number(field: &str, separator: u8) -> Option<f64> {
    match field.parse() {
        Ok(value) => Some(value),
        Err(_) if separator != b',' && field.matches(',').count() == 1 && !field.contains('.') => {
            field.replace(',', ".").parse().ok()
        }
        Err(_) => None,
    }
}

/// The separator of a header line: the most frequent of `;`, tab and comma.
fn separator(line: &str) -> u8 {
    let count = |separator: u8| fields(line, separator).len();
    let mut best = b',';
    for candidate in [b';', b'\t'] {
        if count(candidate) > count(best) {
            best = candidate;
        }
    }
    best
}

fn names(line: &str) -> Vec<String> {
    fields(line, separator(line))
        .into_iter()
        .map(Cow::into_owned)
        .collect()
}

fn is_data(line: &str) -> bool {
    let separator = separator(line);
    fields(line, separator)
        .iter()
        .all(|field| number(field, separator).is_some())
}

/// Key and value of `key = value` or `key: value` with a numeric value.
fn constant(words: &str) -> Option<(String, f64)> {
    let (key, value) = words.split_once(['=', ':'])?;
    let value = number(value.trim(), b';').filter(|value| value.is_finite())?;
    Some((key.trim().to_string(), value))
}
