//! Runs of robots that are all a little different, chunk by chunk.
//!
//! Run `i` depends on the study and on `i` alone: not on the thread, the chunk's neighbours or the shard.

use super::case::Case;
use super::parse::Study;
use crate::closed_loop::{ClosedLoop, Controller, Job, Outcome, Start, run_jobs, stream};
use crate::error::Result;
use nalgebra::DMatrix;
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
    let figures = ["fell_s"].into_iter().chain(super::summary::FIGURES);
    std::iter::once("run".to_string())
        .chain(starts)
        .chain(drawn)
        .chain(std::iter::once("spectral_radius".to_string()))
        .chain(figures.map(str::to_string))
        .collect()
}

/// One run, ready to go.
struct Drawn {
    closed: ClosedLoop,
    controller: Box<dyn Controller>,
    start: Start,
    values: Vec<f64>,
    spectral_radius: Option<f64>,
}

/// Rows of a chunk, lines of comma-separated values; `gains` are [`Case::gains`] of the study's case.
///
/// # Errors
/// Robots that cannot be simulated.
pub fn chunk_rows(study: &Study, gains: &DMatrix<f64>, chunk: usize) -> Result<String> {
    let runs = chunk * CHUNK..((chunk + 1) * CHUNK).min(study.judging.runs);
    let drawn = runs
        .clone()
        .map(|run| draw(study, gains, run as u64))
        .collect::<Result<Vec<_>>>()?;
    // Chances during the run are apart from those that made the robot.
    let jobs = runs.clone().zip(&drawn).map(|(run, drawn)| Job {
        closed: &drawn.closed,
        controller: &*drawn.controller,
        start: drawn.start.clone(),
        seconds: study.judging.seconds,
        rng: stream(!study.judging.seed, run as u64),
    });
    let outcomes = run_jobs(jobs);
    let mut rows = String::new();
    for ((run, drawn), outcome) in runs.zip(&drawn).zip(&outcomes) {
        row(&mut rows, run, drawn, outcome);
    }
    Ok(rows)
}

fn draw(study: &Study, gains: &DMatrix<f64>, run: u64) -> Result<Drawn> {
    let mut rng = stream(study.judging.seed, run);
    let mut case: Case = study.case.clone();
    let start = Start::random(case.robot.link_count(), study.judging.start_rad, &mut rng);
    let values: Vec<f64> = study.uncertain.iter().map(|u| u.draw(&mut rng)).collect();
    for (uncertain, value) in study.uncertain.iter().zip(&values) {
        uncertain.apply(&mut case, *value);
    }
    let closed = case.closed_loop(study.judging.fall_rad)?;
    Ok(Drawn {
        controller: case.controller(gains, &closed)?,
        spectral_radius: case.spectral_radius(gains, &closed),
        closed,
        start,
        values,
    })
}

fn row(rows: &mut String, run: usize, drawn: &Drawn, outcome: &Outcome) {
    let given = drawn
        .start
        .angle_rad
        .iter()
        .chain(&drawn.values)
        .copied()
        .map(Some);
    let found = [
        drawn.spectral_radius,
        outcome.fell_s,
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
