//! Measurement logs: CSV and JSON readers, quality check, training and held-out motions.

mod bam;
pub(crate) mod cdr;
pub mod check;
mod csv;
mod header;
mod holdout;
pub mod init;
mod iso;
mod lines;
mod log_set;
mod motion;
mod raw;
mod read;
mod reason;
mod request;
mod row;
mod row_reader;
mod shift;
mod write;

#[cfg(test)]
mod tests;

pub use check::{LogFinding, Proof, Severity, check};
pub use csv::{FileFacts, visit};
pub use holdout::{Split, split};
pub use log_set::LogSet;
pub use motion::{Motion, MotionSource};
pub use raw::RawLog;
pub use read::{LEAST_ROWS, read};
pub use reason::LogReason;
pub use request::LogRequest;
pub use row::{Fields, LogRow};
pub use write::to_csv;
