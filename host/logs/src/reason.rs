//! Why a log is refused: the data, its sentence, and the remedy.

mod words;

use super::LEAST_ROWS;
use super::cell::decimal_comma;
use super::lines::LONGEST_LINE;
use super::reading_limit::LARGEST_READING;
use crate::error::Reason;
use crate::output::shortened;
use std::borrow::Cow;
use words::{and_no, listed, meant, of_column, of_lines, quoted, scientific, short};

/// What a field with a time stamp must be.
pub(super) const STAMP: &str = "a time stamp such as 2026-03-01T12:00:00.5Z";
/// What a flag must be.
pub(super) const FLAG: &str = "0 or 1";

/// What is wrong with a file, a row, a field, or the order of rows of a log.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum LogReason {
    /// A line too long for a log.
    #[error("a line longer than {LONGEST_LINE} bytes")]
    LineTooLong,
    /// Bytes that are no text.
    #[error("not UTF-8: byte 0x{byte:02x}")]
    NotUtf8 {
        /// The first such byte.
        byte: u8,
    },
    /// No line of column names.
    #[error("the log holds no header line")]
    NoHeader,
    /// Numbers where the column names should be.
    #[error("numbers where the column names should be{}", and_no(column))]
    NoNames {
        /// A column that the model reads, where there is a model.
        column: Option<String>,
    },
    /// Column names below lines of another kind.
    #[error("this names no columns of the rows; line {line} looks like the line of column names")]
    NamesBelow {
        /// Line that looks like the names.
        line: usize,
    },
    /// A row of words between names and numbers.
    #[error("a row of words between the column names and the numbers, of units perhaps")]
    UnitsRow,
    /// As many names as there are no fields.
    #[error("the line of column names has {names}, the rows have {fields} fields")]
    NamesAndFields {
        /// Names in the header.
        names: usize,
        /// Fields of most rows.
        fields: usize,
    },
    /// Commas that are both decimal point and separator.
    #[error("decimal commas in fields that commas separate")]
    DecimalCommas,
    /// A column that the log does not have.
    #[error(
        "no column '{column}'{} The log has: {}",
        meant(nearest),
        listed(found)
    )]
    NoColumn {
        /// The column that the model reads.
        column: String,
        /// The log's column most like it.
        nearest: Option<String>,
        /// The log's columns.
        found: Vec<String>,
    },
    /// A column that holds something else than a number a row.
    #[error("column '{column}' holds {holds}")]
    ColumnLeftOut {
        /// Its name.
        column: String,
        /// What it holds.
        holds: Cow<'static, str>,
    },
    /// A column that the log has twice.
    #[error("column '{column}' stands there twice")]
    ColumnTwice {
        /// Its name.
        column: String,
    },
    /// A row with too few or too many fields.
    #[error("{found} fields where the header has {expected}")]
    FieldCount {
        /// Fields of the row.
        found: usize,
        /// Fields of the header.
        expected: usize,
    },
    /// A field that holds something else.
    #[error("{column}: {} is not {expected}", quoted(found))]
    WrongField {
        /// The column.
        column: String,
        /// What the field holds.
        found: String,
        /// What it must be.
        expected: &'static str,
    },
    /// A time stamp where the model declares numbers.
    #[error("{column}: {} is a time stamp, not a number", quoted(found))]
    TimeStamp {
        /// The column.
        column: String,
        /// What the field holds.
        found: String,
    },
    /// A column hardly a row of which can be read.
    #[error("{cell}; and {more} more {} like it", if *more == 1 { "line" } else { "lines" })]
    WrongColumn {
        /// What is wrong with the first of its cells.
        cell: Box<LogReason>,
        /// Rows of which the same is wrong, beside the first.
        more: usize,
    },
    /// Cells, or rows, that are wrong in one way.
    #[error("{cell}; and {more} more like it, in {}", of_lines(lines, *more))]
    WrongCells {
        /// What is wrong with the first of them.
        cell: Box<LogReason>,
        /// How many there are beside the first.
        more: usize,
        /// Lines of the first of these.
        lines: Vec<usize>,
    },
    /// A number that no sensor of a joint gives.
    #[error(
        "{column}: {} is {} {unit}, beyond the {LARGEST_READING:.0} {unit} that a reading may be",
        quoted(found),
        scientific(*si)
    )]
    NoReading {
        /// The column.
        column: String,
        /// What the field holds.
        found: String,
        /// That in SI.
        si: f64,
        /// The SI unit.
        unit: &'static str,
    },
    /// A column that holds no value throughout a motion.
    #[error("{column} holds no value in {motion}")]
    EmptyColumn {
        /// The column.
        column: String,
        /// The motion.
        motion: String,
    },
    /// Time that does not increase.
    #[error("time does not increase: {} s after {} s", short(*time_s), short(*previous_s))]
    TimeNotIncreasing {
        /// Time of the row.
        time_s: f64,
        /// Time of the row before it.
        previous_s: f64,
    },
    /// A gap too long to be simulated.
    #[error(
        "time jumps from {} s to {} s within a motion",
        short(*previous_s),
        short(*time_s)
    )]
    TimeJumps {
        /// Time of the row.
        time_s: f64,
        /// Time of the row before it.
        previous_s: f64,
    },
    /// A payload that changes within a motion.
    #[error("payload changes from {previous_kg} kg to {payload_kg} kg within a motion")]
    PayloadChanges {
        /// Payload of the row.
        payload_kg: f64,
        /// Payload of the row before it.
        previous_kg: f64,
    },
    /// A rig that is turned round within a motion.
    #[error("the rig is turned round within a motion")]
    TurnedRound,
    /// An angle that jumps by a whole turn.
    #[error("{column} jumps by a whole turn")]
    AngleWraps {
        /// Its column.
        column: String,
    },
    /// A motion of too few rows.
    #[error("a motion of {rows} rows; {LEAST_ROWS} are the least")]
    TooShort {
        /// Its rows.
        rows: usize,
    },
    /// A range beyond the last row.
    #[error("rows {first}-{last} asked for, but it has {rows} rows")]
    RowsBeyond {
        /// First row asked for, from 0.
        first: usize,
        /// Last row asked for.
        last: usize,
        /// Rows of the log.
        rows: usize,
    },
    /// No row at all.
    #[error("the log holds no sample")]
    NoSample,
    /// A JSON log that is not JSON.
    #[error("not JSON: {message}")]
    NotJson {
        /// The parser's message.
        message: String,
    },
    /// A JSON log without its list.
    #[error("no list 'entries'")]
    NoEntries,
    /// A range of entries beyond the last, or of too few.
    #[error("entries {first}-{last} of {entries}; at least {LEAST_ROWS} are needed")]
    EntryRange {
        /// First entry asked for, from 0.
        first: usize,
        /// Last entry asked for.
        last: usize,
        /// Entries of the log.
        entries: usize,
    },
    /// A value of an entry that is something else.
    #[error("entry {entry}, {key}: {found} is not {expected}")]
    WrongEntry {
        /// The entry, from 0.
        entry: usize,
        /// Its key.
        key: &'static str,
        /// What it holds.
        found: String,
        /// What it must be.
        expected: &'static str,
    },
    /// An entry whose time does not increase.
    #[error("entry {entry}, timestamp: time does not increase: {time_s} s after {previous_s} s")]
    EntryTime {
        /// The entry, from 0.
        entry: usize,
        /// Its time.
        time_s: f64,
        /// Time of the entry before it.
        previous_s: f64,
    },
    /// A fact of the run that the model's payload is, and that the log does not say.
    #[error(
        "no number '{}' beside the entries, which the model's payload is",
        shortened(key)
    )]
    NoFact {
        /// Its key.
        key: String,
    },
    /// A bench's own figures that are not the model's.
    #[error("the log's {quantity} is {found:.4} {unit}, the model has {expected:.4} {unit}")]
    OtherRig {
        /// What was compared.
        quantity: &'static str,
        /// The log's.
        found: f64,
        /// The model's.
        expected: f64,
        /// Unit of both.
        unit: &'static str,
    },
    /// Logs of one rig under different gains.
    #[error("kp is {found}, and {expected} in {first}")]
    OtherGain {
        /// The log's.
        found: f64,
        /// That of the log before.
        expected: f64,
        /// The log before.
        first: String,
    },
}

