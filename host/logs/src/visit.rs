//! Hands a log's rows over one by one, whatever its format.

use super::bam::{self, BamBench};
use super::csv;
use super::format::LogFormat;
use super::header::LogHeader;
use super::request::LogRequest;
use super::row::LogRow;
use super::row_reader::RowReader;
use super::table::LogTable;
use super::{LogFinding, Severity};
use crate::error::{Place, Result};
use crate::model::LogColumns;
use std::path::Path;

/// What is known of a file once it has been read through.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct FileFacts {
    /// SHA-256 of all its bytes, lower-case hexadecimal.
    pub sha256: String,
    /// Data rows, unreadable ones included.
    pub rows: usize,
    /// What looks wrong with the file as a whole, and what to do about it.
    pub warning: Option<(&'static str, &'static str)>,
}

impl FileFacts {
    /// What looks wrong with this file, as a finding.
    pub fn finding(&self, path: &Path) -> Option<LogFinding> {
        let (what, remedy) = self.warning?;
        Some(LogFinding {
            kind: "file",
            severity: Severity::Warn,
            place: Some(Place::file(path)),
            what: what.to_string(),
            remedy: remedy.to_string(),
            proof: None,
        })
    }
}

/// Hands every data row of a log to `visitor`, with its number counted from 0.
///
/// Of formats other than CSV a row's line is its number, counted from 1. A row that cannot be read
/// arrives as an error with file, line and column; the visitor decides whether that ends the
/// reading.
///
/// # Errors
/// What the visitor returns; a file that cannot be opened, is empty, or lacks a column.
pub(super) fn visit(
    request: &LogRequest,
    columns: &LogColumns,
    bench: &mut BamBench,
    visitor: &mut dyn FnMut(usize, Result<&LogRow>) -> Result<()>,
) -> Result<FileFacts> {
    let path = &request.path;
    let format = match LogFormat::of(path) {
        LogFormat::Csv => return csv::visit(path, columns, visitor),
        LogFormat::Bam => return bam::visit(request, columns, bench, visitor),
        format => format,
    };
    let table = LogTable::read(path, format, Some(&columns.time.name))?;
    let header = LogHeader::of_table(path, &table);
    let reader = RowReader::new(path, columns, &header)?;
    let mut row = LogRow {
        path: path.clone(),
        fields: reader.fields(),
        ..LogRow::default()
    };
    for number in 0..table.rows() {
        row.line = number + 1;
        let filled = reader.fill_numbers(&table.columns, number, &mut row);
        visitor(number, filled.map(|()| &row))?;
    }
    Ok(FileFacts {
        rows: table.rows(),
        sha256: table.sha256,
        warning: table.warning,
    })
}
