//! The columns of a rig's logs: names, units, offsets.

use super::rate_sensor::RateSensor;
use super::unit::{Dimension, Unit};

/// One quantity of the log.
#[derive(Debug, Clone, PartialEq)]
pub struct Column {
    /// The header's name.
    pub name: String,
    /// The unit it is written in.
    pub unit: Unit,
    /// Added after scaling to SI; a bench that counts from another zero says so here.
    pub offset: f64,
    /// Whether the column counts the other way round.
    pub reversed: bool,
    /// Smallest step of the value in SI, if the sensor's resolution is known.
    pub resolution: Option<f64>,
    /// Added to the time of this column's samples, s: above 0 where they were taken later than the
    /// time column says.
    pub shift_s: f64,
}

impl Column {
    /// The SI value of a number written in this column.
    pub fn to_si(&self, written: f64) -> f64 {
        let sign = if self.reversed { -1.0 } else { 1.0 };
        sign * self.unit.to_si(written) + self.offset
    }
}

/// Columns of one dimension whose mean is a quantity of a joint: one, or one for each of the servos
/// that turn it together.
#[derive(Debug, Clone, PartialEq)]
pub struct ColumnMean {
    /// At least one.
    columns: Vec<Column>,
}

impl From<Column> for ColumnMean {
    fn from(column: Column) -> ColumnMean {
        ColumnMean {
            columns: vec![column],
        }
    }
}

impl ColumnMean {
    /// The mean of these columns; none of none.
    pub fn of(columns: Vec<Column>) -> Option<ColumnMean> {
        (!columns.is_empty()).then_some(ColumnMean { columns })
    }

    /// The columns, in the order of the model file.
    pub fn columns(&self) -> &[Column] {
        &self.columns
    }

    /// The columns, to be changed.
    pub fn columns_mut(&mut self) -> &mut [Column] {
        &mut self.columns
    }

    /// Their names, for people: `q1_rad` or `q1_rad and q2_rad`.
    pub fn name(&self) -> String {
        let names: Vec<&str> = self.columns.iter().map(|c| c.name.as_str()).collect();
        names.join(" and ")
    }

    /// What they measure.
    pub fn dimension(&self) -> Dimension {
        self.columns[0].unit.dimension
    }

    /// Smallest step in SI where it is known: the largest of the columns', for servos of one shaft
    /// round alike.
    pub fn resolution(&self) -> Option<f64> {
        let steps = self.columns.iter().filter_map(|column| column.resolution);
        steps.reduce(f64::max)
    }
}

/// What a log holds of a joint's motion, and so what a model is compared with there.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MeasuredSignal {
    /// Its angle, rad; a logged speed only helps to guess start states, unless it is of a rate
    /// sensor of its own, which is a signal by itself.
    Angle,
    /// Its displacement, m, of a joint that slides; likewise.
    Displacement,
    /// Its speed alone, rad/s, as of a gyro.
    Rate,
    /// Nothing.
    Nothing,
}

impl MeasuredSignal {
    /// What an error of all joints together is called: of angles and, 1 mm for 1 mrad,
    /// displacements; of displacements alone; of rates where neither is measured.
    pub fn pooled(signals: &[MeasuredSignal]) -> MeasuredSignal {
        let places = [MeasuredSignal::Angle, MeasuredSignal::Displacement];
        let found = places.into_iter().find(|place| signals.contains(place));
        found.unwrap_or(MeasuredSignal::Rate)
    }

    /// Whether a joint of this signal counts in an error of all joints that is called so.
    pub fn counts_in(self, pooled: MeasuredSignal) -> bool {
        match pooled {
            MeasuredSignal::Angle => {
                matches!(self, MeasuredSignal::Angle | MeasuredSignal::Displacement)
            }
            other => self == other,
        }
    }

    /// SI unit, as text.
    pub fn unit(self) -> &'static str {
        match self {
            MeasuredSignal::Rate => "rad/s",
            MeasuredSignal::Displacement => "m",
            MeasuredSignal::Angle | MeasuredSignal::Nothing => "rad",
        }
    }

    /// A thousandth of the unit, as text.
    pub fn milli(self) -> &'static str {
        match self {
            MeasuredSignal::Rate => "mrad/s",
            MeasuredSignal::Displacement => "mm",
            MeasuredSignal::Angle | MeasuredSignal::Nothing => "mrad",
        }
    }

    /// How a key of such a quantity ends.
    pub fn suffix(self) -> &'static str {
        match self {
            MeasuredSignal::Rate => "_rad_s",
            MeasuredSignal::Displacement => "_m",
            MeasuredSignal::Angle | MeasuredSignal::Nothing => "_rad",
        }
    }
}

/// The columns of one joint.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct JointColumns {
    /// Measured angle in the model's convention, if logged.
    pub position: Option<ColumnMean>,
    /// Measured speed, if logged.
    pub velocity: Option<ColumnMean>,
    /// What a rate sensor of its own reads, if the joint has one beside the angle's.
    pub rate: Option<ColumnMean>,
    /// Which sensor that is.
    pub rate_sensor: RateSensor,
    /// The drive's input: torque, duty, goal angle or goal speed; none for a passive joint.
    pub input: Option<ColumnMean>,
}

