//! One joint's columns by themselves: range, end stops, steps, standing still.

use super::LoggedFile;
use super::excitation::name;
use super::extremes::Extremes;
use super::finding::Findings;
use super::held::HeldReadings;
use super::outlier::Outliers;
use crate::cut::{CutMotion, is_energised};
use crate::error::{Place, Problem};
use crate::model::{ColumnMean, Drive, JointColumns, MeasuredSignal};
use crate::output::number::percent;
use std::f64::consts::{PI, TAU};

/// Standing still for longer than this while the input changes is stuck, s.
const STUCK_S: f64 = 2.0;
/// Stuck runs remembered.
const RUNS: usize = 20;

/// The smallest change seen from sample to sample, and how often.
#[derive(Debug, Default)]
struct StepSizes {
    previous: Option<f64>,
    smallest: f64,
    alike: usize,
    changes: usize,
}

impl StepSizes {
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
    /// Line of its begin.
    line: usize,
    from_s: f64,
    to_s: f64,
    input: Extremes,
}

/// One column of the joint.
#[derive(Debug)]
struct ColumnSeries {
    name: String,
    extremes: Extremes,
    steps: StepSizes,
}

impl ColumnSeries {
    fn new(name: String) -> Self {
        ColumnSeries {
            name,
            extremes: Extremes::NONE,
            steps: StepSizes::default(),
        }
    }

    fn take(&mut self, value: f64) {
        if value.is_finite() {
            self.extremes.take(value);
            self.steps.take(value);
        }
    }

    /// Extremes at which many samples sit, with their share, of a column that moves at all.
    fn crowded(&self) -> impl Iterator<Item = (f64, f64)> {
        let wide = self.extremes.range() > 20.0 * self.steps.smallest;
        self.extremes.crowded().filter(move |_| wide)
    }
}

/// Running judgement of one joint in one file.
pub(super) struct JointCheck {
    joint: usize,
    signal: MeasuredSignal,
    position: ColumnSeries,
    /// The rate, where there is no angle.
    rate: ColumnSeries,
    input: ColumnSeries,
    /// Rows seen.
    rows: usize,
    /// Declared resolution of the position, rad, or m of a slide.
    declared_rad: Option<f64>,
    still: Option<Still>,
    stuck: Vec<Still>,
    held: HeldReadings,
    outliers: Outliers,
    /// Lines in which the angle has jumped by a whole turn.
    wraps: Vec<usize>,
}

impl JointCheck {
    pub fn new(columns: &JointColumns, joint: usize) -> Self {
        let declared = columns.position.as_ref().and_then(ColumnMean::resolution);
        JointCheck {
            joint,
            signal: columns.signal(),
            position: ColumnSeries::new(name(&columns.position)),
            rate: ColumnSeries::new(name(&columns.velocity)),
            input: ColumnSeries::new(name(&columns.input)),
            rows: 0,
            declared_rad: declared,
            still: None,
            stuck: Vec::new(),
            held: HeldReadings::default(),
            outliers: Outliers::default(),
            wraps: Vec::new(),
        }
    }

    pub fn take(&mut self, CutMotion { motion, lines, .. }: &CutMotion) {
        let joint = self.joint;
        let (angles, input) = (&motion.position_rad[joint], &motion.input[joint]);
        let rate = &motion.velocity_rad_s[joint];
        self.rows += motion.len();
        self.position.steps.previous = None;
        self.input.steps.previous = None;
        self.held.restart();
        self.outliers.restart();
        for (k, angle) in angles.iter().enumerate() {
            let input = input.as_ref().map(|input| input[k]);
            let input = input.filter(|input| is_energised(motion, k) && input.is_finite());
            if let Some(input) = input {
                self.input.take(input);
            }
            if angle.is_finite() {
                self.take_angle(*angle, motion.time_s[k], lines[k], input);
            } else {
                self.outliers.restart();
                rate.iter().for_each(|rate| self.rate.take(rate[k]));
            }
        }
        self.end_still();
    }

    fn take_angle(&mut self, angle: f64, time_s: f64, line: usize, input: Option<f64>) {
        let previous = self.position.steps.previous;
        let jumped = |previous: f64| ((angle - previous).abs() - TAU).abs() < 0.5;
        if previous.is_some_and(jumped) {
            self.wraps.push(line);
        }
        if previous != Some(angle) {
            self.end_still();
        }
        self.held.take(angle, self.position.steps.smallest, line);
        self.position.take(angle);
        self.outliers.take(angle, line);
        let still = self.still.get_or_insert(Still {
            line,
            from_s: time_s,
            to_s: time_s,
            input: Extremes::NONE,
        });
        still.to_s = time_s;
        input.into_iter().for_each(|input| still.input.take(input));
    }

