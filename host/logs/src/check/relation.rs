//! Columns against each other: a wrong sign, scale or zero shows in how one follows the other.

use super::extremes::Extremes;
use super::fit::{LineFit, Regression};
use super::stretch::{Stretch, Stretches};
use crate::cut::is_energised;
use crate::model::{AngleZero, Angles, Drive, Model};
use crate::motion::Motion;

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
            follow: vec![[LineFit::default(); LAGS.len()]; n],
            speed: vec![LineFit::default(); n],
            rate: vec![LineFit::default(); n],
            turning: (0..n).map(|joint| turning(model, joint)).collect(),
            push: (0..n).map(|_| Regression::new(5 * n + 1)).collect(),
            supply_v: Extremes::NONE,
        }
    }

    pub fn take(&mut self, motion: &Motion) {
        let volts = motion.supply_v.iter().flatten();
        volts.for_each(|volts| self.supply_v.take(*volts));
        let is_driven = self.drives.iter().any(|kind| *kind != InputKind::None);
        let mut stretches = Stretches::default();
        // First sample since torque came on.
        let mut begin = 0;
        for k in 0..motion.len() {
            if !is_energised(motion, k) {
                begin = k + 1;
                stretches.reset();
                if is_driven {
                    continue;
                }
            }
            self.take_goals(motion, begin, k);
            // A stretch takes whole rows.
            if !is_whole(motion, k) {
                stretches.reset();
            } else if let Some(stretch) = stretches.take(&motion.time_s, k) {
                self.take_stretch(motion, stretch);
            }
        }
    }

    /// Holds what sample `k` measures against goals that may be as old as sample `begin`.
    fn take_goals(&mut self, motion: &Motion, begin: usize, k: usize) {
        for (joint, kind) in self.drives.iter().enumerate() {
            let measured = match (kind, &motion.velocity_rad_s[joint]) {
                (InputKind::Angle, _) => motion.position_rad[joint][k],
                (InputKind::Speed, Some(speed)) => speed[k],
                _ => continue,
            };
            let Some(goals) = &motion.input[joint] else {
                continue;
            };
            for (line, lag) in self.follow[joint].iter_mut().zip(LAGS) {
                let goal = k.checked_sub(lag).filter(|then| *then >= begin);
                let goal = goal.map(|then| goals[then]);
                if let Some(goal) = goal.filter(|goal| (goal - measured).is_finite()) {
                    line.add(goal, measured);
                }
            }
        }
    }

    fn take_stretch(&mut self, motion: &Motion, stretch: Stretch) {
        let n = self.drives.len();
        let of_each = |of: &dyn Fn(usize) -> f64| (0..n).map(of).collect::<Vec<f64>>();
        let angles = of_each(&|i| stretch.mean(motion, Some(&motion.position_rad[i])));
        let speeds = of_each(&|i| stretch.speed_rad_s(motion, i));
        let accelerations = of_each(&|i| stretch.acceleration_rad_s2(motion, i));
        // Relative angles drive; absolute ones feel gravity.
        let relative = |values: &[f64], i: usize| match (self.angles, i) {
            (Angles::Absolute, 1..) => values[i] - values[i - 1],
            _ => values[i],
        };
        let mut x = Vec::with_capacity(5 * n + 1);
        let mut absolute = self.zero.from_hanging_rad();
        for (i, angle) in angles.into_iter().enumerate() {
            absolute = match self.angles {
                Angles::Relative => absolute + angle,
                Angles::Absolute => self.zero.from_hanging_rad() + angle,
            };
            let speed = relative(&speeds, i);
            let input = match self.drives[i] {
                InputKind::Push => stretch.mean_held(motion, motion.input[i].as_deref()),
                _ => 0.0,
            };
            x.extend([input, absolute.sin(), absolute.cos(), speed, speed.signum()]);
        }
        x.push(1.0);
        for i in 0..n {
            let mean = |values: Option<&[f64]>| {
                let mean = stretch.mean(motion, Some(values?));
                Some(mean).filter(|mean| mean.is_finite())
            };
            if let (Some(turning), Some(rate)) = (&self.turning[i], mean(motion.rate(i))) {
                let felt = turning.iter().map(|j| relative(&speeds, *j));
                self.rate[i].add(felt.sum(), rate);
            }
            if let Some(logged) = mean(motion.velocity_rad_s[i].as_deref()) {
                self.speed[i].add(speeds[i], logged);
            }
            if !self.slides && relative(&speeds, i).abs() > MOVING_RAD_S {
                self.push[i].add(&x, relative(&accelerations, i));
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

/// Whether a sample has all that a stretch needs: every angle and every input.
fn is_whole(motion: &Motion, k: usize) -> bool {
    let mut all = motion
        .position_rad
        .iter()
        .chain(motion.input.iter().flatten());
    all.all(|values| values[k].is_finite())
}
