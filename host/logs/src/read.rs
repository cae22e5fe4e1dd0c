//! Reads logs into motions: refused where no simulation can follow, their gaps filled where a value
//! holds.

use super::LogFinding;
use super::bam::BamBench;
use super::cut::{CutMotion, cut};
use super::folder::expanded;
use super::request::LogRequest;
use crate::error::{Place, Problem, Result};
use crate::model::LogColumns;
use crate::motion::Motion;
use std::collections::HashMap;

/// Fewest samples a motion may have.
pub const LEAST_ROWS: usize = 10;

/// Reads the requested logs into motions, in order; a file's ending says its format, a folder
/// stands for the logs in it, `-` for CSV from the standard input.
///
/// Motions are named after the file, its rows where only some were asked for, and the segment:
/// `a.csv`, `a.csv:26-139`, `a.csv#3`; pieces between gaps count from 0. Rows outside a range are
/// not judged.
///
/// A motion of fewer than [`LEAST_ROWS`] rows is left out, which [`read_with_findings`] says.
///
/// An empty field is a gap. An angle or a rate is not a number there; an input, the supply and
/// whether torque is on hold the value before. A motion begins when that is known, and all its
/// inputs are or torque is off.
///
/// # Errors
/// Columns without any value, unreadable cells and rows, time that does not increase, a payload or
/// orientation that changes within a motion, a log without any motion of [`LEAST_ROWS`] rows; each
/// with file, line, column and remedy.
pub fn read(requests: &[LogRequest], columns: &LogColumns) -> Result<Vec<Motion>> {
    Ok(read_with_findings(requests, columns)?.0)
}

/// As [`read`], with a warning for each log of which motions are left out; [`super::check()`] finds
/// the same, and more.
///
/// # Errors
/// As [`read`].
pub fn read_with_findings(
    requests: &[LogRequest],
    columns: &LogColumns,
) -> Result<(Vec<Motion>, Vec<LogFinding>)> {
    let (mut motions, mut findings) = (Vec::new(), Vec::new());
    let mut bench = BamBench::default();
    for request in &expanded(requests)? {
        let (cut, facts) = cut(request, columns, &mut bench, &mut |_, fault| {
            Err(fault.problem.at(fault.place))
        });
        let facts = facts?;
        let (path, name) = (&request.path, request.name());
        if cut.is_empty() {
            let problem = cut.lack(columns, &name).unwrap_or_else(no_sample);
            return Err(problem.at(Place::file(path)));
        }
        if let Some((place, problem)) = cut.short.refusal(path).filter(|_| cut.motions.is_empty()) {
            return Err(problem.at(place));
        }
        findings.extend(facts.finding(path));
        findings.extend(cut.short.warning(path));
        let named = named(cut.motions, &name).map(|mut motion| {
            motion.source.sha256.clone_from(&facts.sha256);
            fill(&mut motion);
            if request.is_json() {
                motion
            } else {
                motion.shifted(columns)
            }
        });
        motions.extend(named);
    }
    Ok((motions, findings))
}

/// A log without any row.
pub(super) fn no_sample() -> Problem {
    Problem::new(
        "the log holds no sample",
        "record again: below the column names there is no row",
    )
}

/// Names motions after their file and segment, or their place in it where there are several.
fn named(motions: Vec<CutMotion>, file: &str) -> impl Iterator<Item = Motion> {
    let several = motions.len() > 1;
    let mut seen: HashMap<String, usize> = HashMap::new();
    motions.into_iter().enumerate().map(move |(index, cut)| {
        let name = match cut.segment {
            Some(segment) => {
                let name = format!("{file}#{segment}");
                let count = seen.entry(name.clone()).or_default();
                *count += 1;
                match *count {
                    1 => name,
                    again => format!("{name}.{again}"),
                }
            }
            None if several => format!("{file}#{index}"),
            None => file.to_string(),
        };
        Motion { name, ..cut.motion }
    })
}

/// Fills the gaps of supply and inputs with the value before, at the start with the first; speeds
/// that were never measured are none.
fn fill(motion: &mut Motion) {
    let first = |values: &[f64]| values.iter().copied().find(|value| value.is_finite());
    for velocity in &mut motion.velocity_rad_s {
        velocity.take_if(|values| first(values).is_none());
    }
    for input in motion.input.iter_mut().flatten() {
        // Without torque an input does nothing.
        hold(input, 0.0);
    }
    if let Some(supply) = &mut motion.supply_v {
        let first = first(supply).unwrap_or(f64::NAN);
        hold(supply, first);
    }
}

/// Fills gaps with the value before; those at the start with `first`.
fn hold(values: &mut [f64], first: f64) {
    let mut held = first;
    for value in values {
        if value.is_nan() {
            *value = held
        } else {
            held = *value
        }
    }
}
