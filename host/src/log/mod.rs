//! Measurements: reading logs as rigs write them, gating them, holding motions out.

mod bam;
pub mod check;
mod csv;
mod header;
mod holdout;
mod lines;
mod motion;
mod read;
mod reason;
mod request;
mod row;
mod row_reader;
mod write;

#[cfg(test)]
mod tests;

pub use check::{LogFinding, Severity, check};
pub use csv::{FileFacts, visit};
pub use holdout::{Split, split};
pub use motion::{Motion, MotionSource};
pub use read::{LEAST_ROWS, read};
pub use reason::LogReason;
pub use request::LogRequest;
pub use row::{Fields, LogRow};
pub use write::to_csv;
