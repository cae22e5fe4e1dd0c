//! One joint's columns by themselves: range, end stops, steps, standing still.

use super::finding::{Findings, Severity};
use crate::error::Place;
use crate::log::row::Row;
use crate::model::{Drive, JointColumns};
use std::f64::consts::{PI, TAU};

/// Standing still for longer than this while the input changes is stuck, s.
const STUCK_S: f64 = 2.0;
/// Stuck runs remembered.
const RUNS: usize = 20;

/// Lowest and highest value, and how often each occurs.
#[derive(Debug, Clone, Copy)]
struct Extremes {
    low: (f64, usize),
    high: (f64, usize),
    count: usize,
}

impl Extremes {
    const NONE: Extremes = Extremes {
        low: (f64::INFINITY, 0),
        high: (f64::NEG_INFINITY, 0),
        count: 0,
    };

    fn take(&mut self, value: f64) {
        self.count += 1;
        let (below, above) = (value < self.low.0, value > self.high.0);
        for (extreme, beyond) in [(&mut self.low, below), (&mut self.high, above)] {
            if beyond {
                *extreme = (value, 1);
            } else if value == extreme.0 {
                extreme.1 += 1;
            }
        }
    }

    fn range(&self) -> f64 {
        (self.high.0 - self.low.0).max(0.0)
    }

    /// The extremes at which more than 5 % of the samples sit, with their share.
    fn crowded(&self) -> impl Iterator<Item = (f64, f64)> {
        let count = self.count.max(1) as f64;
        [self.low, self.high]
            .into_iter()
            .map(move |(value, times)| (value, times as f64 / count))
            .filter(|(_, share)| *share > 0.05)
    }
}

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

    pub fn take(&mut self, row: &Row, joint: usize, fresh: bool, findings: &mut Findings) {
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
                let what = format!("{} jumps by a whole turn", self.position_name);
                let remedy = "the angle wraps round: log it unwrapped, or add the turns";
                findings.add("wrap", Severity::Refuse, place.clone(), what, remedy);
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
            findings.add("unit", Severity::Warn, place.clone(), what, remedy);
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
            findings.add("stuck", Severity::Warn, still.begin, what, remedy);
        }
    }

    fn judge_extremes(&self, place: &Place, drive: &Drive, findings: &mut Findings) {
        let wide = |extremes: &Extremes, steps: &Steps| extremes.range() > 20.0 * steps.smallest;
        if wide(&self.position, &self.position_steps) {
            for (value, share) in self.position.crowded() {
                let what = format!(
                    "{} sits at its extreme, {value:.4} rad, for {:.0} % of the samples",
                    self.position_name,
                    100.0 * share
                );
                let remedy =
                    "an end stop, a hold, or a joint at rest: leave an end stop out by a row range";
                findings.add("extreme", Severity::Warn, place.clone(), what, remedy);
            }
        }
        let drawn = matches!(drive, Drive::Torque | Drive::Duty(_));
        if drawn && wide(&self.input, &self.input_steps) {
            for (value, share) in self.input.crowded().filter(|(value, _)| *value != 0.0) {
                let what = format!(
                    "{} sits at its extreme, {value:.4}, for {:.0} % of the samples",
                    self.input_name,
                    100.0 * share
                );
                let remedy = "if the drive was saturated, the log may hold what was asked, not what was done";
                findings.add("extreme", Severity::Warn, place.clone(), what, remedy);
            }
        }
    }

    fn judge_steps(&self, place: &Place, findings: &mut Findings) {
        let name = &self.position_name;
        let Some(found) = self.position_steps.grid() else {
            return;
        };
        let remedy =
            format!("set the resolution of {name} to {found:.3e} rad if that is the sensor's");
        match self.declared {
            None => {
                let what = format!("{name} moves in steps of {found:.3e} rad; none is declared");
                findings.add("step", Severity::Note, place.clone(), what, remedy);
            }
            Some(declared) if !(0.67..1.5).contains(&(found / declared)) => {
                let what =
                    format!("{name} moves in steps of {found:.3e} rad; {declared:.3e} is declared");
                findings.add("step", Severity::Warn, place.clone(), what, remedy);
            }
            Some(_) => {}
        }
    }
}
