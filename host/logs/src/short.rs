//! Motions of too few rows: a stray segment, or a piece between gaps, costs itself, not its file.

use super::LEAST_ROWS;
use super::check::{LogFinding, Severity};
use super::reason::LogReason;
use crate::error::Place;
use std::path::Path;

/// Motions whose lines are named; the rest are counted.
const NAMED: usize = 5;

/// The motions of one file that are too short to be simulated.
#[derive(Debug, Default)]
pub(super) struct ShortMotions {
    motions: usize,
    /// First and last line, and rows, of the first of them.
    named: Vec<(usize, usize, usize)>,
    /// Fewest and most rows of one.
    rows: Option<(usize, usize)>,
}

impl ShortMotions {
    /// Counts a motion of these lines, first and last.
    pub fn take(&mut self, lines: (usize, usize), rows: usize) {
        self.motions += 1;
        if self.named.len() < NAMED {
            self.named.push((lines.0, lines.1, rows));
        }
        let (fewest, most) = self.rows.unwrap_or((rows, rows));
        self.rows = Some((fewest.min(rows), most.max(rows)));
    }

    /// Why a file is refused of which nothing else is left, if there is such a motion.
    pub fn refusal(&self, path: &Path) -> Option<(Place, LogReason)> {
        let (line, _, rows) = *self.named.first()?;
        Some((at(path, line), LogReason::TooShort { rows }))
    }

    /// That they are left out, where the file holds longer ones.
    pub fn warning(&self, path: &Path) -> Option<LogFinding> {
        let (line, ..) = *self.named.first()?;
        let (motions, are) = match self.motions {
            1 => ("a motion".to_string(), "is"),
            several => (format!("{several} motions"), "are"),
        };
        let (rows, lines) = (self.rows(), self.lines());
        Some(LogFinding {
            kind: "short",
            severity: Severity::Warn,
            place: Some(at(path, line)),
            what: format!(
                "{motions} of {rows} ({lines}) {are} left out; {LEAST_ROWS} rows are the least"
            ),
            remedy: "the rest of the file is used: check where segments and gaps begin there, or \
                     record longer"
                .to_string(),
            proof: None,
        })
    }

    /// "1 row", "2 to 7 rows".
    fn rows(&self) -> String {
        match self.rows.unwrap_or_default() {
            (1, 1) => "1 row".to_string(),
            (fewest, most) if fewest == most => format!("{most} rows"),
            (fewest, most) => format!("{fewest} to {most} rows"),
        }
    }

    /// "line 2", "lines 2, 40-43 and of 3 more".
    fn lines(&self) -> String {
        let named = self
            .named
            .iter()
            .map(|(first, last, _)| match first == last {
                true => first.to_string(),
                false => format!("{first}-{last}"),
            });
        let named = named.collect::<Vec<_>>().join(", ");
        let several = self.motions > 1 || self.named.iter().any(|(first, last, _)| first < last);
        let line = if several { "lines" } else { "line" };
        match self.motions - self.named.len() {
            0 => format!("{line} {named}"),
            more => format!("{line} {named} and of {more} more"),
        }
    }
}

/// How many rows of a motion are left once its columns are moved in time, where they are fewer than
/// [`LEAST_ROWS`]: of a long motion only so many times are kept.
#[derive(Debug)]
pub(super) struct RowsLeft {
    /// By how much the earliest and the latest column is moved, s; at most 0, at least 0.
    ends_s: (f64, f64),
    lines: Option<(usize, usize)>,
    from_s: f64,
    last_s: f64,
    first_s: Vec<f64>,
}

impl RowsLeft {
    /// Of a motion that has not begun.
    pub fn new(ends_s: (f64, f64)) -> Self {
        RowsLeft {
            ends_s,
            lines: None,
            from_s: 0.0,
            last_s: 0.0,
            first_s: Vec::new(),
        }
    }

    /// Takes the motion's next row.
    pub fn take(&mut self, line: usize, time_s: f64) {
        if self.lines.is_none() {
            self.from_s = time_s + self.ends_s.1;
        }
        self.lines = Some((self.lines.map_or(line, |(first, _)| first), line));
        self.last_s = time_s;
        if time_s >= self.from_s && self.first_s.len() < LEAST_ROWS {
            self.first_s.push(time_s);
        }
    }

    /// Ends the motion, if one had begun: its lines, and its rows up to [`LEAST_ROWS`].
    pub fn close(&mut self) -> Option<((usize, usize), usize)> {
        let to_s = self.last_s + self.ends_s.0;
        let left = self.first_s.iter().filter(|time_s| **time_s <= to_s);
        let rows = left.count();
        self.first_s.clear();
        Some((self.lines.take()?, rows))
    }
}

fn at(path: &Path, line: usize) -> Place {
    Place {
        line: Some(line),
        ..Place::file(path)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn said(motions: &[((usize, usize), usize)]) -> String {
        let mut short = ShortMotions::default();
        motions
            .iter()
            .for_each(|(lines, rows)| short.take(*lines, *rows));
        short.warning(Path::new("a.csv")).unwrap().statement()
    }

    #[test]
    fn rows_without_a_moved_column_are_not_left() {
        let left = |ends_s, rows: u32| {
            let mut left = RowsLeft::new(ends_s);
            (0..rows).for_each(|k| left.take(k as usize + 2, 0.01 * f64::from(k)));
            left.close()
        };
        assert_eq!(left((0.0, 0.0), 0), None);
        assert_eq!(left((0.0, 0.0), 9), Some(((2, 10), 9)));
        assert_eq!(left((0.0, 0.0), 500), Some(((2, 501), LEAST_ROWS)));
        assert_eq!(left((-0.025, 0.015), 13), Some(((2, 14), 8)));
        assert_eq!(left((-0.025, 0.015), 15), Some(((2, 16), LEAST_ROWS)));
    }

    #[test]
    fn a_warning_names_lines_rows_and_the_least() {
        assert_eq!(
            said(&[((2, 2), 1)]),
            "a.csv:2: a motion of 1 row (line 2) is left out; 10 rows are the least"
        );
        assert_eq!(
            said(&[((2, 2), 1), ((40, 43), 4)]),
            "a.csv:2: 2 motions of 1 to 4 rows (lines 2, 40-43) are left out; 10 rows are the least"
        );
        let many: Vec<_> = (0..8).map(|k| ((9 * k + 5, 9 * k + 6), 2)).collect();
        assert_eq!(
            said(&many),
            "a.csv:5: 8 motions of 2 rows (lines 5-6, 14-15, 23-24, 32-33, 41-42 and of 3 more) \
             are left out; 10 rows are the least"
        );
    }
}
