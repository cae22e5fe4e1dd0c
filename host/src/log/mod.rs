//! Measurements: reading logs as rigs write them, gating them, holding motions out.

mod bam;
pub mod check;
mod csv;
mod header;
mod holdout;
mod lines;
mod motion;
mod read;
mod request;
mod row;
mod write;

#[cfg(test)]
mod fixture;
#[cfg(test)]
mod real;
#[cfg(test)]
mod tests;

pub use check::{Finding, Severity, check};
pub use csv::{FileFacts, visit};
pub use holdout::{Split, split};
pub use motion::{Motion, Source};
pub use read::{LEAST_ROWS, read};
pub use request::LogRequest;
pub use row::{Fields, Row};
pub use write::to_csv;
