//! Runs of robots that are all a little different, chunk by chunk.
//!
//! Run `i` depends on the study and on `i` alone: not on the thread, the chunk's neighbours or the
//! shard.

use super::case::Designed;
use super::journal::Journal;
use super::judge::{Drawn, run_drawn};
use super::parse::Study;
use crate::error::{Error, Result};
use crate::output::table::or_empty;
use crate::sim::closed_loop::Outcome;
use rayon::prelude::*;
use std::sync::mpsc;

/// Runs in a chunk: what is lost at most when a run is killed, for each thread.
pub const CHUNK: usize = 256;

/// Columns of the rows.
pub(super) fn columns(study: &Study) -> Vec<String> {
    let joints = study.case.robot.link_count();
    let starts = (1..=joints).map(|joint| format!("start{joint}_rad"));
    let drawn = study.uncertain.iter().map(|uncertain| uncertain.column());
    let found = ["spectral_radius", "fell_s", "stabilised"].into_iter();
    let found = found.chain(super::summary::FIGURES).map(str::to_string);
    let run = std::iter::once("run".to_string());
    run.chain(starts).chain(drawn).chain(found).collect()
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

/// Computes chunks on all cores and adds them to the journal as they come; `done` is called after
/// each.
///
/// # Errors
/// Robots that cannot be simulated, a journal that cannot be written.
pub fn fill(
    journal: &mut Journal,
    study: &Study,
    designed: &Designed,
    chunks: &[usize],
    mut done: impl FnMut(),
) -> Result<()> {
    let (send, receive) = mpsc::channel();
    std::thread::scope(|scope| {
        let computing = scope.spawn(move || {
            chunks.par_iter().try_for_each_with(send, |send, &chunk| {
                let rows = chunk_rows(study, designed, chunk)?;
                // Nobody listens any more after a write has failed.
                send.send((chunk, rows))
                    .map_err(|_| Error::usage("writing has stopped", "see the error before"))
            })
        });
        // Taken by value: once this loop ends early, the computing stops.
        let written = receive.into_iter().try_for_each(|(chunk, rows)| {
            journal.add(chunk, &rows)?;
            done();
            Ok(())
        });
        let computed = match computing.join() {
            Ok(computed) => computed,
            Err(panic) => std::panic::resume_unwind(panic),
        };
        written.and(computed)
    })
}

fn row(rows: &mut String, run: usize, drawn: &Drawn, radius: Option<f64>, outcome: &Outcome) {
    let given = drawn.start.angle_rad.iter().chain(&drawn.values);
    let given = given.copied().map(Some);
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
    let fields = given.chain(found).map(or_empty);
    let fields: Vec<String> = std::iter::once(run.to_string()).chain(fields).collect();
    *rows += &(fields.join(",") + "\n");
}
