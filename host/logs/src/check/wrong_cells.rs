//! Cells and rows that cannot be read: those of one column that are wrong in one way are one
//! finding, and so are rows of another number of fields.

use super::finding::Findings;
use crate::error::{Place, Problem};
use crate::fault::{CellFault, WrongCell};
use std::collections::BTreeMap;

/// Lines that are named beside the first.
const NAMED: usize = 8;
/// A column is wrong as a whole where so many of ten rows are wrong in it alike.
const OF_TEN: usize = 9;

/// Cells of one column that are wrong in one way.
#[derive(Debug, Default)]
struct Alike {
    cells: usize,
    first: Option<(Place, Problem)>,
    /// The remedy where they are the whole column, if it is another one then.
    of_column: Option<&'static str>,
    /// Lines of those after the first, some of them.
    lines: Vec<usize>,
}

/// Running account of the rows of a file.
#[derive(Debug, Default)]
pub(super) struct WrongCells {
    alike: BTreeMap<(String, CellFault), Alike>,
}

impl WrongCells {
    /// Takes a cell that is wrong.
    pub fn take(&mut self, place: Place, problem: Problem, cell: WrongCell) {
        let alike = self.alike.entry((cell.column, cell.fault)).or_default();
        alike.cells += 1;
        match place.line {
            _ if alike.first.is_none() => {
                alike.first = Some((place, problem));
                alike.of_column = cell.of_column;
            }
            Some(line) if alike.lines.len() < NAMED => alike.lines.push(line),
            _ => {}
        }
    }

    /// Ends a file of so many rows: whether a column as a whole is refused.
    pub fn close(self, rows: usize, findings: &mut Findings) -> bool {
        let is_whole = |alike: &Alike| alike.cells > 1 && 10 * alike.cells >= OF_TEN * rows;
        let (whole, single): (Vec<Alike>, Vec<Alike>) =
            self.alike.into_values().partition(is_whole);
        let any = !whole.is_empty();
        for alike in whole {
            if let Some((place, mut problem)) = alike.first {
                let more = alike.cells - 1;
                let lines = if more == 1 { "line" } else { "lines" };
                problem.what += &format!("; and {more} more {lines} like it");
                if let Some(remedy) = alike.of_column {
                    problem.remedy = remedy.to_string();
                }
                findings.refuse("column", place, &problem);
            }
        }
        let mut single: Vec<_> = single
            .into_iter()
            .filter_map(|alike| Some((alike.first?, alike.cells, alike.lines)))
            .collect();
        single.sort_by_key(|((place, _), ..)| place.line);
        for ((place, mut problem), cells, lines) in single {
            if cells > 1 {
                let (more, lines) = (cells - 1, of_lines(&lines, cells - 1));
                problem.what += &format!("; and {more} more like it, in {lines}");
            }
            findings.refuse("cell", place, &problem);
        }
        any
    }
}

/// "lines 5, 9, .."
fn of_lines(lines: &[usize], more: usize) -> String {
    let named: Vec<String> = lines.iter().map(usize::to_string).collect();
    let rest = if more > lines.len() { ", .." } else { "" };
    let word = if more == 1 { "line" } else { "lines" };
    format!("{word} {}{rest}", named.join(", "))
}