use LogReason::*;

impl LogReason {
    /// A column that holds no value throughout a motion.
    pub(super) fn empty(column: String, motion: &str) -> LogReason {
        EmptyColumn {
            column,
            motion: motion.to_string(),
        }
    }
}

impl Reason for LogReason {
    fn remedy(&self) -> Cow<'_, str> {
        Cow::Borrowed(match self {
            LineTooLong => "this is no CSV log; name a text file with one sample per line",
            NotUtf8 { .. } => "save the log as UTF-8 text",
            NoHeader => "record again: a log is a line of column names, then a line per sample",
            NoNames { .. } => {
                "put a line of column names above the first sample, such as time_s,angle_rad"
            }
            NamesBelow { line } => {
                return format!("delete the lines above line {line}, or begin each of them with #")
                    .into();
            }
            UnitsRow => "delete this line; units stand in the names: angle [deg], angle_deg",
            NamesAndFields { names, fields } if names < fields => {
                "name every column in the header, in the order of the fields"
            }
            NamesAndFields { .. } => {
                "the names have another separator than the fields, or name columns that are not \
                 there: mend the header"
            }
            DecimalCommas => "export with ; between the fields, or with decimal points",
            NoColumn { column, .. } => {
                return format!(
                    "name the column under [log] in the model, or, if it never changes, write \
                     '# {column} = VALUE' above the header"
                )
                .into();
            }
            ColumnLeftOut { .. } => "name a column of numbers, or save this one as numbers",
            ColumnTwice { .. } => "rename one of them, so that it is clear which is meant",
            FieldCount { .. } => {
                "the line is broken off or joined with another: delete it, or record again"
            }
            WrongField { found, .. } if decimal_comma(found).is_some() => {
                return DecimalCommas.remedy();
            }
            WrongField { .. } => {
                "the model reads this column: delete the line, or leave it out by a row range \
                 such as log.csv:26-139"
            }
            TimeStamp { .. } => "write unit = \"iso8601\" for this column in the model's [log]",
            WrongColumn { cell, .. } => return of_column(cell),
            WrongCells { cell, .. } => return cell.remedy(),
            NoReading { .. } => {
                "check the column's unit in the model's [log], or in its name where there is no \
                 model; of a broken cell, delete the value, which leaves a gap"
            }
            EmptyColumn { .. } => {
                "record it (goals: by `handstand replay --record`), or take the column out of the \
                 model's [log]"
            }
            TimeNotIncreasing { time_s, previous_s } if time_s == previous_s => {
                "the clock is coarser than the rows: log times with more digits, or keep one row \
                 of each time; of rows a fixed period apart, write their number times the period"
            }
            TimeNotIncreasing { .. } => {
                "cut the log there, mark the recordings in a segment column, or name a range of \
                 rows"
            }
            TimeJumps { .. } => {
                "check the time column's unit, or set split_at_gap_s in the model's [log] to \
                 begin a new motion there"
            }
            PayloadChanges { .. } => {
                "stop the recording to change the payload, or mark motions in a segment column"
            }
            TurnedRound => {
                "stop the recording to turn the rig, or mark motions in a segment column"
            }
            AngleWraps { .. } => "the angle wraps round: log it unwrapped, or add the turns",
            TooShort { .. } => {
                "leave it out by a row range such as log.csv:26-139, or record longer"
            }
            RowsBeyond { .. } => "data rows count from 0, after the header",
            NoSample => "record again: below the column names there is no row",
            NotJson { .. } => "was the recording broken off? Record again, or export CSV",
            NoEntries => {
                "a BAM log is an object with a list 'entries'; save the records of other JSON as \
                 CSV, in Python: pandas.read_json(\"log.json\").to_csv(\"log.csv\", index=False)"
            }
            EntryRange { .. } => "entries count from 0; record longer if there are too few",
            WrongEntry { .. } => {
                "leave the entry out by a range such as log.json:0-99, or record again"
            }
            NoFact { .. } => {
                "payload = { column = \"mass\", unit = \"kg\", at_m = LENGTH } is the key of BAM"
            }
            OtherRig { .. } => {
                "mend the model's link; logs of several weights fit one model whose link is the arm \
                 alone, with payload = { column = \"mass\", unit = \"kg\", at_m = LENGTH } in its \
                 [log]"
            }
            OtherGain { .. } => "give the logs of one gain together: a model's drive has one gain",
            EntryTime { .. } => {
                "ask for a range of entries without the step, such as log.json:0-99"
            }
        })
    }
}
