//! Columns against each other: a wrong sign, scale or zero shows in how one follows the other.

use super::extremes::Extremes;
use super::fit::{LineFit, Regression};
use super::stretch::{Stretch, Stretches};
use crate::model::{AngleZero, Angles, Drive, Model};
use crate::row::LogRow;
use std::collections::VecDeque;

mod judge;

/// Samples by which a goal may run ahead of the motion.
const LAGS: [usize; 6] = [0, 1, 2, 4, 8, 16];
/// A joint slower than this may be held by stiction, rad/s.
const MOVING_RAD_S: f64 = 0.1;

/// Running sums of one file.
pub(super) struct Relations {
    zero: AngleZero,
    angles: Angles,
    /// Whether any joint slides: what pushes and pulls it is then not judged.
    slides: bool,
    /// Per joint: how the input drives it.
    drives: Vec<InputKind>,
    /// Recent samples' inputs, newest first.
    recent: VecDeque<Vec<Option<f64>>>,
    /// Per joint and lag: measured against goal.
    follow: Vec<[LineFit; LAGS.len()]>,
    /// Per joint: logged speed against the angle's.
    speed: Vec<LineFit>,
    /// Per joint: what its own rate sensor reads against the angles' speeds.
    rate: Vec<LineFit>,
    /// Per joint: the hinges whose speeds that sensor feels, if there is one.
    turning: Vec<Option<Vec<usize>>>,
    /// Per joint: acceleration on inputs, gravity, speed and the direction of motion.
    push: Vec<Regression>,
    stretches: Stretches,
    supply_v: Extremes,
}

#[derive(Clone, Copy, PartialEq)]
enum InputKind {
    None,
    Push,
    Angle,
    Speed,
}

impl Relations {
    pub fn new(model: &Model) -> Self {
        let n = model.log.joints.len();
        let kind = |drive: &Drive| match drive {
            Drive::Passive => InputKind::None,
            Drive::Torque | Drive::Duty(_) => InputKind::Push,
            Drive::Position { .. } => InputKind::Angle,
            Drive::Speed { .. } => InputKind::Speed,
        };
        Relations {
            zero: model.angle_zero,
            angles: model.angles,
            slides: model.slides(),
            drives: model
                .joints
                .iter()
                .map(|joint| kind(&joint.drive))
                .collect(),
            recent: VecDeque::new(),
            follow: vec![[LineFit::default(); LAGS.len()]; n],
            speed: vec![LineFit::default(); n],
            rate: vec![LineFit::default(); n],
            turning: (0..n).map(|joint| turning(model, joint)).collect(),
            push: (0..n).map(|_| Regression::new(5 * n + 1)).collect(),
            stretches: Stretches::default(),
            supply_v: Extremes::NONE,
        }
    }

    pub fn take(&mut self, row: &LogRow, fresh: bool) {
        if fresh || row.torque_on == Some(false) {
            self.recent.clear();
            self.stretches.reset();
        }
        if let Some(volts) = row.supply_v {
            self.supply_v.take(volts);
        }
        if row.torque_on == Some(false) && self.drives.iter().any(|kind| *kind != InputKind::None) {
            return;
        }
        self.recent.push_front(row.input.clone());
        self.recent.truncate(LAGS[LAGS.len() - 1] + 1);
        for joint in 0..self.drives.len() {
            let measured = match self.drives[joint] {
                InputKind::Angle => Some(row.position_rad[joint]),
                InputKind::Speed => row.velocity_rad_s[joint],
                _ => None,
            };
            let Some(measured) = measured else { continue };
            for (line, lag) in self.follow[joint].iter_mut().zip(LAGS) {
                let goal = self.recent.get(lag).and_then(|inputs| inputs[joint]);
                if let Some(goal) = goal.filter(|goal| (goal - measured).is_finite()) {
                    line.add(goal, measured);
                }
            }
        }
        // A stretch takes whole rows.
        if !is_whole(row) {
            self.stretches.reset();
            return;
        }
        if let Some(stretch) = self.stretches.take(row) {
            self.take_stretch(&stretch, row);
        }
    }

    fn take_stretch(&mut self, stretch: &Stretch, row: &LogRow) {
        let n = self.drives.len();
        // Relative angles drive; absolute ones feel gravity.
        let relative = |values: &[f64], i: usize| match (self.angles, i) {
            (Angles::Absolute, 1..) => values[i] - values[i - 1],
            _ => values[i],
        };
        let mut x = Vec::with_capacity(5 * n + 1);
        let mut absolute = self.zero.from_hanging_rad();
        for i in 0..n {
            absolute = match self.angles {
                Angles::Relative => absolute + stretch.position_rad[i],
                Angles::Absolute => self.zero.from_hanging_rad() + stretch.position_rad[i],
            };
            let speed = relative(&stretch.speed_rad_s, i);
            let input = if self.drives[i] == InputKind::Push {
                stretch.input[i]
            } else {
                0.0
            };
            x.extend([input, absolute.sin(), absolute.cos(), speed, speed.signum()]);
        }
        x.push(1.0);
        for i in 0..n {
            if let Some(turning) = &self.turning[i]
                && row.rate_rad_s[i].is_some()
                && stretch.rate_rad_s[i].is_finite()
            {
                let felt = turning.iter().map(|j| relative(&stretch.speed_rad_s, *j));
                self.rate[i].add(felt.sum(), stretch.rate_rad_s[i]);
            }
            if row.velocity_rad_s[i].is_some() && stretch.logged_speed_rad_s[i].is_finite() {
                self.speed[i].add(stretch.speed_rad_s[i], stretch.logged_speed_rad_s[i]);
            }
            if !self.slides && relative(&stretch.speed_rad_s, i).abs() > MOVING_RAD_S {
                self.push[i].add(&x, relative(&stretch.acceleration_rad_s2, i));
            }
        }
    }
}

/// The hinges whose speeds add up to what a joint's own rate sensor reads, if it has one.
fn turning(model: &Model, joint: usize) -> Option<Vec<usize>> {
    let columns = model.log.joints.get(joint)?;
    columns.rate.as_ref()?;
    Some(model.turning(columns.rate_sensor, joint))
}

/// Whether a row says all that a stretch needs: every angle and every input.
fn is_whole(row: &LogRow) -> bool {
    let inputs = row.input.iter().flatten();
    let mut all = row.position_rad.iter().chain(inputs);
    all.all(|value| value.is_finite())
}
