//! A loop and its runs.

use super::equations::Equations;
use super::lanes;
use super::run::{Run, Sample};
use super::{Clock, Commands, Controller, Outcome, PosedPlant, Sensor, StabilityCriteria, stream};
use crate::error::Result;
use crate::model::Model;
use rand::Rng as _;
use rand_chacha::ChaCha8Rng;
use rayon::prelude::*;

/// Runs handed to a thread at a time, where they go in lanes.
const BLOCK: usize = 32;

/// A plant with sensors and clock, waiting for a controller.
#[derive(Debug, Clone)]
pub struct ClosedLoop {
    /// The plant with all its effects.
    pub plant: PosedPlant,
    /// How it is measured.
    pub sensor: Sensor,
    /// When the controller is called.
    pub clock: Clock,
    /// What counts as fallen, stabilised and settled.
    pub limits: StabilityCriteria,
    /// Smallest step of a command, in its unit; 0 takes every value.
    pub command_step: f64,
}

/// Where a run begins: deviations from the pose.
#[derive(Debug, Clone, PartialEq)]
pub struct InitialState {
    /// Angle of each joint, rad.
    pub angle_rad: Vec<f64>,
    /// Speed of each joint, rad/s.
    pub speed_rad_s: Vec<f64>,
    /// What each drive obeys before the first command arrives; 0 where missing.
    pub command: Vec<f64>,
}

impl InitialState {
    /// At rest at these angles, rad.
    pub fn at(angle_rad: impl Into<Vec<f64>>) -> Self {
        let angle_rad = angle_rad.into();
        InitialState {
            command: Vec::new(),
            speed_rad_s: vec![0.0; angle_rad.len()],
            angle_rad,
        }
    }

    /// At rest, each joint evenly anywhere within `spread_rad` of its pose.
    pub fn random(joints: usize, spread_rad: f64, rng: &mut ChaCha8Rng) -> Self {
        let angle = |_| spread_rad * rng.random_range(-1.0..=1.0);
        InitialState::at((0..joints).map(angle).collect::<Vec<f64>>())
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
    pub start: InitialState,
    /// How long it lasts at most, s.
    pub seconds: f64,
    /// Its random numbers, from [`stream`].
    pub rng: ChaCha8Rng,
}

/// Does the jobs on this thread, several at once; outcomes in their order.
pub fn run_jobs<'a>(jobs: impl IntoIterator<Item = Job<'a>>) -> Vec<Outcome> {
    let start =
        |job: Job<'a>| Run::new(job.closed, job.controller, &job.start, job.seconds, job.rng);
    lanes::finish(jobs.into_iter().map(start).collect())
}

impl ClosedLoop {
    /// A loop with exact sensors and a perfect clock around the plant of `model` at `pose_rad`, rad
    /// in the model's own convention. The model's effects are all in it.
    ///
    /// # Errors
    /// As [`PosedPlant::new`].
    pub fn new(
        model: &Model,
        pose_rad: &[f64],
        commands: Commands,
        period_s: f64,
    ) -> Result<ClosedLoop> {
        let plant = PosedPlant::new(model, pose_rad, commands)?;
        Ok(ClosedLoop::around(plant, period_s))
    }

    /// The same around a plant.
    pub fn around(plant: PosedPlant, period_s: f64) -> ClosedLoop {
        ClosedLoop {
            plant,
            sensor: Sensor::EXACT,
            clock: Clock::every(period_s),
            limits: StabilityCriteria::default(),
            command_step: 0.0,
        }
    }

    /// Runs for `seconds` or until it falls.
    pub fn run(
        &self,
        controller: &dyn Controller,
        start: &InitialState,
        seconds: f64,
        rng: ChaCha8Rng,
    ) -> Outcome {
        self.watch(controller, start, seconds, rng, |_| ())
    }

    /// Runs as [`ClosedLoop::run`] does and shows every sample to `see`.
    pub fn watch(
        &self,
        controller: &dyn Controller,
        start: &InitialState,
        seconds: f64,
        rng: ChaCha8Rng,
        see: impl FnMut(Sample<'_>),
    ) -> Outcome {
        Run::new(self, controller, start, seconds, rng).finish(see)
    }

    /// Runs that a thread takes together: one where runs share no lanes, for they share nothing.
    pub fn runs_at_once(&self) -> usize {
        match self.plant.equations {
            Equations::General => 1,
            _ => BLOCK,
        }
    }

    /// Runs from every start, on all cores; run `i` has the random numbers of [`stream`]`(seed,
    /// i)`.
    pub fn run_all(
        &self,
        controller: &dyn Controller,
        starts: &[InitialState],
        seconds: f64,
        seed: u64,
    ) -> Vec<Outcome> {
        let job = |(index, start): (usize, &InitialState)| Job {
            closed: self,
            controller,
            start: start.clone(),
            seconds,
            rng: stream(seed, index as u64),
        };
        let at_once = self.runs_at_once();
        starts
            .par_chunks(at_once)
            .enumerate()
            .flat_map_iter(|(block, starts)| {
                let first = block * at_once;
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
