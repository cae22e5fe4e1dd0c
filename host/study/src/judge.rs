//! A case in figures: runs of robots drawn around it.

use super::case::{Case, Designed};
use super::held::run_unheld;
use super::quantity::Uncertain;
use super::summary::share_interval;
use crate::error::Result;
use crate::sim::closed_loop::stream;
use crate::sim::closed_loop::{ClosedLoop, Controller, InitialState, Job, Outcome};
use rayon::prelude::*;
use serde::Serialize;

/// How many runs, how long, from where.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Judging {
    /// Runs, each from a random start.
    pub runs: usize,
    /// Every joint starts at rest evenly anywhere within this of its pose, rad.
    pub start_rad: f64,
    /// Length of a run, s.
    pub seconds: f64,
    /// Seed of robots, starts and noise.
    pub seed: u64,
}

/// Share of the robots that have to be stabilised for a region, a delay or an error to count as
/// stabilised.
pub const STABILISED_SHARE: f64 = 0.95;

/// Robot `run` of a study: the same in every case of a seed.
#[derive(Debug)]
pub(super) struct Drawn {
    pub case: Case,
    pub closed: ClosedLoop,
    pub start: InitialState,
    pub values: Vec<f64>,
}

impl Drawn {
    /// Draws the robot and where it starts.
    ///
    /// # Errors
    /// Robots that cannot be simulated.
    pub fn new(case: &Case, uncertain: &[Uncertain], judging: &Judging, run: u64) -> Result<Drawn> {
        let mut case = case.clone();
        let mut rng = stream(judging.seed, run);
        let start = InitialState::random(case.robot.link_count(), judging.start_rad, &mut rng);
        let values: Vec<f64> = uncertain
            .iter()
            .map(|u| u.draw(judging.seed, run))
            .collect();
        for (uncertain, value) in uncertain.iter().zip(&values) {
            uncertain.apply(&mut case, *value);
        }
        Ok(Drawn {
            closed: case.closed_loop()?,
            case,
            start,
            values,
        })
    }
}

/// Runs robots drawn around a case, on this thread, several at once; outcomes in their order. Those
/// that friction holds do not count as stabilised.
pub(super) fn run_drawn(
    drawn: &[Drawn],
    designed: &Designed,
    judging: &Judging,
    first: usize,
) -> Vec<Outcome> {
    let controllers: Vec<Box<dyn Controller + '_>> = drawn
        .iter()
        .map(|drawn| drawn.case.controller(designed, &drawn.closed))
        .collect();
    let jobs = drawn.iter().zip(&controllers).enumerate();
    let jobs = jobs.map(|(index, (drawn, controller))| Job {
        closed: &drawn.closed,
        controller: &**controller,
        start: drawn.start.clone(),
        seconds: judging.seconds,
        // Noise during the run is apart from what made the robot.
        rng: stream(!judging.seed, (first + index) as u64),
    });
    run_unheld(jobs.collect())
}

/// Outcomes of all runs, on all cores; `done` is called after each.
///
/// # Errors
/// Robots that cannot be simulated.
pub fn outcomes(
    case: &Case,
    uncertain: &[Uncertain],
    designed: &Designed,
    judging: &Judging,
    done: &(dyn Fn() + Sync),
) -> Result<Vec<Outcome>> {
    let at_once = case.closed_loop()?.runs_at_once();
    let blocks: Vec<usize> = (0..judging.runs).step_by(at_once).collect();
    let block = |&first: &usize| -> Result<Vec<Outcome>> {
        let runs = first..(first + at_once).min(judging.runs);
        let drawn = runs.map(|run| Drawn::new(case, uncertain, judging, run as u64));
        let drawn = drawn.collect::<Result<Vec<_>>>()?;
        let outcomes = run_drawn(&drawn, designed, judging, first);
        outcomes.iter().for_each(|_| done());
        Ok(outcomes)
    };
    let outcomes: Result<Vec<Vec<Outcome>>> = blocks.par_iter().map(block).collect();
    Ok(outcomes?.into_iter().flatten().collect())
}

/// Figures of a case. Medians are over the stabilised runs.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Figures {
    /// Runs.
    pub runs: usize,
    /// Runs that were stabilised.
    pub stabilised: usize,
    /// Runs that stayed as well without any command, held by friction: not among those.
    pub held: usize,
    /// Share of the stabilised, and the ends of its 95 % interval.
    pub stabilised_share: f64,
    /// Lower end.
    pub stabilised_low: f64,
    /// Upper end.
    pub stabilised_high: f64,
    /// Share of the runs that fell; the rest stood, but swung or leant too far.
    pub fallen_share: f64,
    /// Median of the root mean square angle, rad.
    pub rms_angle_rad: Option<f64>,
    /// Median of the root mean square torque, N m.
    pub rms_torque_nm: Option<f64>,
    /// Median of the limit cycle, peak to peak, rad.
    pub limit_cycle_rad: Option<f64>,
    /// Median settling time, s; none if fewer than half of the stabilised settled.
    pub settle_s: Option<f64>,
}

/// Judges a case with what is uncertain about it.
///
/// # Errors
/// As [`Case::closed_loop`] and [`Case::designed`].
pub fn judge(
    case: &Case,
    uncertain: &[Uncertain],
    judging: &Judging,
    done: &(dyn Fn() + Sync),
) -> Result<Figures> {
    let designed = case.designed()?;
    let outcomes = outcomes(case, uncertain, &designed, judging, done)?;
    Ok(Figures::of(&outcomes))
}

impl Figures {
    /// Of these outcomes.
    pub fn of(outcomes: &[Outcome]) -> Figures {
        let stabilised: Vec<&Outcome> = outcomes.iter().filter(|o| o.stabilised).collect();
        let median = |of: fn(&Outcome) -> Option<f64>| {
            let mut values: Vec<f64> = stabilised
                .iter()
                .map(|outcome| of(outcome).unwrap_or(f64::INFINITY))
                .collect();
            values.sort_by(f64::total_cmp);
            values
                .get(values.len() / 2)
                .copied()
                .filter(|m| m.is_finite())
        };
        let share = |count: usize| count as f64 / outcomes.len().max(1) as f64;
        let [stabilised_low, stabilised_high] = share_interval(stabilised.len(), outcomes.len());
        Figures {
            runs: outcomes.len(),
            stabilised: stabilised.len(),
            held: outcomes.iter().filter(|o| o.held).count(),
            stabilised_share: share(stabilised.len()),
            stabilised_low,
            stabilised_high,
            fallen_share: share(outcomes.iter().filter(|o| o.fell_s.is_some()).count()),
            rms_angle_rad: median(|o| Some(o.rms_angle_rad)),
            rms_torque_nm: median(|o| Some(o.rms_torque_nm)),
            limit_cycle_rad: median(|o| o.limit_cycle_rad),
            settle_s: median(|o| o.settle_s),
        }
    }
}
