//! Reads the header of a CSV log: separator, column names, constants in comments.

use super::cell::{is_missing, number};
use super::iso::iso_ns;
use super::layout::{BLANKS, LOOK, Layout, names_row};
use super::lines::Lines;
use crate::error::{Error, Place, Result};
use std::borrow::Cow;
use std::path::Path;

/// Columns and constants of one file.
#[derive(Debug)]
pub(super) struct LogHeader {
    /// Between two fields: `,`, `;`, tab, `|` or blanks.
    pub separator: u8,
    /// Column names in the file's order, trimmed.
    pub names: Vec<String>,
    /// Line of the names, counted from 1.
    pub line: usize,
    /// `# key = value` before the names, with their line.
    pub constants: Vec<(String, f64, usize)>,
}

impl LogHeader {
    /// Reads up to and including the names. Also returns the first data line where the names stood
    /// in a comment just above it, as numpy and `rostopic` write them. `time` is a name that must be
    /// among them, where one is known.
    ///
    /// # Errors
    /// An empty file, data without names, names that do not fit the rows or stand further down, and
    /// decimal commas between commas.
    pub fn read(
        path: &Path,
        lines: &mut Lines,
        time: Option<&str>,
    ) -> Result<(LogHeader, Option<String>)> {
        let mut constants = Vec::new();
        let mut above = None;
        loop {
            let number = lines.number + 1;
            let Some(text) = lines.next()? else {
                return Err(Error::data(
                    Place::file(path),
                    "the log holds no header line",
                    "record again: a log is a line of column names, then a line per sample",
                ));
            };
            if text.trim().is_empty() || (number == 1 && says_separator(text)) {
                continue;
            }
            let text = text.to_string();
            let is_known = |text: &str| time.is_some_and(|time| holds(text, time));
            if let Some(words) = comment(&text).filter(|_| !is_known(&text)) {
                if let Some((key, value)) = constant(words) {
                    constants.push((key, value, number));
                }
                above = Some((words.to_string(), number));
                continue;
            }
            let in_comment = above.filter(|(words, _)| is_known(words) || names_row(words, &text));
            let mut ahead = lines.peek(LOOK)?;
            let (names, line, first) = match in_comment {
                Some((words, line)) if !is_known(&text) => {
                    ahead.insert(0, (number, text.clone()));
                    (words, line, Some(text))
                }
                _ => (text, number, None),
            };
            let layout = Layout {
                names: &names,
                line,
                ahead: &ahead,
            };
            if let Some((line, problem)) = layout.fault(is_known(&names), time) {
                return Err(problem.at(Place::at(path, line, 1)));
            }
            let separator = layout.separator();
            let header = LogHeader {
                separator,
                names: owned(&names, separator),
                line,
                constants,
            };
            return Ok((header, first));
        }
    }
}

/// Splits a line at separators outside quotes.
pub(super) fn fields(line: &str, separator: u8) -> Vec<Cow<'_, str>> {
    if separator == BLANKS {
        return line.split_whitespace().map(Cow::Borrowed).collect();
    }
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

/// Whether a row has more or fewer fields than there are names. A separator behind the last field
/// of a row, or of the names, makes none.
pub(super) fn surplus(fields: &mut Vec<Cow<'_, str>>, names: &[String]) -> bool {
    let (found, expected) = (fields.len(), names.len());
    if found == expected + 1 && fields.last().is_some_and(|last| last.is_empty()) {
        fields.pop();
    } else if found + 1 == expected && names.last().is_some_and(String::is_empty) {
        fields.push("".into());
    }
    fields.len() != expected
}

/// Without the quotes that the csv crate leaves on when a blank stands before them.
fn unquoted(field: &str) -> &str {
    let inner = field
        .strip_prefix('"')
        .and_then(|rest| rest.strip_suffix('"'));
    inner.unwrap_or(field)
}

/// Whether a line is the first of Excel's, `sep=;`. The names tell the same.
fn says_separator(line: &str) -> bool {
    let line = line.trim().to_ascii_lowercase();
    let sign = line.strip_prefix("sep=");
    sign.is_some_and(|sign| sign.chars().count() <= 1)
}

/// The separator of a header line: the most frequent of `;`, tab, `|` and comma.
pub(super) fn separator(line: &str) -> u8 {
    let count = |separator: u8| fields(line, separator).len();
    let mut best = b',';
    for candidate in [b';', b'\t', b'|'] {
        if count(candidate) > count(best) {
            best = candidate;
        }
    }
    best
}

fn owned(line: &str, separator: u8) -> Vec<String> {
    let names = fields(line, separator).into_iter();
    names.map(Cow::into_owned).collect()
}

/// Whether a line holds this name as one of its fields.
fn holds(line: &str, name: &str) -> bool {
    let has = |separator: u8| fields(line, separator).iter().any(|word| word == name);
    // What follows the sign of a comment is judged without it.
    has(separator(line)) || (comment(line).is_none() && has(BLANKS))
}

/// The words of a line that is a comment: behind `#`, or behind `%` as MATLAB and `rostopic` write.
pub(super) fn comment(line: &str) -> Option<&str> {
    line.trim_start().strip_prefix(['#', '%'])
}

/// Whether all fields hold a value or a gap, one of them a number.
pub(super) fn is_data(line: &str, separator: u8) -> bool {
    let cells = fields(line, separator);
    let is_number = |cell: &str| number(cell, separator).is_some() || iso_ns(cell).is_some();
    cells.iter().any(|cell| is_number(cell))
        && cells.iter().all(|cell| is_missing(cell) || is_number(cell))
}

/// Key and value of `key = value` or `key: value` with a numeric value.
fn constant(words: &str) -> Option<(String, f64)> {
    let (key, value) = words.split_once(['=', ':'])?;
    let value = number(value.trim(), b';').filter(|value| value.is_finite())?;
    Some((key.trim().to_string(), value))
}
