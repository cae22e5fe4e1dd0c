//! Measurement logs: one reader for every format, quality check, training and held-out motions.

mod bam;
#[cfg(feature = "ros")]
pub mod cdr;
mod cell;
pub mod check;
mod csv;
mod cut;
mod fault;
mod folder;
mod foreign;
mod format;
mod header;
pub mod init;
mod iso;
mod layout;
pub mod lerobot;
mod lines;
mod log_set;
#[cfg(feature = "ros")]
pub mod mcap_messages;
mod merge;
#[cfg(feature = "parquet")]
mod quietly;
mod raw;
mod read;
mod reading_limit;
mod request;
mod row;
mod row_reader;
mod same_rows;
mod short;
mod standard_input;
mod table;
mod write;

#[cfg(test)]
pub(crate) mod tests;

use handstand_model::{error, model, motion, output};

pub use bam::BenchFigures;
pub use check::{LogFinding, Proof, Severity, check};
pub use folder::{expanded, unfolded};
pub use format::LogFormat;
pub use init::time_si;
pub use lerobot::DatasetFacts;
pub use log_set::LogSet;
pub use merge::{Alignment, MergePlan, MergedLog, merge};
pub use raw::RawLog;
pub use read::{LEAST_ROWS, read, read_with_findings};
pub use request::LogRequest;
pub use write::to_csv;
