//! Does a plan hold the robot of a model? Judged by what will run: the plan itself, on the
//! firmware's own logic in process, its servos and their steps simulated, the model with all of its
//! effects behind them (feature `virtual-cm5`).
//!
//! Bits, timing, velocity estimate or observer, limits and the torque's way to the servo are those
//! of `handstand balance`, for it is the same program that runs.

mod attempt;

pub use attempt::{AttemptSample, BalanceAttempt, STANDS_S};

use crate::error::Result;
use crate::model::Model;
use crate::study::Manner;
use handstand_shared::message::Attitude;
use handstand_shared::plan::{Law, Plan};
use rand::{Rng as _, SeedableRng as _};
use rand_chacha::ChaCha8Rng;
use serde::Serialize;

/// Longest step of the simulated robot, s: stick-slip and a law's steps are finer than what a log
/// needs.
const MOST_STEP_S: f64 = 1e-3;
/// Largest departure of each joint at the start, deg.
pub const START_DEG: f64 = 1.0;
/// Attempts in a rehearsal.
pub const ATTEMPTS: usize = 10;
/// Attempts that have to stand for the plan to hold the robot.
pub const HOLDS: usize = 9;

/// What a simulated robot is beside its model.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Setting {
    /// Where each joint starts, degrees from upright and straight.
    pub start_deg: [f64; 3],
    /// Time constant with which its torques follow their commands, s.
    pub lag_s: f64,
    /// Supply, V; that of the simulated bus unless given.
    pub supply_v: Option<f64>,
}

impl Setting {
    /// The simulated bus in words, and its servos.
    fn bus(&self, plan: &Plan) -> (String, Vec<u8>) {
        let pairs = plan.joints.map(|joint| {
            let ids = [joint.id, joint.mirror];
            ids.into_iter().filter(|id| *id < 254).collect::<Vec<u8>>()
        });
        let mut ids: Vec<u8> = (1..=18).chain(pairs.iter().flatten().copied()).collect();
        ids.sort_unstable();
        ids.dedup();
        let listed = |ids: &[u8]| {
            let ids: Vec<String> = ids.iter().map(u8::to_string).collect();
            ids.join("+")
        };
        let [first, second, third] = self.start_deg;
        let mut text = format!(
            "ids={},delay=0,joints={}/{},start=held,lean={first}/{second}/{third},lag={}",
            listed(&ids),
            listed(&pairs[0]),
            listed(&pairs[1]),
            self.lag_s
        );
        if let Some(supply_v) = self.supply_v {
            text += &format!(",supply={supply_v}");
        }
        if !plan.gyro.from_host {
            let step = f64::from(plan.gyro.scale.unsigned_abs()) / 16.0;
            let step_deg_s = (step * Attitude::RATE_LSB_RAD_S).to_degrees();
            text += &format!(",gyro={}/{step_deg_s}", plan.gyro.zero);
        }
        (text, ids)
    }
}

/// How a plan did.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Rehearsal {
    /// Attempts that stood for 10 s.
    pub stood: usize,
    /// Whether these are at least 9 of 10.
    pub holds: bool,
    /// Each attempt.
    pub attempts: Vec<BalanceAttempt>,
}

impl Rehearsal {
    /// Lets the plan balance the model's robot from `ATTEMPTS` starts within 1 deg of upright in
    /// each joint, drawn from `seed`; where they start is not `setting`'s.
    ///
    /// # Errors
    /// A model that is no robot on these servos.
    pub fn of(model: &Model, plan: &Plan, setting: &Setting, seed: u64) -> Result<Rehearsal> {
        let model = Model {
            step_s: model.step_s.min(MOST_STEP_S),
            ..model.clone()
        };
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        let mut attempts = Vec::new();
        for _ in 0..ATTEMPTS {
            let setting = Setting {
                start_deg: std::array::from_fn(|_| random.random_range(-START_DEG..=START_DEG)),
                ..*setting
            };
            attempts.push(BalanceAttempt::run(&model, plan, &setting)?);
        }
        let stood = attempts.iter().filter(|attempt| attempt.stands).count();
        Ok(Rehearsal {
            stood,
            holds: stood >= HOLDS,
            attempts,
        })
    }

    /// The verdict in a sentence.
    pub fn words(&self, plan: &Plan) -> String {
        let count = self.attempts.len();
        let stood = format!(
            "{} of {count} starts within 1 deg stand for 10 s",
            self.stood
        );
        let law = match plan.law {
            Law::State { .. } => "state",
            Law::Observer(_) => "observer",
        };
        let how = match self.worst_manner() {
            Some(manner) => format!(", {}", manner.words()),
            None => String::new(),
        };
        let shortest = self.attempts.iter().filter(|attempt| !attempt.stands);
        let shortest = shortest.min_by(|one, other| one.stood_s.total_cmp(&other.stood_s));
        let fell = shortest.map_or(String::new(), |attempt| {
            format!(
                "; the shortest stands for {:.1} s ({})",
                attempt.stood_s, attempt.end
            )
        });
        let verdict = if self.holds {
            "holds this robot"
        } else {
            "does NOT hold this robot"
        };
        format!("the {law} law {verdict}: {stood}{how}{fell}")
    }

    /// The liveliest manner of those that stood.
    fn worst_manner(&self) -> Option<Manner> {
        let stood = self.attempts.iter().filter_map(|attempt| attempt.manner);
        stood.max_by(|one, other| one.swing_rad().total_cmp(&other.swing_rad()))
    }
}

#[cfg(test)]
mod tests;
