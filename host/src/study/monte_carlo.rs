//! Runs of robots that are all a little different, chunk by chunk.
//!
//! Run `i` depends on the study and on `i` alone: not on the thread, the chunk's neighbours or the
//! shard.

use super::case::Designed;
use super::judge::{Drawn, run_drawn};
use super::parse::Study;
use crate::error::Result;
use crate::sim::closed_loop::Outcome;
use std::fmt::Write as _;

/// Runs in a chunk: what is lost at most when a run is killed, for each thread.
pub const CHUNK: usize = 256;

/// Number of chunks of a study.
pub fn chunks(study: &Study) -> usize {
    study.judging.runs.div_ceil(CHUNK)
}

/// Columns of the rows.
pub fn columns(study: &Study) -> Vec<String> {
    let joints = study.case.robot.link_count();
    let starts = (1..=joints).map(|joint| format!("start{joint}_rad"));
    let drawn = study.uncertain.iter().map(|uncertain| uncertain.column());
    let figures = ["fell_s", "stabilised"]
        .into_iter()
        .chain(super::summary::FIGURES);
    std::iter::once("run".to_string())
        .chain(starts)
        .chain(drawn)
        .chain(std::iter::once("spectral_radius".to_string()))
        .chain(figures.map(str::to_string))
        .collect()
}

/// Rows of a chunk, lines of comma-separated values; `designed` is
/// [`Case::designed`](super::Case::designed) of the study's case.
///
/// # Errors
/// Robots that cannot be simulated.
pub fn chunk_rows(study: &Study, designed: &Designed, chunk: usize) -> Result<String> {
    let first = chunk * CHUNK;
    let runs = first..(first + CHUNK).min(study.judging.runs);
    let drawn = runs
        .clone()
        .map(|run| Drawn::new(&study.case, &study.uncertain, &study.judging, run as u64))
        .collect::<Result<Vec<_>>>()?;
    let outcomes = run_drawn(&drawn, designed, &study.judging, first);
    let mut rows = String::new();
    for ((run, drawn), outcome) in runs.zip(&drawn).zip(&outcomes) {
        let radius = drawn.case.spectral_radius(designed, &drawn.closed);
        row(&mut rows, run, drawn, radius, outcome);
    }
    Ok(rows)
}

fn row(rows: &mut String, run: usize, drawn: &Drawn, radius: Option<f64>, outcome: &Outcome) {
    let given = drawn
        .start
        .angle_rad
        .iter()
        .chain(&drawn.values)
        .copied()
        .map(Some);
    let found = [
        radius,
        outcome.fell_s,
        Some(f64::from(u8::from(outcome.stabilised))),
        Some(outcome.rms_angle_rad),
        Some(outcome.rms_torque_nm),
        Some(outcome.largest_rad),
        outcome.limit_cycle_rad,
        outcome.settle_s,
    ];
    let _ = write!(rows, "{run}");
    for value in given.chain(found) {
        let _ = match value {
            Some(value) => write!(rows, ",{value}"),
            None => write!(rows, ","),
        };
    }
    rows.push('\n');
}
