//! Dialects, refusals, the round trip, hostile bytes, and the real logs.

use super::*;
use crate::error::Error;
use crate::model::{ArmFigures, Column, LogColumns};
use crate::motion::Motion;
use handstand_model::fixture::{column, columns, first, model, motion, position_drive};
use proptest::prelude::*;

mod bam;
mod dialects;
mod gaps;
mod layout;
mod motions;
mod real;
mod refusals;
mod survival;
mod written;

fn file(bytes: &[u8], ending: &str) -> tempfile::NamedTempFile {
    let file = tempfile::Builder::new().suffix(ending).tempfile().unwrap();
    std::fs::write(file.path(), bytes).unwrap();
    file
}

fn read_text(text: &str, columns: &LogColumns) -> Result<Vec<Motion>, Error> {
    let file = file(text.as_bytes(), ".csv");
    read(&[LogRequest::whole(file.path())], columns)
}

/// Twelve rows `t,q,u`, below `header`.
fn rows(header: &str, separator: char) -> String {
    let mut text = format!("{header}\n");
    for i in 0..12 {
        text += &format!("0.{i:02}{separator}0.5{separator}-1\n");
    }
    text
}

fn refused(text: &str, columns: &LogColumns) -> (Option<usize>, Option<usize>, String) {
    match read_text(text, columns).unwrap_err() {
        Error::Data { place, problem } => {
            assert!(!problem.remedy.is_empty());
            (place.line, place.column, problem.what)
        }
        other => panic!("{other}"),
    }
}
