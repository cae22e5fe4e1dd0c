//! Cells and rows that cannot be read: those of one column that are wrong in one way are one
//! finding, and so are rows of another number of fields.

use super::finding::Findings;
use crate::LogReason;
use crate::error::{Error, Place, Result};
use std::collections::BTreeMap;

/// Lines that are named beside the first.
const NAMED: usize = 8;
/// A column is wrong as a whole where so many of ten rows are wrong in it alike.
const OF_TEN: usize = 9;

/// What is wrong with a cell.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Fault {
    Stamp,
    Nothing,
    Beyond,
    Fields,
    Not(&'static str),
}

/// Cells of one column that are wrong in one way.
#[derive(Debug, Default)]
struct Alike {
    cells: usize,
    first: Option<(Place, LogReason)>,
    /// Lines of those after the first, some of them.
    lines: Vec<usize>,
}

/// Running account of the rows of a file.
#[derive(Debug, Default)]
pub(super) struct WrongCells {
    alike: BTreeMap<(String, Fault), Alike>,
}

impl WrongCells {
    /// Takes the error of a row; gives it back if it is about no single cell.
    pub fn take(&mut self, error: Error) -> Result<()> {
        let reason = error.reason::<LogReason>().cloned();
        let key = reason.as_ref().and_then(key);
        let (Error::Data { place, .. }, Some(reason), Some(key)) = (&error, reason, key) else {
            return Err(error);
        };
        let alike = self.alike.entry(key).or_default();
        alike.cells += 1;
        match (&alike.first, place.line) {
            (None, _) => alike.first = Some((place.clone(), reason)),
            (Some(_), Some(line)) if alike.lines.len() < NAMED => alike.lines.push(line),
            _ => {}
        }
        Ok(())
    }

    /// Ends a file of so many rows: whether a column as a whole is refused.
    pub fn close(self, rows: usize, findings: &mut Findings) -> bool {
        let is_whole = |alike: &Alike| alike.cells > 1 && 10 * alike.cells >= OF_TEN * rows;
        let (whole, single): (Vec<Alike>, Vec<Alike>) =
            self.alike.into_values().partition(is_whole);
        let any = !whole.is_empty();
        for Alike { cells, first, .. } in whole {
            if let Some((place, cell)) = first {
                let (cell, more) = (Box::new(cell), cells - 1);
                findings.refuse("column", place, &LogReason::WrongColumn { cell, more });
            }
        }
        let mut single: Vec<_> = single
            .into_iter()
            .filter_map(
                |Alike {
                     cells,
                     first,
                     lines,
                 }| Some((first?, cells, lines)),
            )
            .collect();
        single.sort_by_key(|((place, _), ..)| place.line);
        for ((place, cell), cells, lines) in single {
            let reason = match cells {
                1 => cell,
                cells => LogReason::WrongCells {
                    cell: Box::new(cell),
                    more: cells - 1,
                    lines,
                },
            };
            findings.refuse("cell", place, &reason);
        }
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
        LogReason::FieldCount { .. } => return Some((String::new(), Fault::Fields)),
        _ => return None,
    };
    Some((column.clone(), fault))
}
