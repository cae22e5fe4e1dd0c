//! How the lines of a text log lie: which one names the columns, and whether it fits the rows.

use super::cell::{decimal_comma, is_missing, number};
use super::fault::DECIMAL_COMMAS;
use super::header::{comment, fields, is_data, separator};
use crate::error::Problem;
use crate::output::shortened;

/// Lines that are looked at behind the names.
pub(super) const LOOK: usize = 64;
/// Between fields of files that use no other sign.
pub(super) const BLANKS: u8 = b' ';

/// The line that names the columns, and lines behind it.
pub(super) struct Layout<'a> {
    /// Its text, without the sign of a comment.
    pub names: &'a str,
    /// Its number.
    pub line: usize,
    /// Lines that follow, with their numbers.
    pub ahead: &'a [(usize, String)],
}

impl Layout<'_> {
    /// Between two fields: that of the names, or blanks where names and rows have no other.
    pub fn separator(&self) -> u8 {
        let own = separator(self.names);
        let words = fields(self.names, BLANKS).len();
        let mut rows = self.rows().map(|(_, row)| row).peekable();
        // Commas in a row of numbers between blanks are decimal ones.
        let blank = |row: &str| {
            let cells = fields(row, BLANKS);
            let is_value = |cell: &_| is_missing(cell) || number(cell, BLANKS).is_some();
            cells.len() == words
                && (fields(row, own).len() == 1 || cells.iter().all(|cell| is_value(cell)))
        };
        if fields(self.names, own).len() == 1
            && words > 1
            && rows.peek().is_some()
            && rows.all(blank)
        {
            BLANKS
        } else {
            own
        }
    }

    /// What is wrong with the names, or with how the rows are written under them, and the line; a
    /// line that `is_known` to hold the names is not asked whether it does. `time` is a name that
    /// must be among them, where one is known.
    pub fn fault(&self, is_known: bool, time: Option<&str>) -> Option<(usize, Problem)> {
        let separator = self.separator();
        let names = fields(self.names, separator);
        if !is_known && names.iter().all(|name| number(name, separator).is_some()) {
            let lacks = time.map(|time| format!(", and no column '{}'", shortened(time)));
            let problem = Problem::new(
                format!(
                    "numbers where the column names should be{}",
                    lacks.unwrap_or_default()
                ),
                "put a line of column names above the first sample, such as time_s,angle_rad",
            );
            return Some((self.line, problem));
        }
        if separator == b',' && self.has_decimal_commas(names.len()) {
            let line = self.rows().next().map_or(self.line, |(line, _)| line);
            let what = "decimal commas in fields that commas separate";
            return Some((line, Problem::new(what, DECIMAL_COMMAS)));
        }
        self.names_below(names.len(), is_known)
            .or_else(|| self.width(names.len(), separator))
    }

    fn rows(&self) -> impl Iterator<Item = (usize, &str)> {
        let rows = self.ahead.iter().map(|(line, text)| (*line, text.as_str()));
        rows.filter(|(_, text)| !text.trim().is_empty() && comment(text).is_none())
    }

    /// Whether numbers are written with commas between commas: in quotes, or so that rows fall into
    /// up to twice as many whole numbers as there are names.
    fn has_decimal_commas(&self, names: usize) -> bool {
        let rows: Vec<_> = self.rows().map(|(_, row)| fields(row, b',')).collect();
        let mut cells = rows.iter().flatten();
        if cells.any(|cell| decimal_comma(cell).is_some()) {
            return true;
        }
        let wide = || rows.iter().filter(|row| row.len() > names);
        let digits = |text: &str| !text.is_empty() && text.bytes().all(|b| b.is_ascii_digit());
        let whole = |cell: &str| {
            let (mantissa, exponent) = cell.split_once(['e', 'E']).unwrap_or((cell, "0"));
            [mantissa, exponent].map(|part| digits(part.strip_prefix(['-', '+']).unwrap_or(part)))
                == [true; 2]
        };
        2 * wide().count() > rows.len()
            && wide().all(|row| row.len() <= 2 * names && row.iter().all(|cell| whole(cell)))
    }

    /// Whether the names stand further down, under a preamble, or are followed by a row of units.
    fn names_below(&self, names: usize, is_known: bool) -> Option<(usize, Problem)> {
        let lines = self
            .ahead
            .iter()
            .filter(|(_, text)| !text.trim().is_empty());
        let lines: Vec<_> = lines.collect();
        // The last line may be broken off.
        let sample = lines.len().checked_sub(2)?;
        let own = match separator(&lines[sample].1) {
            b',' if fields(&lines[sample].1, b',').len() == 1 => BLANKS,
            own => own,
        };
        let is_number: Vec<bool> = fields(&lines[sample].1, own)
            .iter()
            .map(|cell| number(cell, own).is_some())
            .collect();
        let like_sample = |text: &str| {
            let cells = fields(text, own);
            let mut pairs = cells.iter().zip(&is_number);
            cells.len() == is_number.len()
                && pairs.all(|(cell, is)| !is || is_missing(cell) || number(cell, own).is_some())
        };
        let numbers = is_number.iter().filter(|is| **is).count();
        let begin = (0..=sample)
            .rev()
            .take_while(|k| like_sample(&lines[*k].1))
            .last()?;
        let (line, above) = &lines[begin.checked_sub(1)?];
        let above = fields(comment(above).unwrap_or(above), own);
        let named = above.len() == is_number.len()
            && above.iter().all(|name| number(name, own).is_none())
            && above.iter().any(|name| !is_missing(name));
        if numbers < 2 || sample == begin || !named {
            return None;
        }
        match names == above.len() {
            true if begin == 1 => {
                let problem = Problem::new(
                    "a row of words between the column names and the numbers, of units perhaps",
                    "delete this line; units stand in the names: angle [deg], angle_deg",
                );
                Some((*line, problem))
            }
            true if like_sample(&lines[0].1) => None,
            _ if is_known => None,
            _ => {
                let problem = Problem::new(
                    format!(
                        "this names no columns of the rows; line {line} looks like the line of \
                         column names"
                    ),
                    format!("delete the lines above line {line}, or begin each of them with #"),
                );
                Some((self.line, problem))
            }
        }
    }

    /// Whether most rows have more or fewer fields than there are names.
    fn width(&self, names: usize, separator: u8) -> Option<(usize, Problem)> {
        let widths = self.rows().map(|(_, row)| {
            let cells = fields(row, separator);
            (
                cells.len(),
                cells.last().is_some_and(|cell| cell.is_empty()),
            )
        });
        let widths: Vec<_> = widths.collect();
        let others = || {
            let other = |(width, open): &&(usize, bool)| {
                *width != names && !(*width == names + 1 && *open) && *width + 1 != names
            };
            widths.iter().filter(other)
        };
        let (fields, _) = others().max_by_key(|(width, _)| *width)?;
        if 2 * others().count() <= widths.len() {
            return None;
        }
        let remedy = if names < *fields {
            "name every column in the header, in the order of the fields"
        } else {
            "the names have another separator than the fields, or name columns that are not \
             there: mend the header"
        };
        let what = format!("the line of column names has {names}, the rows have {fields} fields");
        Some((self.line, Problem::new(what, remedy)))
    }
}

/// Whether a comment holds the names of the row below it.
pub(super) fn names_row(words: &str, row: &str) -> bool {
    let own = separator(row);
    let own = match fields(row, own).len() {
        1 => BLANKS,
        _ => own,
    };
    let (words, cells) = (fields(words, own), fields(row, own).len());
    is_data(row, own)
        && cells > 1
        && words.len() == cells
        && words.iter().all(|word| number(word, own).is_none())
}
