//! What all motions together can tell apart.

use super::finding::{Findings, Severity};
use crate::error::Place;
use crate::log::row::Row;
use crate::model::Model;

/// Least swing that counts as a reversal where the encoder is fine, rad.
const SWING_RAD: f64 = 0.02;
/// Time without a swing that counts as a hold, s.
const HOLD_S: f64 = 0.5;

/// Running account of every joint.
pub(super) struct Excitation {
    joints: Vec<Joint>,
    motions: usize,
}

struct Joint {
    position_name: String,
    input_name: Option<String>,
    driven: bool,
    swing_rad: f64,
    range_rad: (f64, f64),
    input: (f64, f64),
    reversals: usize,
    holds: usize,
    top_speed_rad_s: f64,
    now: Option<Now>,
}

/// State within a motion.
struct Now {
    /// Farthest point in the present direction, rad.
    turning_rad: f64,
    /// -1, 0 or 1.
    direction: f64,
    /// Where and since when the joint has not left a swing's width, and whether that is counted.
    rest: (f64, f64, bool),
    /// Begin of the present stretch for the speed: time, angle.
    stretch: (f64, f64),
}

impl Excitation {
    pub fn new(model: &Model) -> Self {
        let joints = model.log.joints.iter().zip(&model.joints);
        Excitation {
            motions: 0,
            joints: joints
                .map(|(columns, joint)| Joint {
                    position_name: columns.position.name.clone(),
                    input_name: columns.input.as_ref().map(|column| column.name.clone()),
                    driven: joint.drive.is_driven(),
                    swing_rad: SWING_RAD.max(4.0 * columns.position.resolution.unwrap_or(0.0)),
                    range_rad: (f64::INFINITY, f64::NEG_INFINITY),
                    input: (f64::INFINITY, f64::NEG_INFINITY),
                    reversals: 0,
                    holds: 0,
                    top_speed_rad_s: 0.0,
                    now: None,
                })
                .collect(),
        }
    }

    pub fn take(&mut self, row: &Row, fresh: bool) {
        self.motions += usize::from(fresh);
        for (i, joint) in self.joints.iter_mut().enumerate() {
            if fresh {
                joint.now = None;
            }
            let energised = row.torque_on != Some(false);
            if let Some(input) = row.input[i].filter(|_| energised) {
                joint.input = (joint.input.0.min(input), joint.input.1.max(input));
            }
            joint.take(row.time_s, row.position_rad[i]);
        }
    }

    pub fn judge(&self, place: Option<&Place>, findings: &mut Findings) {
        for joint in self
            .joints
            .iter()
            .filter(|joint| joint.range_rad.0.is_finite())
        {
            joint.judge(place, self.motions, findings);
        }
    }
}

impl Joint {
    fn take(&mut self, time_s: f64, angle: f64) {
        self.range_rad = (self.range_rad.0.min(angle), self.range_rad.1.max(angle));
        let now = self.now.get_or_insert(Now {
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
        let name = &self.position_name;
        let range = self.range_rad.1 - self.range_rad.0;
        let mut add = |severity, what: String, remedy: &str| {
            findings.add("excitation", severity, place.cloned(), what, remedy);
        };
        add(
            Severity::Note,
            format!(
                "{name} in {}: {}, {range:.2} rad of travel, up to {:.1} rad/s, {}",
                counted(motions, "motion"),
                counted(self.reversals, "reversal"),
                self.top_speed_rad_s,
                counted(self.holds, "hold")
            ),
            "what the logs can tell apart depends on these",
        );
        if self.reversals < 4 {
            add(
                Severity::Warn,
                format!(
                    "{name} shows {}: friction and backlash can't be told apart",
                    counted(self.reversals, "reversal")
                ),
                "record motions that go to and fro",
            );
        }
        if range < 0.3 {
            add(
                Severity::Warn,
                format!(
                    "{name} travels only {range:.3} rad: gravity and a constant torque can't be told apart"
                ),
                "record wider motions",
            );
        }
        if self.top_speed_rad_s < 0.5 {
            add(
                Severity::Warn,
                format!(
                    "{name} never exceeds {:.2} rad/s: what grows with speed can't be told from what does not",
                    self.top_speed_rad_s
                ),
                "record faster motions too",
            );
        }
        if self.holds == 0 {
            add(
                Severity::Note,
                format!("{name} is never held still: breakaway does not show"),
                "add a rest of a second, then a slow start",
            );
        }
        if let Some(input) = self.input_name.as_ref().filter(|_| self.driven)
            && self.input.1 - self.input.0 <= 0.0
        {
            add(
                Severity::Warn,
                format!("{input} never changes: the drive's constants can't be found"),
                "record motions under changing input",
            );
        }
    }
}

/// "1 hold", "no reversals".
fn counted(count: usize, what: &str) -> String {
    match count {
        0 => format!("no {what}s"),
        1 => format!("1 {what}"),
        count => format!("{count} {what}s"),
    }
}
