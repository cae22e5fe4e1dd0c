//! u = u0 - K x, on past torques too if the gains have columns for them.

use super::{Controller, Measurement};

/// State feedback on angles, speeds and past commands.
#[derive(Debug, Clone, PartialEq)]
pub struct StateFeedback {
    /// Gains, one row per driven joint: command per rad of each joint's angle, then per rad/s of
    /// each joint's speed, then, for designs with a delay, per command of one sample ago, two
    /// samples ago, ...
    pub gains: Vec<Vec<f64>>,
    /// Numbers of angles and speeds.
    states: usize,
    /// Command that is given at the pose.
    pub feed: Vec<f64>,
}

impl StateFeedback {
    /// Holds the pose of a robot of `joints` joints, with command 0.
    pub fn new(joints: usize, gains: Vec<Vec<f64>>) -> Self {
        StateFeedback {
            states: 2 * joints,
            feed: vec![0.0; gains.len()],
            gains,
        }
    }

    /// Feeds these commands at the pose.
    #[must_use]
    pub fn feeding(mut self, command: &[f64]) -> Self {
        self.feed.copy_from_slice(command);
        self
    }
}

impl Controller for StateFeedback {
    fn memory_len(&self) -> usize {
        self.gains.first().map_or(0, Vec::len) - self.states
    }

    fn reset(&self, memory: &mut [f64]) {
        for past in memory.chunks_mut(self.feed.len()) {
            past.copy_from_slice(&self.feed);
        }
    }

    #[inline]
    fn control(&self, memory: &mut [f64], measured: Measurement<'_>, command: &mut [f64]) {
        let joints = measured.angle_rad.len();
        for ((command, row), feed) in command.iter_mut().zip(&self.gains).zip(&self.feed) {
            let (angle_gain, rest) = row.split_at(joints);
            let (speed_gain, past_gain) = rest.split_at(joints);
            *command =
                feed - dot(angle_gain, measured.angle_rad) - dot(speed_gain, measured.speed_rad_s);
            let past = memory.iter().zip(self.feed.iter().cycle());
            for (gain, (past, feed)) in past_gain.iter().zip(past) {
                *command -= gain * (past - feed);
            }
        }
        remember(memory, command);
    }
}

/// Makes the commands the newest of those that `memory` holds.
#[inline]
pub fn remember(memory: &mut [f64], command: &[f64]) {
    if memory.is_empty() {
        return;
    }
    let kept = memory.len() - command.len();
    memory.copy_within(..kept, command.len());
    memory[..command.len()].copy_from_slice(command);
}

/// The sum of their products.
#[inline]
pub fn dot(gain: &[f64], x: &[f64]) -> f64 {
    gain.iter().zip(x).map(|(k, x)| k * x).sum()
}
