//! Cells that cannot be read: a column of which hardly one can is one finding, single ones are one
//! each.

use super::finding::{Findings, SHOWN};
use crate::error::{Error, Place};
use crate::log::LogReason;
use std::collections::BTreeMap;

/// A column is wrong as a whole where so many of ten rows are wrong in it alike.
const OF_TEN: usize = 9;

/// What is wrong with a cell.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Fault {
    Stamp,
    Nothing,
    Beyond,
    Not(&'static str),
}

/// Cells of one column that are wrong in one way.
#[derive(Debug, Default)]
struct Alike {
    cells: usize,
    /// The first of them, one more than are shown.
    first: Vec<(Place, LogReason)>,
}

/// Running account of the rows of a file.
#[derive(Debug, Default)]
pub(super) struct WrongCells {
    rows: usize,
    alike: BTreeMap<(String, Fault), Alike>,
}

impl WrongCells {
    /// Counts a row that was read.
    pub fn read(&mut self) {
        self.rows += 1;
    }

    /// Takes the error of a row; gives it back if it is about no single cell.
    pub fn take(&mut self, error: Error) -> Result<(), Error> {
        let reason = error.reason::<LogReason>().cloned();
        let key = reason.as_ref().and_then(key);
        let (Error::Data { place, .. }, Some(reason), Some(key)) = (&error, reason, key) else {
            return Err(error);
        };
        self.rows += 1;
        let alike = self.alike.entry(key).or_default();
        alike.cells += 1;
        if alike.first.len() <= SHOWN {
            alike.first.push((place.clone(), reason));
        }
        Ok(())
    }

    /// Ends the file: whether a column as a whole is refused.
    pub fn close(&mut self, findings: &mut Findings) -> bool {
        let WrongCells { rows, alike } = std::mem::take(self);
        let is_whole = |alike: &Alike| alike.cells > 1 && 10 * alike.cells >= OF_TEN * rows;
        let (whole, single): (Vec<Alike>, Vec<Alike>) = alike.into_values().partition(is_whole);
        let any = !whole.is_empty();
        for Alike { cells, first } in whole {
            if let Some((place, cell)) = first.into_iter().next() {
                let (cell, more) = (Box::new(cell), cells - 1);
                findings.refuse("column", place, &LogReason::WrongColumn { cell, more });
            }
        }
        let cells: usize = single.iter().map(|alike| alike.cells).sum();
        let mut first: Vec<_> = single.into_iter().flat_map(|alike| alike.first).collect();
        first.sort_by_key(|(place, _)| place.line);
        for (place, reason) in &first {
            findings.refuse("cell", place.clone(), reason);
        }
        findings.count("cell", cells - first.len());
        any
    }
}

/// The column, and what is wrong with the cell.
fn key(reason: &LogReason) -> Option<(String, Fault)> {
    let (column, fault) = match reason {
        LogReason::TimeStamp { column, .. } => (column, Fault::Stamp),
        LogReason::NoReading { column, .. } => (column, Fault::Beyond),
        LogReason::WrongField { column, found, .. } if found.is_empty() => (column, Fault::Nothing),
        LogReason::WrongField {
            column, expected, ..
        } => (column, Fault::Not(expected)),
        _ => return None,
    };
    Some((column.clone(), fault))
}
