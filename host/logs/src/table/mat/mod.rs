//! MATLAB files: every numeric variable is a column, or several.
//!
//! A vector is a column of its name; a matrix with as many rows gives `q_1`, `q_2`, .. for its
//! columns. A scalar is a constant. Fields of a structure come as `data.q`. Variables of another
//! length than the time's, text, cells, complex and sparse numbers are left out, and so are objects.

mod element;
mod number;
#[cfg(test)]
mod tests;
mod variables;
mod version5;
mod version73;

use super::{LogTable, TableFile};
use crate::error::{Error, Result};
use bytes::Bytes;

/// Structures in structures, and nested compressed elements.
const DEEPEST: usize = 16;
/// Before the first element, or before HDF5's own begin.
const HEADER: usize = 128;
/// Where an HDF5 file begins.
const HDF5: &[u8] = b"\x89HDF\r\n\x1a\n";
/// What to do with a file that cannot be read.
const REMEDY: &str = "save it from MATLAB by save(\"log.mat\", .., \"-v7\"), from Python by \
                      scipy.io.savemat";

pub(super) fn read(bytes: Bytes, file: TableFile, time: Option<&str>) -> Result<LogTable> {
    let variables = if is_version73(&bytes) {
        version73::read(bytes, file)?
    } else {
        version5::read(&bytes, file)?
    };
    let (what, remedy) = variables.without_columns();
    let table = variables
        .table(time)
        .filter(|table| !table.names.is_empty());
    table.ok_or_else(|| file.wrong(what, remedy))
}

/// By the words at its begin, the version behind them, or the HDF5 file itself.
fn is_version73(bytes: &[u8]) -> bool {
    let version = bytes.get(HEADER - 4..HEADER);
    bytes.starts_with(b"MATLAB 7.3")
        || bytes.starts_with(HDF5)
        || matches!(version, Some([0, 2, b'I', b'M'] | [2, 0, b'M', b'I']))
}

fn broken(file: TableFile, why: impl std::fmt::Display) -> Error {
    file.wrong(format!("broken: {why}"), REMEDY)
}
