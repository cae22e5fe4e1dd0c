//! Longer runs of a verified loop: whether it keeps standing, and in which manner.

use super::judge::STABILISED_SHARE;
use super::manner::{Manner, can_stick};
use crate::model::Model;
use crate::sim::closed_loop::{ClosedLoop, Controller, InitialState, stream};
use rayon::prelude::*;
use serde::Serialize;

/// Length of a longer run, s: friction that lets go once in seconds shows.
const LASTING_S: f64 = 15.0;

/// The last of it that is looked at, s.
const LAST_S: f64 = 10.0;

/// How a robot stands in the long run.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Lasting {
    /// Runs from starts near the pose.
    pub runs: usize,
    /// How many of them are stabilised at the end.
    pub stabilised: usize,
    /// Length of a run, s.
    pub seconds: f64,
    /// The liveliest manner of those; none if there are none.
    pub manner: Option<Manner>,
}

impl Lasting {
    /// Of a loop of `model` under a law from these starts.
    pub(super) fn of(
        model: &Model,
        closed: &ClosedLoop,
        law: &dyn Controller,
        starts: &[InitialState],
    ) -> Lasting {
        let sticks = can_stick(model);
        let run = |(index, start): (usize, &InitialState)| {
            let mut samples: Vec<(f64, Vec<f64>)> = Vec::new();
            let rng = stream(1, index as u64);
            let outcome = closed.watch(law, start, LASTING_S, rng, |sample| {
                samples.push((sample.time_s, sample.angle_rad.to_vec()));
            });
            outcome
                .stabilised
                .then(|| Manner::of(&samples, LAST_S, sticks))
        };
        let manners: Vec<Option<Manner>> = starts.par_iter().enumerate().map(run).collect();
        let stood = manners.iter().flatten();
        Lasting {
            runs: starts.len(),
            stabilised: stood.clone().count(),
            seconds: LASTING_S,
            manner: stood
                .max_by(|one, other| one.swing_rad().total_cmp(&other.swing_rad()))
                .copied(),
        }
    }

    /// Whether 95 % of them are stabilised.
    pub fn is_stable(&self) -> bool {
        self.stabilised as f64 >= STABILISED_SHARE * self.runs as f64
    }
}
