//! A loop and its runs.

use super::run::{Run, Sample};
use super::side_by_side;
use super::{Conditions, Controller, Limits, Outcome, Plant, stream};
use rand::Rng as _;
use rand_chacha::ChaCha8Rng;
use rayon::prelude::*;

/// Runs handed to a thread at a time.
const BLOCK: usize = 32;

/// A robot under given circumstances, waiting for a controller.
#[derive(Debug, Clone)]
pub struct ClosedLoop {
    /// The robot.
    pub plant: Plant,
    /// Its sensor, its drives and the clock.
    pub conditions: Conditions,
    /// What counts as fallen and as settled.
    pub limits: Limits,
}

/// Where a run begins: deviations from the pose.
#[derive(Debug, Clone, PartialEq)]
pub struct Start {
    /// Angle of each joint, rad.
    pub angle_rad: Vec<f64>,
    /// Speed of each joint, rad/s.
    pub speed_rad_s: Vec<f64>,
}

impl Start {
    /// At rest at these angles, rad.
    pub fn at(angle_rad: impl Into<Vec<f64>>) -> Self {
        let angle_rad = angle_rad.into();
        Start {
            speed_rad_s: vec![0.0; angle_rad.len()],
            angle_rad,
        }
    }

    /// At rest, each joint evenly anywhere within `spread_rad` of its pose.
    pub fn random(joints: usize, spread_rad: f64, rng: &mut ChaCha8Rng) -> Self {
        let angle = |_| spread_rad * rng.random_range(-1.0..=1.0);
        Start::at((0..joints).map(angle).collect::<Vec<f64>>())
    }
}

/// A run to be done.
#[derive(Debug, Clone)]
pub struct Job<'a> {
    /// The loop.
    pub closed: &'a ClosedLoop,
    /// What closes it.
    pub controller: &'a dyn Controller,
    /// Where it begins.
    pub start: Start,
    /// How long it lasts at most, s.
    pub seconds: f64,
    /// Its chances, from [`stream`].
    pub rng: ChaCha8Rng,
}

/// Does the jobs on this thread, several at once; outcomes in their order.
pub fn run_jobs<'a>(jobs: impl IntoIterator<Item = Job<'a>>) -> Vec<Outcome> {
    let start =
        |job: Job<'a>| Run::new(job.closed, job.controller, &job.start, job.seconds, job.rng);
    side_by_side::finish(jobs.into_iter().map(start).collect())
}

impl ClosedLoop {
    /// A loop under ideal circumstances.
    pub fn ideal(plant: Plant, period_s: f64) -> Self {
        ClosedLoop {
            plant,
            conditions: Conditions::ideal(period_s),
            limits: Limits::default(),
        }
    }

    /// Runs for `seconds` or until it falls; drives give no torque before the first command arrives.
    pub fn run(
        &self,
        controller: &dyn Controller,
        start: &Start,
        seconds: f64,
        rng: ChaCha8Rng,
    ) -> Outcome {
        self.watch(controller, start, seconds, rng, |_| ())
    }

    /// As [`ClosedLoop::run`], showing every sample to `see`.
    pub fn watch(
        &self,
        controller: &dyn Controller,
        start: &Start,
        seconds: f64,
        rng: ChaCha8Rng,
        see: impl FnMut(Sample<'_>),
    ) -> Outcome {
        Run::new(self, controller, start, seconds, rng).finish(see)
    }

    /// Runs from every start, on all cores; run `i` has the chances of [`stream`]`(seed, i)`.
    pub fn run_all(
        &self,
        controller: &dyn Controller,
        starts: &[Start],
        seconds: f64,
        seed: u64,
    ) -> Vec<Outcome> {
        let job = |(index, start): (usize, &Start)| Job {
            closed: self,
            controller,
            start: start.clone(),
            seconds,
            rng: stream(seed, index as u64),
        };
        starts
            .par_chunks(BLOCK)
            .enumerate()
            .flat_map_iter(|(block, starts)| {
                let first = block * BLOCK;
                run_jobs(
                    starts
                        .iter()
                        .enumerate()
                        .map(|(i, start)| job((first + i, start))),
                )
            })
            .collect()
    }
}
