//! One joint's columns by themselves: range, end stops, steps, standing still.

use super::extremes::Extremes;
use super::finding::Findings;
use crate::error::Place;
use crate::log::LogReason;
use crate::log::row::LogRow;
use crate::model::{Drive, JointColumns};
use std::f64::consts::{PI, TAU};

/// Standing still for longer than this while the input changes is stuck, s.
const STUCK_S: f64 = 2.0;
/// Stuck runs remembered.
const RUNS: usize = 20;

/// The smallest change seen from sample to sample, and how often.
#[derive(Debug, Default)]
struct Steps {
    previous: Option<f64>,
    smallest: f64,
    alike: usize,
    changes: usize,
}

impl Steps {
    fn take(&mut self, value: f64) {
        let step = (value - self.previous.unwrap_or(value)).abs();
        self.previous = Some(value);
        if step == 0.0 {
            return;
        }
        self.changes += 1;
        if self.alike == 0 || step < 0.95 * self.smallest {
            (self.smallest, self.alike) = (step, 1);
        } else if step < 1.05 * self.smallest {
            self.alike += 1;
        }
    }

    /// The step of the sensor, if the smallest change recurs as a counter's does.
    fn grid(&self) -> Option<f64> {
        (self.alike >= 5 && 50 * self.alike > self.changes).then_some(self.smallest)
    }
}

/// A time during which the position did not change at all.
#[derive(Debug, Clone)]
struct Still {
    begin: Place,
    from_s: f64,
    to_s: f64,
    input: Extremes,
}

/// Running judgement of one joint in one file.
pub(super) struct JointCheck {
    position_name: String,
    input_name: String,
    declared: Option<f64>,
    position: Extremes,
    input: Extremes,
    position_steps: Steps,
    input_steps: Steps,
    still: Option<Still>,
    stuck: Vec<Still>,
    stuck_count: usize,
}

impl JointCheck {
    pub fn new(columns: &JointColumns) -> Self {
        JointCheck {
            position_name: columns.position.name.clone(),
            input_name: columns
                .input
                .as_ref()
                .map_or(String::new(), |c| c.name.clone()),
            declared: columns.position.resolution,
            position: Extremes::NONE,
            input: Extremes::NONE,
            position_steps: Steps::default(),
            input_steps: Steps::default(),
            still: None,
            stuck: Vec::new(),
            stuck_count: 0,
        }
    }

    pub fn take(&mut self, row: &LogRow, joint: usize, fresh: bool, findings: &mut Findings) {
        let angle = row.position_rad[joint];
        let place = row.place(row.fields.position[joint]);
        if fresh {
            self.end_still();
            self.position_steps.previous = None;
            self.input_steps.previous = None;
        }
        if let Some(previous) = self.position_steps.previous {
            let jump = (angle - previous).abs();
            if (jump - TAU).abs() < 0.5 {
                let column = self.position_name.clone();
                let reason = LogReason::AngleWraps { column };
                findings.refuse("wrap", place.clone(), &reason);
            }
        }
        let moved = self.position_steps.previous != Some(angle);
        self.position.take(angle);
        self.position_steps.take(angle);
        if moved {
            self.end_still();
        }
        let energised = row.torque_on != Some(false);
        let input = row.input[joint].filter(|_| energised);
        if let Some(input) = input {
            self.input.take(input);
            self.input_steps.take(input);
        }
        let still = self.still.get_or_insert(Still {
            begin: place,
            from_s: row.time_s,
            to_s: row.time_s,
            input: Extremes::NONE,
        });
        still.to_s = row.time_s;
        if let Some(input) = input {
            still.input.take(input);
        }
    }

    /// Keeps a still run that lasted while the input changed; the largest changes if there are many.
    fn end_still(&mut self) {
        let Some(still) = self.still.take() else {
            return;
        };
        if still.to_s - still.from_s <= STUCK_S || still.input.range() <= 0.0 {
            return;
        }
        self.stuck_count += 1;
        self.stuck.push(still);
        self.stuck
            .sort_by(|a, b| b.input.range().total_cmp(&a.input.range()));
        self.stuck.truncate(RUNS);
    }

    pub fn judge(&mut self, place: &Place, drive: &Drive, findings: &mut Findings) {
        self.end_still();
        self.judge_stuck(findings);
        self.judge_extremes(place, drive, findings);
        self.judge_steps(place, findings);
        let name = &self.position_name;
        if matches!(drive, Drive::Position { .. }) && self.position.range() > 4.0 * PI {
            let range = self.position.range();
            let what = format!("{name} ranges over {range:.0} rad: degrees declared as rad?");
            let remedy = "check the column's unit in the model's [log]";
            findings.warn("unit", place.clone(), (what, remedy));
        }
    }

    fn judge_stuck(&mut self, findings: &mut Findings) {
        let whole = self.input.range();
        for still in self
            .stuck
            .drain(..)
            .filter(|s| s.input.range() > 0.1 * whole)
        {
            let what = format!(
                "{} does not change for {:.1} s while {} ranges over {:.3}",
                self.position_name,
                still.to_s - still.from_s,
                self.input_name,
                still.input.range()
            );
            let remedy = "an end stop, a dead encoder, or stiction: leave the rows out unless stiction is the question";
            findings.warn("stuck", still.begin, (what, remedy));
        }
    }

    fn judge_extremes(&self, place: &Place, drive: &Drive, findings: &mut Findings) {
        let mut warn = |name: &str, unit: &str, (value, share): (f64, f64), remedy: &str| {
            let share = 100.0 * share;
            let what = format!(
                "{name} sits at its extreme, {value:.4}{unit}, for {share:.0} % of the samples"
            );
            findings.warn("extreme", place.clone(), (what, remedy));
        };
        if self.position.range() > 20.0 * self.position_steps.smallest {
            let remedy =
                "an end stop, a hold, or a joint at rest: leave an end stop out by a row range";
            for extreme in self.position.crowded() {
                warn(&self.position_name, " rad", extreme, remedy);
            }
        }
        let drawn = matches!(drive, Drive::Torque | Drive::Duty(_));
        if drawn && self.input.range() > 20.0 * self.input_steps.smallest {
            let remedy =
                "if the drive was saturated, the log may hold what was asked, not what was done";
            for extreme in self.input.crowded().filter(|(value, _)| *value != 0.0) {
                warn(&self.input_name, "", extreme, remedy);
            }
        }
    }

    fn judge_steps(&self, place: &Place, findings: &mut Findings) {
        let name = &self.position_name;
        let Some(found) = self.position_steps.grid() else {
            return;
        };
        let steps = format!("{name} moves in steps of {found:.3e} rad");
        let remedy =
            format!("set the resolution of {name} to {found:.3e} rad if that is the sensor's");
        let place = place.clone();
        match self.declared {
            None => findings.note(
                "step",
                place,
                (format!("{steps}; none is declared"), &remedy),
            ),
            Some(declared) if !(0.67..1.5).contains(&(found / declared)) => {
                let what = format!("{steps}; {declared:.3e} is declared");
                findings.warn("step", place, (what, &remedy));
            }
            Some(_) => {}
        }
    }
}
