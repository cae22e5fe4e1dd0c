//! Apache Parquet, as pandas, polars, Arrow and data sets of robots write it.
//!
//! Numbers and truth values are columns of their names, lists of one length `NAME_1`, `NAME_2`, ..,
//! fields of a structure `NAME.FIELD`; moments count in s from the first. A null is a gap. Text,
//! bytes, maps, lists within lists and lists of different lengths are left out.

mod column;
mod judge;
mod leaf;
mod pages;

use super::{LogTable, MOST_CELLS, TableFile};
use crate::quietly::quietly_caught;
use bytes::Bytes;
use column::{ParquetSource, columns};
use leaf::leaves;
use pages::{CellsLeft, broken};
use parquet::errors::ParquetError;
use parquet::file::metadata::ParquetMetaDataReader;
use rayon::prelude::*;

/// At both ends of a file.
const MAGIC: &[u8] = b"PAR1";
/// In its place at the end of an encrypted one.
const ENCRYPTED: &[u8] = b"PARE";
/// Numbers that any file may hold, and that it may hold per byte: runs of one value take few bytes.
const FEW_CELLS: usize = 1_000_000;
const CELLS_PER_BYTE: usize = 1024;

pub(super) fn read(bytes: Bytes, file: TableFile) -> crate::error::Result<LogTable> {
    let remedy = "write it again, or as CSV, in Python: \
                  pandas.read_parquet(\"a.parquet\").to_csv(\"a.csv\", index=False)";
    let metadata = metadata(&bytes).map_err(|what| file.wrong(what, remedy))?;
    let refused = |error: ParquetError| file.wrong(format!("broken: {}", said(error)), remedy);
    judge::judge(metadata).map_err(|why| refused(broken(why)))?;
    let metadata = caught(|| ParquetMetaDataReader::decode_metadata(metadata)).map_err(refused)?;
    let leaves = leaves(metadata.file_metadata().schema());
    let cells = FEW_CELLS.saturating_add(bytes.len().saturating_mul(CELLS_PER_BYTE));
    let source = ParquetSource {
        bytes,
        metadata,
        cells_left: CellsLeft::new(cells.min(MOST_CELLS)),
    };
    let read: Vec<_> = leaves
        .par_iter()
        .enumerate()
        .map(|(index, leaf)| caught(|| columns(&source, leaf, index)))
        .collect();
    let mut table = LogTable::default();
    for (leaf, columns) in leaves.into_iter().zip(read) {
        match columns.map_err(refused)? {
            Err(why) => table.left_out.push((leaf.name, why.into())),
            Ok(columns) => {
                let names = (1..).map(|place| match leaf.element_level {
                    Some(_) => format!("{}_{place}", leaf.name),
                    None => leaf.name.clone(),
                });
                table.names.extend(names.take(columns.len()));
                table.columns.extend(columns);
            }
        }
    }
    let rows = table.rows();
    if table.columns.iter().any(|column| column.len() != rows) {
        return Err(refused(broken("its columns hold different counts of rows")));
    }
    if table.names.is_empty() {
        Err(file.wrong("no column holds numbers", "save time and angles as numbers"))
    } else {
        Ok(table)
    }
}

/// What the end of a file says of it.
fn metadata(bytes: &[u8]) -> Result<&[u8], &'static str> {
    let tail = bytes.split_last_chunk::<4>();
    let (rest, magic) = tail.ok_or("not a Parquet file")?;
    if magic == ENCRYPTED {
        return Err("an encrypted Parquet file");
    }
    if magic != MAGIC || !bytes.starts_with(MAGIC) {
        return Err("not a whole Parquet file");
    }
    let (rest, length) = rest.split_last_chunk::<4>().ok_or("not a Parquet file")?;
    let start = rest.len().checked_sub(u32::from_le_bytes(*length) as usize);
    start
        .map(|start| &rest[start..])
        .ok_or("a Parquet file that is cut short")
}

/// What the library reads; where bytes make it panic, they are broken.
fn caught<T>(read: impl FnOnce() -> Result<T, ParquetError>) -> Result<T, ParquetError> {
    quietly_caught(read).unwrap_or_else(|| Err(broken("its values are not written as it says")))
}

/// What is wrong, without the kind of error before it.
fn said(error: ParquetError) -> String {
    match error {
        ParquetError::General(why) | ParquetError::EOF(why) => why,
        other => other.to_string(),
    }
}
