//! The columns of a rig's logs: names, units, offsets.

use super::unit::Unit;

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

    /// The number written for an SI value; undoes [`Column::to_si`].
    pub fn written(&self, si: f64) -> f64 {
        let sign = if self.reversed { -1.0 } else { 1.0 };
        sign * (si - self.offset) / self.unit.si
    }
}

/// The columns of one joint.
#[derive(Debug, Clone, PartialEq)]
pub struct JointColumns {
    /// Measured angle in the model's convention.
    pub position: Column,
    /// Measured speed, if logged.
    pub velocity: Option<Column>,
    /// The drive's input: torque, duty, goal angle or goal speed; none for a passive joint.
    pub input: Option<Column>,
}

impl JointColumns {
    /// By how much position, velocity and input are moved in time, s.
    pub fn shifts_s(&self) -> [f64; 3] {
        let of = |column: &Option<Column>| column.as_ref().map_or(0.0, |column| column.shift_s);
        [self.position.shift_s, of(&self.velocity), of(&self.input)]
    }
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
    /// Mass bolted onto the last link during a motion; constant within one.
    pub payload: Option<Column>,
    /// Where the payload sits, m from the last joint along the link.
    pub payload_at_m: f64,
    /// 1 when the rig was turned by 180 degrees about the vertical, 0 otherwise; constant within a
    /// motion.
    pub turned: Option<String>,
    /// One entry per joint.
    pub joints: Vec<JointColumns>,
    /// A new motion begins where time jumps by more than this, s; without it a motion goes on
    /// across every gap.
    pub split_at_gap_s: Option<f64>,
}
