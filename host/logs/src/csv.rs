//! Streams a CSV log row by row, in memory that does not grow with it.

use super::header::{LogHeader, comment};
use super::lines::Lines;
use super::row::LogRow;
use super::row_reader::RowReader;
use super::visit::FileFacts;
use crate::error::Result;
use crate::model::LogColumns;
use std::path::Path;

/// Hands every data row of a CSV log to `visitor`, with its number counted from 0.
///
/// A row that cannot be read arrives as an error with file, line and column; the visitor decides
/// whether that ends the reading. The separator (`,`, `;`, tab, `|`, blanks) comes from the header
/// line; byte-order mark, CR LF, quotes, blank lines, `#` and `%` comments are taken as they come.
///
/// # Errors
/// What the visitor returns; a file that cannot be opened, is empty, or lacks a column.
pub(super) fn visit(
    path: &Path,
    columns: &LogColumns,
    visitor: &mut dyn FnMut(usize, Result<&LogRow>) -> Result<()>,
) -> Result<FileFacts> {
    let mut lines = Lines::open(path)?;
    let (header, first) = LogHeader::read(path, &mut lines, Some(&columns.time.name))?;
    let reader = RowReader::new(path, columns, &header)?;
    let mut row = LogRow {
        path: path.to_path_buf(),
        fields: reader.fields(),
        ..LogRow::default()
    };
    let mut rows = 0;
    let mut give = |text: &str, at: usize| {
        row.line = at;
        let filled = reader.fill(text, at, &mut row);
        rows += 1;
        visitor(rows - 1, filled.map(|()| &row))
    };
    if let Some(text) = first {
        give(&text, lines.number)?;
    }
    loop {
        let at = lines.number + 1;
        match lines.next()? {
            None => break,
            Some(text) if text.trim().is_empty() || comment(text).is_some() => {}
            Some(text) => give(text, at)?,
        }
    }
    Ok(FileFacts {
        sha256: lines.sha256(),
        rows,
        warning: None,
    })
}
