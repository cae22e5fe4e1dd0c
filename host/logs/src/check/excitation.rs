//! Excitation of each joint over all motions: reversals, travel, speed, holds.

use super::extremes::Extremes;
use super::finding::Findings;
use crate::cut::is_energised;
use crate::error::Place;
use crate::model::{ColumnMean, JointColumns, Model};
use crate::motion::Motion;

/// Least swing that counts as a reversal where the encoder is fine, rad.
const SWING_RAD: f64 = 0.02;
/// Least such travel of a joint that slides, m.
const STROKE_M: f64 = 0.005;
/// Time without a swing that counts as a hold, s.
const HOLD_S: f64 = 0.5;

/// Running account of every joint.
pub(super) struct ExcitationCheck {
    joints: Vec<JointExcitation>,
    motions: usize,
}

struct JointExcitation {
    position_name: String,
    slides: bool,
    input_name: Option<String>,
    driven: bool,
    swing_rad: f64,
    position_rad: Extremes,
    input: Extremes,
    reversals: usize,
    holds: usize,
    top_speed_rad_s: f64,
    now: Option<MotionState>,
}

/// State within a motion.
struct MotionState {
    /// Farthest point in the present direction, rad.
    turning_rad: f64,
    /// -1, 0 or 1.
    direction: f64,
    /// Where and since when the joint has not left a swing's width, and whether that is counted.
    rest: (f64, f64, bool),
    /// Begin of the present stretch for the speed: time, angle.
    stretch: (f64, f64),
}

impl ExcitationCheck {
    pub fn new(model: &Model) -> Self {
        let joints = model.log.joints.iter().zip(&model.joints);
        ExcitationCheck {
            motions: 0,
            joints: joints
                .map(|(columns, joint)| JointExcitation {
                    position_name: name(&columns.position),
                    input_name: columns.input.as_ref().map(ColumnMean::name),
                    driven: joint.drive.is_driven(),
                    slides: joint.slide.is_some(),
                    swing_rad: match joint.slide {
                        None => SWING_RAD,
                        Some(_) => STROKE_M,
                    }
                    .max(4.0 * resolution_rad(columns)),
                    position_rad: Extremes::NONE,
                    input: Extremes::NONE,
                    reversals: 0,
                    holds: 0,
                    top_speed_rad_s: 0.0,
                    now: None,
                })
                .collect(),
        }
    }

    pub fn take(&mut self, motion: &Motion) {
        self.motions += 1;
        for (i, joint) in self.joints.iter_mut().enumerate() {
            joint.now = None;
            for (k, input) in motion.input[i].iter().flatten().enumerate() {
                if is_energised(motion, k) {
                    joint.input.take(*input);
                }
            }
            for (time_s, angle) in motion.time_s.iter().zip(&motion.position_rad[i]) {
                if angle.is_finite() {
                    joint.take(*time_s, *angle);
                }
            }
        }
    }

    pub fn judge(&self, place: Option<&Place>, findings: &mut Findings) {
        for joint in self
            .joints
            .iter()
            .filter(|joint| joint.position_rad.count > 0)
        {
            joint.judge(place, self.motions, findings);
        }
    }
}

impl JointExcitation {
    fn take(&mut self, time_s: f64, angle: f64) {
        self.position_rad.take(angle);
        let now = self.now.get_or_insert(MotionState {
            turning_rad: angle,
            direction: 0.0,
            rest: (angle, time_s, false),
            stretch: (time_s, angle),
        });
        let away = angle - now.turning_rad;
        if away * now.direction > 0.0 {
            now.turning_rad = angle;
        } else if away.abs() > self.swing_rad {
            self.reversals += usize::from(now.direction != 0.0);
            now.direction = away.signum();
            now.turning_rad = angle;
        }
        let (rest, since, counted) = now.rest;
        if (angle - rest).abs() > self.swing_rad {
            now.rest = (angle, time_s, false);
        } else if !counted && time_s - since > HOLD_S {
            self.holds += 1;
            now.rest.2 = true;
        }
        let (from_s, from) = now.stretch;
        if time_s - from_s >= 0.05 {
            let speed = ((angle - from) / (time_s - from_s)).abs();
            self.top_speed_rad_s = self.top_speed_rad_s.max(speed);
            now.stretch = (time_s, angle);
        }
    }

    fn judge(&self, place: Option<&Place>, motions: usize, findings: &mut Findings) {
        let (name, kind) = (&self.position_name, "excitation");
        let (range, top) = (self.position_rad.range(), self.top_speed_rad_s);
        let unit = if self.slides { "m" } else { "rad" };
        let what = format!(
            "{name} in {}: {}, {range:.2} {unit} of travel, up to {top:.1} {unit}/s, {}",
            counted(motions, "motion"),
            counted(self.reversals, "reversal"),
            counted(self.holds, "hold")
        );
        let remedy = "what the logs can tell apart depends on these";
        findings.note(kind, place.cloned(), (what, remedy));
        let mut warn = |what: String, remedy| findings.warn(kind, place.cloned(), (what, remedy));
        if self.reversals < 4 {
            let reversals = counted(self.reversals, "reversal");
            let what =
                format!("{name} shows {reversals}: friction and backlash can't be told apart");
            warn(what, "record motions that go to and fro");
        }
        if range < 0.3 && !self.slides {
            let what = format!(
                "{name} travels only {range:.3} rad: gravity and a constant torque can't be told \
                 apart"
            );
            warn(what, "record wider motions");
        }
        let slow = if self.slides { 0.05 } else { 0.5 };
        if top < slow {
            let what = format!(
                "{name} never exceeds {top:.2} {unit}/s: what grows with speed can't be told from \
                 what does not"
            );
            warn(what, "record faster motions too");
        }
        if self.holds == 0 {
            let what = format!("{name} is never held still: breakaway does not show");
            let remedy = "add a rest of a second, then a slow start";
            findings.note(kind, place.cloned(), (what, remedy));
        }
        if let Some(input) = self.input_name.as_ref().filter(|_| self.driven)
            && self.input.range() <= 0.0
        {
            let what = format!("{input} never changes: the drive's constants can't be found");
            let remedy = "record motions under changing input";
            findings.warn(kind, place.cloned(), (what, remedy));
        }
    }
}

/// Names of the columns of a quantity; empty where it is not logged.
pub(super) fn name(columns: &Option<ColumnMean>) -> String {
    columns.as_ref().map(ColumnMean::name).unwrap_or_default()
}

/// Resolution of a joint's angle, rad; 0 where it is not known.
fn resolution_rad(columns: &JointColumns) -> f64 {
    let position = columns.position.as_ref();
    position.and_then(ColumnMean::resolution).unwrap_or(0.0)
}

/// "1 hold", "no reversals".
fn counted(count: usize, what: &str) -> String {
    match count {
        0 => format!("no {what}s"),
        1 => format!("1 {what}"),
        count => format!("{count} {what}s"),
    }
}
