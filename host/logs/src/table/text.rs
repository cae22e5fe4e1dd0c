//! What a table of text knows beyond its numbers: lines, faults, and cells as they are written.

use crate::fault::RowFault;
use std::collections::{BTreeMap, HashSet};
use std::sync::Arc;

/// Rows and cells of a text.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct TextCells {
    /// Between two fields.
    pub separator: u8,
    /// Line of the names, counted from 1.
    pub names_line: usize,
    /// Line of each row.
    pub lines: Vec<usize>,
    /// Whether a column holds ISO 8601 time stamps; its numbers count in s from the first.
    pub iso: Vec<bool>,
    /// The first cell of each column that is neither a number nor a gap.
    pub words: Vec<Option<String>>,
    /// What is wrong with a row as a whole, and the field that shows it, counted from 1.
    faults: BTreeMap<usize, (usize, RowFault)>,
    /// Of each column the cells, by row, whose number does not tell how they are written.
    written: Vec<Vec<(usize, Arc<str>)>>,
    known: HashSet<Arc<str>>,
}

impl TextCells {
    /// No row yet, under names on this line.
    pub fn of(separator: u8, names_line: usize, columns: usize) -> Self {
        TextCells {
            separator,
            names_line,
            lines: Vec::new(),
            iso: vec![false; columns],
            words: vec![None; columns],
            faults: BTreeMap::new(),
            written: vec![Vec::new(); columns],
            known: HashSet::new(),
        }
    }

    /// Says what is wrong with the row that begins next.
    pub fn fault(&mut self, field: usize, fault: RowFault) {
        self.faults.insert(self.lines.len(), (field, fault));
    }

    /// Begins a row on this line; its number, counted from 0.
    pub fn begin_row(&mut self, line: usize) -> usize {
        self.lines.push(line);
        self.lines.len() - 1
    }

    /// Keeps a cell as it is written; a word is neither a number nor a gap.
    pub fn keep(&mut self, row: usize, column: usize, cell: &str, is_word: bool) {
        if is_word && self.words[column].is_none() {
            self.words[column] = Some(cell.to_string());
        }
        let cell = match self.known.get(cell) {
            Some(known) => known.clone(),
            None => {
                let cell: Arc<str> = cell.into();
                self.known.insert(cell.clone());
                cell
            }
        };
        self.written[column].push((row, cell));
    }

    /// A cell that was kept.
    pub fn written(&self, row: usize, column: usize) -> Option<&str> {
        let cells = &self.written[column];
        let found = cells.binary_search_by_key(&row, |(row, _)| *row).ok()?;
        Some(&cells[found].1)
    }

    /// What is wrong with a row as a whole, and the field that shows it, counted from 1.
    pub fn fault_of(&self, row: usize) -> Option<(usize, RowFault)> {
        self.faults.get(&row).copied()
    }
}
