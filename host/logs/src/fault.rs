//! Faults of rows and cells, for those that put them together or read on behind them.

use crate::error::{Place, Problem};
use crate::output::shortened;

/// What to do about commas that are both decimal point and separator.
pub(super) const DECIMAL_COMMAS: &str = "export with ; between the fields, or with decimal points";

/// What is wrong with a row as a whole.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum RowFault {
    /// Bytes that are no UTF-8, of which this is the first.
    NoText(u8),
    /// Too few or too many fields.
    Fields { found: usize, expected: usize },
}

impl RowFault {
    /// In words.
    pub fn problem(self) -> Problem {
        match self {
            RowFault::NoText(byte) => Problem::new(
                format!("not UTF-8: byte 0x{byte:02x}"),
                "save the log as UTF-8 text",
            ),
            RowFault::Fields { found, expected } => Problem::new(
                format!("{found} fields where the header has {expected}"),
                "the line is broken off or joined with another: delete it, or record again",
            ),
        }
    }
}

/// In which way a cell is wrong, or the fields of a row.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum CellFault {
    /// A time stamp where the model declares numbers.
    Stamp,
    /// Nothing where something is needed.
    Nothing,
    /// A number that no sensor gives.
    Beyond,
    /// As many fields as the header has not.
    Fields,
    /// Not what is expected.
    Not(&'static str),
}

/// A column, and in which way a cell of it is wrong: cells that are wrong alike are one finding.
#[derive(Debug, Clone)]
pub(super) struct WrongCell {
    /// Nothing of the fields of a row.
    pub column: String,
    pub fault: CellFault,
    /// The remedy where it is the whole column's, if it is another one then.
    pub of_column: Option<&'static str>,
}

/// What is wrong with a log, and where.
#[derive(Debug, Clone)]
pub(super) struct LogFault {
    pub place: Place,
    pub problem: Problem,
    /// The cell that it is about, if it is about one.
    pub cell: Option<WrongCell>,
}

impl LogFault {
    /// About no cell.
    pub fn new(place: Place, problem: Problem) -> Self {
        LogFault {
            place,
            problem,
            cell: None,
        }
    }
}

/// What a field holds, up to 40 characters.
pub(super) fn quoted(text: &str) -> String {
    match text {
        "" => "nothing".to_string(),
        text => format!("'{}'", shortened(text)),
    }
}
