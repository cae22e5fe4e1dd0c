//! The motion that a recording holds.

use super::{GoalRange, Recording};
use crate::error::{Error, Place, Result};
use std::path::Path;

/// A motion to follow: times from 0, and a pose for each.
#[derive(Debug, Clone, PartialEq)]
pub struct GoalMotion {
    /// Times, s, the first 0.
    pub time_s: Vec<f64>,
    /// Goals at each time, rad, in the order of ids.
    pub goals_rad: Vec<Vec<f64>>,
    /// Positions recorded at each time, rad.
    pub measured_rad: Vec<Vec<Option<f64>>>,
    /// Whether torque is on from each time to the next.
    pub torque_on: Vec<bool>,
}

impl GoalMotion {
    /// The motion of a recording: its goals, with torque as it was, or its positions where it has
    /// no goals; `file` names it in errors.
    ///
    /// # Errors
    /// Fewer than two samples, times that do not grow, or a servo without goal and position.
    pub fn of(recording: &Recording, file: &Path) -> Result<GoalMotion> {
        let refused = |what: &str, remedy: &str| Err(Error::data(Place::file(file), what, remedy));
        if recording.samples.len() < 2 {
            return refused(
                "there are fewer than two samples",
                "record a motion first: handstand record",
            );
        }
        let commanded = recording
            .samples
            .iter()
            .any(|sample| sample.joints.iter().any(|joint| joint.goal_rad.is_some()));
        let mut pose = vec![None; recording.ids.len()];
        let mut motion = GoalMotion {
            time_s: Vec::new(),
            goals_rad: Vec::new(),
            measured_rad: Vec::new(),
            torque_on: Vec::new(),
        };
        for sample in &recording.samples {
            for (last, joint) in pose.iter_mut().zip(&sample.joints) {
                // A servo that did not answer for a moment stays where it was.
                *last = if commanded {
                    joint.goal_rad
                } else {
                    joint.position_rad
                }
                .or(*last);
            }
            // Until every servo has said something there is no pose.
            let Some(goals) = pose.iter().copied().collect::<Option<Vec<f64>>>() else {
                continue;
            };
            if motion
                .time_s
                .last()
                .is_some_and(|last| sample.time_s <= *last)
            {
                return refused("time does not grow", "the recording is damaged");
            }
            motion.time_s.push(sample.time_s);
            motion.goals_rad.push(goals);
            // A motion that was shown by hand had no torque.
            let on = !commanded || sample.torque_on.unwrap_or(true);
            motion.torque_on.push(on);
            motion.measured_rad.push(
                sample
                    .joints
                    .iter()
                    .map(|joint| joint.position_rad)
                    .collect(),
            );
        }
        let Some(begin) = motion.time_s.first().copied() else {
            return refused(
                "a servo never says where it is, nor has it a goal",
                "record the servos that are there: --ids",
            );
        };
        motion.time_s.iter_mut().for_each(|time| *time -= begin);
        Ok(motion)
    }

    /// The range of each servo's goals while torque is on, in the order of ids; of all its goals
    /// where it never is.
    pub fn ranges(&self) -> Vec<GoalRange> {
        let always_off = !self.torque_on.contains(&true);
        let rows = || {
            let rows = self.goals_rad.iter().zip(&self.torque_on);
            rows.filter(move |(_, on)| **on || always_off)
        };
        let servos = 0..self.goals_rad.first().map_or(0, Vec::len);
        let range = |place: usize| GoalRange::of(rows().map(|(goals, _)| goals[place]));
        servos.filter_map(range).collect()
    }

    /// Goals at a time, straight between two samples; none after the end.
    pub fn at(&self, time_s: f64) -> Option<(usize, Vec<f64>)> {
        let next = self.time_s.partition_point(|time| *time <= time_s);
        if next >= self.time_s.len() {
            return None;
        }
        let (a, b) = (next - 1, next);
        let share = (time_s - self.time_s[a]) / (self.time_s[b] - self.time_s[a]);
        let between = self.goals_rad[a]
            .iter()
            .zip(&self.goals_rad[b])
            .map(|(a, b)| a + share * (b - a));
        Some((if share < 0.5 { a } else { b }, between.collect()))
    }
}
