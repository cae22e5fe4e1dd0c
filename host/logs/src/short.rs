//! Motions of too few rows: a stray segment, or a piece between gaps, costs itself, not its file.

use super::LEAST_ROWS;
use super::check::{LogFinding, Severity};
use crate::error::{Place, Problem};
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

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.motions == 0
    }

    /// Why a file is refused of which nothing else is left, if there is such a motion.
    pub fn refusal(&self, path: &Path) -> Option<(Place, Problem)> {
        let (line, _, rows) = *self.named.first()?;
        let problem = Problem::new(
            format!("a motion of {rows} rows; {LEAST_ROWS} are the least"),
            "leave it out by a row range such as log.csv:26-139, or record longer",
        );
        Some((at(path, line), problem))
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
        let named = self.named.iter().map(|(first, last, _)| {
            if first == last {
                first.to_string()
            } else {
                format!("{first}-{last}")
            }
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
