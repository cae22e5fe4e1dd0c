//! A case in figures.

use super::case::Case;
use super::summary::share_interval;
use crate::closed_loop::{ClosedLoop, Controller, Outcome, Start, stream};
use crate::error::Result;
use serde::Serialize;

/// How cases are judged.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Judging {
    /// Runs from random starts.
    pub runs: usize,
    /// Every joint starts evenly anywhere within this of its pose, rad.
    pub start_rad: f64,
    /// Length of a run, s.
    pub seconds: f64,
    /// A link that leans further off than this has fallen, rad.
    pub fall_rad: f64,
    /// Seed of starts and chances.
    pub seed: u64,
}

/// Figures of a case. Medians are over the runs that stood.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Figures {
    /// Runs.
    pub runs: usize,
    /// Runs that stood to the end.
    pub stood: usize,
    /// Their share, and the ends of its 95 % interval.
    pub survival: f64,
    /// Lower end.
    pub survival_low: f64,
    /// Upper end.
    pub survival_high: f64,
    /// Median of the root mean square angle, rad.
    pub rms_angle_rad: Option<f64>,
    /// Median of the root mean square torque, N m.
    pub rms_torque_nm: Option<f64>,
    /// Median of the limit cycle, peak to peak, rad.
    pub limit_cycle_rad: Option<f64>,
    /// Median settling time, s; none if fewer than half of those that stood settled.
    pub settle_s: Option<f64>,
    /// Border of the region of attraction along a tilt of the whole robot, rad: see [`tilt_border_rad`].
    pub tilt_border_rad: f64,
}

/// Step and end of the tilts that are tried, deg.
const TILT_STEP_DEG: f64 = 0.1;
const TILT_MOST_DEG: f64 = 20.0;

/// Judges a case.
///
/// # Errors
/// As [`Case::closed_loop`], [`Case::gains`], [`Case::controller`].
pub fn judge(case: &Case, judging: &Judging) -> Result<Figures> {
    let closed = case.closed_loop(judging.fall_rad)?;
    let controller = case.controller(&case.gains()?, &closed)?;
    let joints = closed.plant.joints();
    // Starts have their own seed, so that every case begins alike.
    let starts: Vec<Start> = (0..judging.runs)
        .map(|run| {
            let mut rng = stream(judging.seed ^ u64::MAX, run as u64);
            Start::random(joints, judging.start_rad, &mut rng)
        })
        .collect();
    let outcomes = closed.run_all(&*controller, &starts, judging.seconds, judging.seed);
    let border = tilt_border_rad(&closed, &*controller, judging.seconds, judging.seed);
    Ok(figures(&outcomes, border))
}

/// The largest tilt such that from every smaller one, to either side in steps of 0.1 deg up to 20 deg, all joints else
/// straight and everything at rest, the robot stands: where the region of attraction ends along joint 1. 0 if even
/// 0.1 deg is too much.
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
        Start::at(angle)
    };
    // In blocks, so that the tilts far beyond the border need not be tried.
    let block = 20;
    for first in (1..=steps).step_by(block) {
        let tried = first..(first + block).min(steps + 1);
        let starts: Vec<Start> = tried
            .clone()
            .flat_map(|step| [start(tilt(step)), start(-tilt(step))])
            .collect();
        let outcomes = closed.run_all(controller, &starts, seconds, seed);
        let fell = outcomes
            .chunks(2)
            .position(|pair| !pair.iter().all(Outcome::survived));
        if let Some(place) = fell {
            return tilt(first + place - 1);
        }
    }
    tilt(steps)
}

fn figures(outcomes: &[Outcome], tilt_border_rad: f64) -> Figures {
    let stood: Vec<&Outcome> = outcomes
        .iter()
        .filter(|outcome| outcome.survived())
        .collect();
    let median = |of: fn(&Outcome) -> Option<f64>| {
        let mut values: Vec<f64> = stood
            .iter()
            .map(|outcome| of(outcome).unwrap_or(f64::INFINITY))
            .collect();
        values.sort_by(f64::total_cmp);
        values
            .get(values.len() / 2)
            .copied()
            .filter(|m| m.is_finite())
    };
    let [survival_low, survival_high] = share_interval(stood.len(), outcomes.len());
    Figures {
        runs: outcomes.len(),
        stood: stood.len(),
        survival: stood.len() as f64 / outcomes.len().max(1) as f64,
        survival_low,
        survival_high,
        rms_angle_rad: median(|o| Some(o.rms_angle_rad)),
        rms_torque_nm: median(|o| Some(o.rms_torque_nm)),
        limit_cycle_rad: median(|o| o.limit_cycle_rad),
        settle_s: median(|o| o.settle_s),
        tilt_border_rad,
    }
}
