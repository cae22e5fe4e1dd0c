//! From where a controller stabilises: along a tilt, and from a cube of starts.

use super::case::Case;
use super::held::run_unheld;
use super::judge::{Judging, STABILISED_SHARE, judge};
use super::quantity::Uncertain;
use crate::error::Result;
use crate::sim::closed_loop::{ClosedLoop, Controller, InitialState, Job, Outcome, stream};
use rayon::prelude::*;
use serde::Serialize;

/// Step and end of the tilts that are tried, deg.
const TILT_STEP_DEG: f64 = 0.1;
const TILT_MOST_DEG: f64 = 20.0;

/// A tilt goes to either side.
const SIDES: usize = 2;

/// Largest cube that is searched, rad.
pub(super) const LARGEST_REGION_RAD: f64 = 16.0 * std::f64::consts::PI / 180.0;

/// Halvings of the interval in which a region ends.
const HALVINGS: usize = 6;

/// How many judgements [`region`] takes at most.
pub const REGION_JUDGEMENTS: usize = HALVINGS + 1;

/// The largest tilt such that from every smaller one, to either side in steps of 0.1 deg up to 20
/// deg, all joints else straight and everything at rest, the robot is stabilised: where the region
/// of attraction ends along joint 1. 0 if even 0.1 deg is too much, or friction alone holds it.
pub fn tilt_border_rad(
    closed: &ClosedLoop,
    controller: &dyn Controller,
    seconds: f64,
    seed: u64,
) -> f64 {
    let steps = (TILT_MOST_DEG / TILT_STEP_DEG).round() as usize;
    let tilt = |step: usize| (step as f64 * TILT_STEP_DEG).to_radians();
    let start = |rad: f64| {
        let mut angle = vec![0.0; closed.plant.joints()];
        angle[0] = rad;
        InitialState::at(angle)
    };
    // In blocks, so that the tilts far beyond the border need not be tried.
    let block = 20;
    for first in (1..=steps).step_by(block) {
        let tried = first..(first + block).min(steps + 1);
        let starts: Vec<InitialState> = tried
            .clone()
            .flat_map(|step| [start(tilt(step)), start(-tilt(step))])
            .collect();
        let jobs = starts.iter().enumerate().map(|(index, start)| Job {
            closed,
            controller,
            start: start.clone(),
            seconds,
            rng: stream(seed, index as u64),
        });
        let jobs: Vec<Job<'_>> = jobs.collect();
        let outcomes = jobs
            .par_chunks(SIDES)
            .flat_map_iter(|pair| run_unheld(pair.to_vec()));
        let outcomes: Vec<Outcome> = outcomes.collect();
        let lost = outcomes
            .chunks(SIDES)
            .position(|pair| !pair.iter().all(|outcome| outcome.stabilised));
        if let Some(place) = lost {
            return tilt(first + place - 1);
        }
    }
    tilt(steps)
}

/// Largest cube of starts of which a controller stabilises 95 %.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Region {
    /// Half-width of the cube of angles, rad; 0 if it stabilises too few from anywhere.
    pub spread_rad: f64,
    /// Whether it may be larger still: the search ends at 16 deg.
    pub open: bool,
}

/// Searches the largest cube of starts from which 95 % are stabilised; `done` is called after each
/// run.
///
/// # Errors
/// As [`judge`].
pub fn region(
    case: &Case,
    uncertain: &[Uncertain],
    judging: &Judging,
    done: &(dyn Fn() + Sync),
) -> Result<Region> {
    let stabilises = |start_rad: f64| -> Result<bool> {
        let judging = Judging {
            start_rad,
            ..*judging
        };
        Ok(judge(case, uncertain, &judging, done)?.stabilised_share >= STABILISED_SHARE)
    };
    largest(stabilises)
}

/// The largest half-width, up to 16 deg, from which a robot is stabilised, by bisection.
///
/// # Errors
/// Those of `stabilises`.
pub(super) fn largest(mut stabilises: impl FnMut(f64) -> Result<bool>) -> Result<Region> {
    let open = stabilises(LARGEST_REGION_RAD)?;
    let spread_rad = if open {
        LARGEST_REGION_RAD
    } else {
        bisect(0.0, LARGEST_REGION_RAD, HALVINGS, stabilises)?.0
    };
    Ok(Region { spread_rad, open })
}

/// Halves the interval from `inside`, where `holds`, to `outside`, where it does not: its ends, in
/// this order, after that many halvings.
///
/// # Errors
/// Those of `holds`.
pub fn bisect(
    mut inside: f64,
    mut outside: f64,
    halvings: usize,
    mut holds: impl FnMut(f64) -> Result<bool>,
) -> Result<(f64, f64)> {
    for _ in 0..halvings {
        let middle = 0.5 * (inside + outside);
        if holds(middle)? {
            inside = middle
        } else {
            outside = middle
        }
    }
    Ok((inside, outside))
}