impl JointColumns {
    /// What the log holds of the joint's motion.
    pub fn signal(&self) -> MeasuredSignal {
        match (&self.position, &self.velocity) {
            (Some(p), _) if p.dimension() == Dimension::Length => MeasuredSignal::Displacement,
            (Some(_), _) => MeasuredSignal::Angle,
            (None, Some(_)) => MeasuredSignal::Rate,
            (None, None) => MeasuredSignal::Nothing,
        }
    }

    /// Whether the log has its angle, or its speed where that is all there is, in degrees.
    pub fn in_degrees(&self) -> bool {
        let first = self.measured().and_then(|mean| mean.columns().first());
        first.is_some_and(|column| column.unit.name.starts_with("deg"))
    }

    /// The columns of [`JointColumns::signal`].
    pub fn measured(&self) -> Option<&ColumnMean> {
        self.position.as_ref().or(self.velocity.as_ref())
    }
}

impl JointColumns {
    /// By how much position, velocity, rate and input are moved in time, s; of several columns for
    /// one quantity the first says so for all.
    pub fn shifts_s(&self) -> [f64; 4] {
        let of = |mean: &Option<ColumnMean>| mean.as_ref().map_or(0.0, |m| m.columns[0].shift_s);
        [&self.position, &self.velocity, &self.rate, &self.input].map(of)
    }
}

/// What a log may say of a rig of one link.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ArmFigures {
    /// kg.
    pub mass_kg: f64,
    /// Joint to centre of mass, m.
    pub com_m: f64,
}

/// A place on a link of a robot in space.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LinkPlace {
    /// The link, counted from 0.
    pub link: usize,
    /// In its frame, m.
    pub at_m: [f64; 3],
}

/// Every column the model reads.
#[derive(Debug, Clone, PartialEq)]
pub struct LogColumns {
    /// Time.
    pub time: Column,
    /// Marks separate motions: each run of equal values is one.
    pub segment: Option<String>,
    /// Supply voltage.
    pub supply: Option<Column>,
    /// 1 while the drives are energised, 0 while they are released.
    pub torque_on: Option<String>,
    /// Mass bolted onto the last link, or a link of a robot in space, during a motion; constant
    /// within one.
    pub payload: Option<Column>,
    /// Where the payload of a planar chain sits, m from the last joint along the link.
    pub payload_at_m: f64,
    /// Where that of a robot in space sits.
    pub payload_on: Option<LinkPlace>,
    /// 1 when the rig was turned by 180 degrees about the vertical, 0 otherwise; constant within a
    /// motion.
    pub turned: Option<String>,
    /// One entry per joint.
    pub joints: Vec<JointColumns>,
    /// The rig's one link, where it has one: a log that names its own is checked against it.
    pub arm: Option<ArmFigures>,
    /// A new motion begins where time jumps by more than this, s; without it a motion goes on
    /// across every gap.
    pub split_at_gap_s: Option<f64>,
}

impl LogColumns {
    /// The joints that have a rate sensor beside the one of their angle.
    pub fn rate_joints(&self) -> Vec<usize> {
        let joints = self.joints.iter().enumerate();
        let sensed = joints.filter(|(_, columns)| columns.rate.is_some());
        sensed.map(|(joint, _)| joint).collect()
    }

    /// What the logs cannot observe of the joints' motion, a sentence each.
    pub fn unobserved(&self) -> Vec<String> {
        let joints = (1..).zip(&self.joints);
        let sentence = |(joint, columns): (usize, &JointColumns)| match columns.signal() {
            MeasuredSignal::Angle | MeasuredSignal::Displacement => None,
            MeasuredSignal::Rate => Some(format!(
                "Joint {joint} has no measured angle, only a rate: its angle is an unknown of each \
                 window, errors are those of the rate, and an offset of the angle does not show."
            )),
            MeasuredSignal::Nothing => Some(format!(
                "Joint {joint} is not measured: its angle and speed are unknowns of each window, \
                 and what acts on it shows only in how the other joints move."
            )),
        };
        let mut sentences: Vec<String> = joints.filter_map(sentence).collect();
        let is = |signal| self.joints.iter().any(|columns| columns.signal() == signal);
        let slides = is(MeasuredSignal::Displacement);
        if !slides && !is(MeasuredSignal::Angle) {
            sentences.push(
                "No angle is measured at all: errors of all joints together are in rad/s, also \
                 where they say rad."
                    .to_string(),
            );
        }
        sentences
    }

    /// The same, which rates count beside angles, and how errors of joints that turn and joints
    /// that slide become one figure.
    pub fn notes(&self) -> Vec<String> {
        let mut sentences = self.unobserved();
        for joint in self.rate_joints() {
            sentences.push(format!(
                "The rate of joint {} counts by its own noise; errors in mrad are of angles alone, \
                 and `handstand compare` tells the rate's.",
                joint + 1
            ));
        }
        let slides = |columns: &JointColumns| columns.signal() == MeasuredSignal::Displacement;
        if self.joints.iter().all(slides) {
            sentences.push(
                "All joints slide: errors of the whole log are in mm, also where they say mrad."
                    .to_string(),
            );
        } else if self.joints.iter().any(slides) {
            sentences.push(
                "Where errors of several joints are one figure in mrad, 1 mm of a joint that \
                 slides counts as 1 mrad."
                    .to_string(),
            );
        }
        sentences
    }
}
