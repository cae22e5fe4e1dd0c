//! Columns against each other: a wrong sign, scale or zero shows in how one follows the other.

use super::excitation::name;
use super::extremes::Extremes;
use super::finding::Findings;
use super::fit::{LineFit, Regression};
use super::stretch::{Stretch, Stretches};
use crate::error::Place;
use crate::log::row::LogRow;
use crate::model::{AngleZero, Angles, Drive, Model};
use std::collections::VecDeque;

/// Samples by which a goal may run ahead of the motion.
const LAGS: [usize; 6] = [0, 1, 2, 4, 8, 16];
/// A joint slower than this may be held by stiction, rad/s.
const MOVING_RAD_S: f64 = 0.1;
/// Standard errors for a sign to be believed. Under feedback the input follows the motion: an idle
/// shoulder of a public double pendulum reaches -4.8 with the sign right, and a delayed PD loop
/// shows no sign at all.
const SURE: f64 = 8.0;

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
            if row.velocity_rad_s[i].is_some() && stretch.logged_speed_rad_s[i].is_finite() {
                self.speed[i].add(stretch.speed_rad_s[i], stretch.logged_speed_rad_s[i]);
            }
            if !self.slides && relative(&stretch.speed_rad_s, i).abs() > MOVING_RAD_S {
                self.push[i].add(&x, relative(&stretch.acceleration_rad_s2, i));
            }
        }
    }

    pub fn judge(&mut self, place: &Place, model: &Model, findings: &mut Findings) {
        for joint in 0..self.drives.len() {
            let columns = &model.log.joints[joint];
            let (speed, angle) = (name(&columns.velocity), name(&columns.position));
            let measured = match (self.drives[joint], &columns.velocity) {
                (InputKind::Speed, Some(_)) => &speed,
                _ => &angle,
            };
            if let Some(input) = &columns.input {
                self.judge_follow(joint, &input.name(), measured, place, findings);
                self.judge_push(joint, &input.name(), place, findings);
            }
            if columns.velocity.is_some() && columns.position.is_some() {
                judge_speed(&self.speed[joint], (&speed, &angle), place, findings);
            }
            let nominal = model.joints[joint]
                .drive
                .motor()
                .and_then(|motor| motor.nominal_supply_v);
            self.judge_supply(nominal, place, findings);
        }
        self.judge_gravity(model, place, findings);
    }

    fn judge_follow(
        &self,
        joint: usize,
        goal: &str,
        measured: &str,
        place: &Place,
        findings: &mut Findings,
    ) {
        let lines = &self.follow[joint];
        let by_correlation =
            |a: &&LineFit, b: &&LineFit| a.correlation().total_cmp(&b.correlation());
        let enough = lines
            .iter()
            .filter(|line| line.count() >= 20 && line.spread() > 0.02);
        let Some(best) = enough.clone().max_by(by_correlation) else {
            return;
        };
        let worst = enough.min_by(by_correlation).unwrap_or(best);
        let (correlation, slope, offset) = (best.correlation(), best.slope(), best.offset());
        let (what, remedy) = if correlation < 0.3 && worst.correlation() < -0.5 {
            let against = worst.correlation();
            (
                format!("{measured} runs against {goal} (correlation {against:.2})"),
                "one of the two counts the other way round: set reversed on it",
            )
        } else if correlation < 0.8 {
            (
                format!("{measured} hardly follows {goal} (correlation {correlation:.2})"),
                "was the drive saturated, stuck, or off? Are the columns named right?",
            )
        } else if !(0.8..1.25).contains(&slope) {
            let guess = match (45.0..72.0).contains(&slope.max(1.0 / slope)) {
                true => "degrees on one side, radians on the other?",
                false => {
                    "a wrong unit, count per turn or gear ratio, or a drive too weak for its goal?"
                }
            };
            (
                format!("{measured} moves {slope:.3} times as far as {goal}: {guess}"),
                "check both columns' units in the model's [log]",
            )
        } else if self.drives[joint] == InputKind::Angle && offset.abs() > 0.1 {
            (
                format!("{measured} lies {offset:.3} rad from {goal} on the mean: a wrong zero?"),
                "set the offset of one of them, unless the load really makes the joint sag so far",
            )
        } else {
            return;
        };
        findings.warn("relation", place.clone(), (what, remedy));
    }

    fn judge_push(&self, joint: usize, input: &str, place: &Place, findings: &mut Findings) {
        if self.drives[joint] != InputKind::Push {
            return;
        }
        let Some(own) = self.push[joint].solve().map(|all| all[5 * joint]) else {
            return;
        };
        if own.t < -SURE {
            let what = format!(
                "{input} pushes the joint the wrong way ({:.1} standard errors)",
                own.t
            );
            let remedy = "the input or the angle counts the other way round: set reversed on it";
            findings.warn("relation", place.clone(), (what, remedy));
        }
    }

    /// A single link must be pulled towards hanging.
    fn judge_gravity(&self, model: &Model, place: &Place, findings: &mut Findings) {
        if self.drives.len() != 1 || matches!(self.drives[0], InputKind::Angle | InputKind::Speed) {
            return;
        }
        let Some(all) = self.push[0].solve() else {
            return;
        };
        let (sine, cosine) = (all[1], all[2]);
        let tilt = cosine.value.atan2(-sine.value);
        if tilt.abs() > 0.35 && sine.t.hypot(cosine.t) > 3.0 * SURE {
            let name = name(&model.log.joints[0].position);
            let what = format!(
                "gravity pulls {tilt:.2} rad beside where {name} has it hang: a wrong angle_zero, \
                 sign or unit, or a tilted rig"
            );
            let remedy = "compare the resting angle in the log with the model's angle_zero";
            findings.warn("relation", place.clone(), (what, remedy));
        }
    }

    fn judge_supply(&self, nominal: Option<f64>, place: &Place, findings: &mut Findings) {
        let Some(nominal) = nominal else {
            return;
        };
        let (low, high) = (self.supply_v.low.0, self.supply_v.high.0);
        if low < 0.5 * nominal || high > 1.5 * nominal {
            let what =
                format!("the supply ranges from {low:.2} to {high:.2} V; {nominal} V is nominal");
            let remedy = "check the supply column's unit, and the wiring";
            findings.warn("supply", place.clone(), (what, remedy));
        }
    }
}

/// Whether a row says all that a stretch needs: every angle and every input.
fn is_whole(row: &LogRow) -> bool {
    let inputs = row.input.iter().flatten();
    let mut all = row.position_rad.iter().chain(inputs);
    all.all(|value| value.is_finite())
}

fn judge_speed(
    line: &LineFit,
    (speed, angle): (&str, &str),
    place: &Place,
    findings: &mut Findings,
) {
    if line.count() < 20 || line.spread() < MOVING_RAD_S {
        return;
    }
    let what = if line.correlation() < -0.5 {
        format!("{speed} runs against the change of {angle}")
    } else if line.correlation() > 0.8 && !(0.8..1.25).contains(&line.slope()) {
        format!("{speed} is {:.3} times the change of {angle}", line.slope())
    } else if line.correlation() < 0.8 {
        format!(
            "{speed} is not the change of {angle} (correlation {:.2})",
            line.correlation()
        )
    } else {
        return;
    };
    let remedy = "check names, units and signs of both columns, and the unit of time";
    findings.warn("relation", place.clone(), (what, remedy));
}