    /// Keeps a still run that lasted while the input changed; the largest changes if there are
    /// many.
    fn end_still(&mut self) {
        let Some(still) = self.still.take() else {
            return;
        };
        if still.to_s - still.from_s <= STUCK_S || still.input.range() <= 0.0 {
            return;
        }
        self.stuck.push(still);
        self.stuck
            .sort_by(|a, b| b.input.range().total_cmp(&a.input.range()));
        self.stuck.truncate(RUNS);
    }

    pub fn judge(&self, file: &LoggedFile, drive: &Drive, findings: &mut Findings) {
        let place = &file.place();
        let column = &self.position.name;
        let named = (column.as_str(), file.cut.fields.position[self.joint]);
        let turns = self.signal == MeasuredSignal::Angle;
        for line in self.wraps.iter().filter(|_| turns) {
            let problem = Problem::new(
                format!("{column} jumps by a whole turn"),
                "the angle wraps round: log it unwrapped, or add the turns",
            );
            findings.refuse("wrap", file.at(*line, named.1), &problem);
        }
        self.judge_missing(place, findings);
        self.judge_stuck(named.1, file, findings);
        self.held.judge(named, file, findings);
        self.outliers
            .judge(named, self.signal.unit(), file, findings);
        self.judge_extremes(place, drive, findings);
        self.judge_steps(place, findings);
        let range = self.position.extremes.range();
        if turns && matches!(drive, Drive::Position { .. }) && range > 4.0 * PI {
            let what = format!("{column} ranges over {range:.0} rad: degrees declared as rad?");
            let remedy = "check the column's unit in the model's [log]";
            findings.warn("unit", place.clone(), (what, remedy));
        }
    }

    /// How many of the samples are gaps.
    fn judge_missing(&self, place: &Place, findings: &mut Findings) {
        let series = match self.signal {
            MeasuredSignal::Angle | MeasuredSignal::Displacement => &self.position,
            MeasuredSignal::Rate => &self.rate,
            MeasuredSignal::Nothing => return,
        };
        let (column, found) = (series.name.clone(), series.extremes.count);
        if (1..self.rows).contains(&found) {
            let share = percent((self.rows - found) as f64 / self.rows as f64);
            let what = format!("{column} is missing in {share} of the rows");
            let remedy = "the model runs on through gaps; many show a bad line";
            findings.note("missing", place.clone(), (what, remedy));
        }
    }

    fn judge_stuck(&self, field: usize, file: &LoggedFile, findings: &mut Findings) {
        let least = 0.1 * self.input.extremes.range();
        let (position, input) = (&self.position.name, &self.input.name);
        for still in self.stuck.iter().filter(|s| s.input.range() > least) {
            let (lasts_s, range) = (still.to_s - still.from_s, still.input.range());
            let what = format!(
                "{position} does not change for {lasts_s:.1} s while {input} ranges over {range:.3}"
            );
            let remedy = "an end stop, a dead encoder, or stiction: leave the rows out unless \
                          stiction is the question";
            findings.warn("stuck", file.at(still.line, field), (what, remedy));
        }
    }

    fn judge_extremes(&self, place: &Place, drive: &Drive, findings: &mut Findings) {
        let mut warn = |name: &str, unit: &str, found: &[(f64, f64)], remedy: &str| {
            let values: Vec<String> = found.iter().map(|(v, _)| format!("{v:.4}{unit}")).collect();
            let shares = found
                .iter()
                .map(|(_, share)| format!("{:.0} %", 100.0 * share));
            let (values, shares) = (
                values.join(" and "),
                shares.collect::<Vec<_>>().join(" and "),
            );
            let extremes = match found.len() {
                0 => return,
                1 => "extreme",
                _ => "extremes",
            };
            let what =
                format!("{name} sits at its {extremes}, {values}, for {shares} of the samples");
            findings.warn("extreme", place.clone(), (what, remedy));
        };
        let remedy =
            "an end stop, a hold, or a joint at rest: leave an end stop out by a row range";
        let unit = format!(" {}", self.signal.unit());
        let found: Vec<_> = self.position.crowded().collect();
        warn(&self.position.name, &unit, &found, remedy);
        let drawn = matches!(drive, Drive::Torque | Drive::Duty(_));
        let remedy =
            "if the drive was saturated, the log may hold what was asked, not what was done";
        let found = self
            .input
            .crowded()
            .filter(|extreme| drawn && extreme.0 != 0.0);
        warn(&self.input.name, "", &found.collect::<Vec<_>>(), remedy);
    }

    fn judge_steps(&self, place: &Place, findings: &mut Findings) {
        let name = &self.position.name;
        let Some(found) = self.position.steps.grid() else {
            return;
        };
        let unit = self.signal.unit();
        let steps = format!("{name} moves in steps of {found:.3e} {unit}");
        let key = format!("resolution_{}", unit.replace('/', "_"));
        let remedy = format!(
            "write {key} = {found:.3e} beside {name:?} in the model's [log] if that is the sensor's"
        );
        let place = place.clone();
        match self.declared_rad {
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
