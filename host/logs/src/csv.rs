//! Reads a CSV log into a table.

use super::cell::{is_missing, number};
use super::fault::RowFault;
use super::header::{LogHeader, comment, fields, surplus};
use super::iso::iso_ns;
use super::lines::{Lines, NoText};
use super::table::{LogTable, MOST_CELLS, TableFile, TextCells};
use crate::error::Result;
use crate::model::LogColumns;
use std::path::Path;

/// Numbers from here on are kept as they are written, for none that is refused as no reading is
/// much smaller.
const KEPT_AS_WRITTEN: f64 = 1e5;

/// Reads a CSV log. Where a model's columns are known, the header must hold their time, and cells
/// of flags, segments and stamps are kept as they are written.
///
/// The separator (`,`, `;`, tab, `|`, blanks) comes from the header line; byte-order mark, CR LF,
/// quotes, blank lines, `#` and `%` comments are taken as they come. A row of too few fields has
/// gaps, one of too many loses them; both are faults of the row, as is a byte that is no UTF-8.
///
/// # Errors
/// A file that cannot be opened, is empty or no text, or has no fitting header.
pub(super) fn read(path: &Path, columns: Option<&LogColumns>) -> Result<LogTable> {
    let mut lines = Lines::open(path)?;
    let time = columns.map(|columns| columns.time.name.as_str());
    let (header, first) = LogHeader::read(path, &mut lines, time)?;
    let mut rows = CsvRows::of(header, columns);
    if let Some(line) = first {
        rows.take(&line, lines.number);
    }
    loop {
        let at = lines.number + 1;
        match lines.next_line()? {
            None => break,
            Some(Ok(line)) if line.trim().is_empty() || comment(line).is_some() => {}
            Some(Ok(line)) => rows.take(line, at),
            Some(Err(no_text)) => rows.broken(&no_text, at),
        }
        if rows.cells() > MOST_CELLS.max(lines.bytes) {
            let remedy = "look at its rows: most have fewer fields than there are names";
            return Err(TableFile { path }.wrong(format!("more than {MOST_CELLS} numbers"), remedy));
        }
    }
    Ok(LogTable {
        sha256: lines.sha256(),
        ..rows.table
    })
}

/// Rows of text as they become columns.
struct CsvRows {
    table: LogTable,
    /// Columns whose cells are kept as they are written.
    as_written: Vec<bool>,
    /// The first time stamp of each column that holds them, ns.
    first_ns: Vec<Option<i64>>,
}

impl CsvRows {
    fn of(header: LogHeader, columns: Option<&LogColumns>) -> Self {
        let width = header.names.len();
        let stamps = |columns: &LogColumns| {
            let is_stamp = columns.time.unit.name == "iso8601";
            is_stamp.then(|| columns.time.name.clone())
        };
        let kept: Vec<String> = columns.map_or_else(Vec::new, |all| {
            let flags = [&all.segment, &all.torque_on, &all.turned];
            flags
                .into_iter()
                .flatten()
                .cloned()
                .chain(stamps(all))
                .collect()
        });
        let as_written = |name| kept.contains(name);
        CsvRows {
            as_written: header.names.iter().map(as_written).collect(),
            first_ns: vec![None; width],
            table: LogTable {
                text: Some(TextCells::of(header.separator, header.line, width)),
                names: header.names,
                columns: vec![Vec::new(); width],
                constants: header.constants,
                ..LogTable::default()
            },
        }
    }

    fn cells(&self) -> usize {
        self.table.rows() * self.table.names.len()
    }

    fn take(&mut self, line: &str, at: usize) {
        let Some(text) = &mut self.table.text else {
            return;
        };
        let separator = text.separator;
        let mut cells = fields(line, separator);
        let (found, expected) = (cells.len(), self.table.names.len());
        if surplus(&mut cells, &self.table.names) {
            text.fault(
                found.min(expected) + 1,
                RowFault::Fields { found, expected },
            );
        }
        let row = text.begin_row(at);
        for (index, column) in self.table.columns.iter_mut().enumerate() {
            let cell = cells.get(index).map_or("", |cell| cell);
            let plain = number(cell, separator);
            let is_odd = match plain {
                None => !cell.is_empty(),
                Some(value) if value.abs() < KEPT_AS_WRITTEN => self.as_written[index],
                Some(value) => value.is_nan() || value.to_string() != cell,
            };
            if is_odd {
                let is_word = plain.is_none() && !is_missing(cell);
                let begins = row == 0 || self.first_ns[index].is_some();
                let stamp_ns = (is_word && begins).then(|| iso_ns(cell)).flatten();
                text.keep(row, index, cell, is_word && stamp_ns.is_none());
                if let Some(stamp_ns) = stamp_ns {
                    let first_ns = *self.first_ns[index].get_or_insert(stamp_ns);
                    text.iso[index] = true;
                    column.push(stamp_ns.saturating_sub(first_ns) as f64 / 1e9);
                    continue;
                }
            }
            column.push(plain.unwrap_or(f64::NAN));
        }
    }

    /// Takes a row that is no UTF-8, of which nothing can be read.
    fn broken(&mut self, NoText { place, fault }: &NoText, at: usize) {
        let Some(text) = &mut self.table.text else {
            return;
        };
        text.fault(place.column.unwrap_or(1), *fault);
        text.begin_row(at);
        for column in &mut self.table.columns {
            column.push(f64::NAN);
        }
    }
}
