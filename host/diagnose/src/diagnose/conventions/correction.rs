//! What may be wrong between a model file and its logs, each as the change that mends it.

use super::joint_corrections::{of_motion, of_speed};
use super::reread::{reread, written};
use crate::log::init::name_guess;
use crate::model::{
    AngleZero, Angles, Column, ColumnMean, Dimension, Drive, Model, ParameterPath, Unit,
};
use crate::motion::Motion;

/// A column of the logs, or of one joint of them (index from 0).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LogColumn {
    /// The time of the samples.
    Time,
    /// A joint's angle.
    Position(usize),
    /// A joint's speed.
    Velocity(usize),
    /// What a rate sensor reads that a joint has beside the one of its angle.
    Rate(usize),
    /// A joint's input.
    Input(usize),
}

impl LogColumn {
    /// Its columns, if the logs have it: one, or those of several servos.
    pub fn columns(self, model: &Model) -> &[Column] {
        let joint = |joint: usize| model.log.joints.get(joint);
        let mean = match self {
            LogColumn::Time => return std::slice::from_ref(&model.log.time),
            LogColumn::Position(j) => joint(j).and_then(|columns| columns.position.as_ref()),
            LogColumn::Velocity(j) => joint(j).and_then(|columns| columns.velocity.as_ref()),
            LogColumn::Rate(j) => joint(j).and_then(|columns| columns.rate.as_ref()),
            LogColumn::Input(j) => joint(j).and_then(|columns| columns.input.as_ref()),
        };
        mean.map_or(&[], ColumnMean::columns)
    }

    /// Its first column, which states the unit, if the logs have it.
    pub fn column(self, model: &Model) -> Option<&Column> {
        self.columns(model).first()
    }

    fn columns_mut(self, model: &mut Model) -> &mut [Column] {
        let joints = &mut model.log.joints;
        let mean = match self {
            LogColumn::Time => return std::slice::from_mut(&mut model.log.time),
            LogColumn::Position(j) => joints.get_mut(j).and_then(|c| c.position.as_mut()),
            LogColumn::Velocity(j) => joints.get_mut(j).and_then(|c| c.velocity.as_mut()),
            LogColumn::Rate(j) => joints.get_mut(j).and_then(|c| c.rate.as_mut()),
            LogColumn::Input(j) => joints.get_mut(j).and_then(|c| c.input.as_mut()),
        };
        mean.map_or(&mut [], ColumnMean::columns_mut)
    }
}

/// A change of the model file that may mend how it reads its logs.
#[derive(Debug, Clone, PartialEq)]
pub enum Correction {
    /// These columns count the other way round.
    Reverse(Vec<LogColumn>),
    /// The angles are zero elsewhere.
    AngleZero(AngleZero),
    /// The zeros of these columns lie elsewhere: what is added to their offsets, in SI.
    Offset(Vec<LogColumn>, f64),
    /// These columns are written in other units.
    Unit(Vec<(LogColumn, Unit)>),
    /// The angles are measured from something else.
    Angles(Angles),
    /// Another drive moves the joint (index from 0), and its input is written in this unit.
    Drive(usize, Drive, Unit),
    /// A column's samples were taken this much later than the log says, s; earlier below 0.
    Shift(LogColumn, f64),
}

impl Correction {
    /// The model that reads its logs so.
    pub fn applied(&self, model: &Model) -> Model {
        let mut new = model.clone();
        match self {
            Correction::Reverse(columns) => {
                for quantity in columns {
                    for column in quantity.columns_mut(&mut new) {
                        column.reversed = !column.reversed;
                    }
                }
            }
            Correction::AngleZero(zero) => new.angle_zero = *zero,
            Correction::Offset(columns, added) => {
                for quantity in columns {
                    for column in quantity.columns_mut(&mut new) {
                        column.offset += added;
                    }
                }
            }
            Correction::Unit(columns) => {
                for (quantity, unit) in columns {
                    for column in quantity.columns_mut(&mut new) {
                        // A step of one tick goes with its unit.
                        let is_tick = column.resolution == Some(column.unit.si);
                        let declared = column.resolution.filter(|_| !is_tick);
                        let tick = (unit.name == "ticks").then_some(unit.si);
                        column.resolution = declared.or(tick);
                        column.unit = *unit;
                    }
                }
            }
            Correction::Angles(angles) => new.angles = *angles,
            Correction::Drive(joint, drive, unit) => {
                new.joints[*joint].drive = drive.clone();
                // Another kind of drive has other values.
                let has = |path: &ParameterPath| path.get(&new).is_some_and(f64::is_finite);
                new.free = model.free.iter().copied().filter(has).collect();
                for column in LogColumn::Input(*joint).columns_mut(&mut new) {
                    column.unit = *unit;
                }
            }
            Correction::Shift(quantity, shift_s) => {
                for column in quantity.columns_mut(&mut new) {
                    column.shift_s = *shift_s;
                }
            }
        }
        new
    }

    /// The motions as the mended model reads them.
    pub fn reread(&self, model: &Model, motions: &[Motion]) -> Vec<Motion> {
        let new = self.applied(model);
        motions
            .iter()
            .map(|motion| reread(motion, &model.log, &new.log))
            .collect()
    }

    /// The joint (index from 0) whose angle and goal it reads otherwise alike, as another
    /// calibration of its servo does: the drive moves as before, and stands elsewhere.
    pub fn calibrates(&self) -> Option<usize> {
        let holds = |columns: &[LogColumn]| {
            let goals = columns.iter().filter_map(|column| match column {
                LogColumn::Input(joint) => Some(*joint),
                _ => None,
            });
            let mut both = goals.filter(|joint| columns.contains(&LogColumn::Position(*joint)));
            both.next()
        };
        match self {
            Correction::Reverse(columns) | Correction::Offset(columns, _) => holds(columns),
            Correction::Unit(columns) => {
                let columns: Vec<LogColumn> = columns.iter().map(|(column, _)| *column).collect();
                holds(&columns)
            }
            _ => None,
        }
    }

    /// Whether it is about the unit of an angle.
    pub(super) fn reads_an_angle_in_another_unit(&self) -> bool {
        let is_angle = |(column, _): &(LogColumn, Unit)| matches!(column, LogColumn::Position(_));
        matches!(self, Correction::Unit(columns) if columns.iter().any(is_angle))
    }

    /// Whether it changes a number that could have any value, not one of a few alternatives.
    pub fn is_continuous(&self) -> bool {
        matches!(self, Correction::Offset(..) | Correction::Shift(..))
    }
}

/// Counts per turn of common encoders; 1228.8 is the AX-12's 1024 over 300 degrees.
const TICKS_PER_TURN: [f64; 8] = [
    1000.0, 1024.0, 1228.8, 2048.0, 4000.0, 4096.0, 8192.0, 16384.0,
];

/// Every alternative to how the model reads its logs that has no free number: signs, zeros, units,
/// what angles are measured from.
pub(super) fn alternatives(model: &Model, motions: &[Motion]) -> Vec<Correction> {
    let mut all = Vec::new();
    let zeros = [
        AngleZero::Hanging,
        AngleZero::Upright,
        AngleZero::Horizontal,
    ];
    let others = zeros.into_iter().filter(|zero| *zero != model.angle_zero);
    // The angles of a robot in space are its file's.
    if !model.is_in_space() {
        all.extend(others.map(Correction::AngleZero));
    }
    if model.link_count() > 1 && !model.slides() && !model.is_in_space() {
        all.push(Correction::Angles(match model.angles {
            Angles::Relative => Angles::Absolute,
            Angles::Absolute => Angles::Relative,
        }));
    }
    for joint in 0..model.link_count() {
        all.extend(of_motion(model, motions, joint));
        all.extend(of_speed(model, motions, LogColumn::Rate(joint)));
        if model.joints[joint].drive.is_driven() {
            let input = LogColumn::Input(joint);
            all.push(Correction::Reverse(vec![input]));
            let units = other_units(model, motions, input).into_iter();
            all.extend(units.map(|unit| Correction::Unit(vec![(input, unit)])));
        }
    }
    all
}

/// Whether a joint's servo regulates an angle that the log has beside its goal: a calibration of
/// the servo is in both.
pub(super) fn is_regulated(model: &Model, joint: usize) -> bool {
    let columns = [LogColumn::Position(joint), LogColumn::Input(joint)];
    matches!(model.joints[joint].drive, Drive::Position { .. })
        && columns.iter().all(|column| column.column(model).is_some())
}

/// The other units of the column's dimension: the one that its name says where it says one, counts
/// only where every number written is whole, for no encoder gives others.
pub(super) fn other_units(model: &Model, motions: &[Motion], quantity: LogColumn) -> Vec<Unit> {
    let Some(column) = quantity.column(model) else {
        return Vec::new();
    };
    let dimension = column.unit.dimension;
    let mut units: Vec<Unit> = dimension.plain_units().collect();
    if dimension == Dimension::Angle && are_counts(model, motions, quantity) {
        let ticks = TICKS_PER_TURN.into_iter();
        units.extend(ticks.filter_map(|ticks| Unit::named("ticks", Some(ticks))));
    }
    units.retain(|unit| (unit.si / column.unit.si - 1.0).abs() > 0.01);
    if let Some(named) = named_unit(column) {
        units.retain(|unit| unit.name == named);
    }
    units
}

/// The unit that a column's name says, where it measures what the column is declared as.
pub(super) fn named_unit(column: &Column) -> Option<&'static str> {
    let (name, ticks) = name_guess(&column.name).unit?;
    let unit = Unit::named(name, ticks.or(Some(1.0)))?;
    (unit.dimension == column.unit.dimension).then_some(name)
}

/// Numbers written within this of a whole one are whole.
const WHOLE: f64 = 1e-6;

/// Whether every number written for a quantity is whole, as encoders count; of several servos a
/// mean is read, which may lie between.
fn are_counts(model: &Model, motions: &[Motion], quantity: LogColumn) -> bool {
    let columns = quantity.columns(model);
    let LogColumn::Position(joint) = quantity else {
        return false;
    };
    let servos = columns.len() as f64;
    let Some(mean) = model.log.joints[joint].position.as_ref() else {
        return false;
    };
    let angles = motions
        .iter()
        .flat_map(|motion| &motion.position_rad[joint]);
    let mut counts = angles
        .filter(|angle| angle.is_finite())
        .map(|angle| servos * written(*angle, mean));
    counts.all(|count| (count - count.round()).abs() <= WHOLE * count.abs().max(1.0))
}

/// The other units of time in which the samples would lie between 0.5 ms and 0.5 s apart, where
/// they do not as declared.
pub(super) fn time_units(model: &Model, spacing_s: f64) -> Vec<Correction> {
    let plausible = 0.5e-3..0.5;
    if plausible.contains(&spacing_s) {
        return Vec::new();
    }
    let declared = model.log.time.unit;
    // Samples so far apart are doubted whatever the column is called. Stamps are text, which no
    // unit of numbers reads, and the other way round.
    let is_text = |unit: &Unit| unit.name == "iso8601";
    if is_text(&declared) {
        return Vec::new();
    }
    Dimension::Time
        .plain_units()
        .filter(|unit| unit.name != declared.name && !is_text(unit))
        .filter(|unit| plausible.contains(&(spacing_s / declared.si * unit.si)))
        .map(|unit| Correction::Unit(vec![(LogColumn::Time, unit)]))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use handstand_model::fixture::{columns, model, position_drive};

    fn proposed(declared: &str, spacing_s: f64) -> Vec<&'static str> {
        let mut model = model(position_drive(), columns());
        model.log.time.unit = Unit::named(declared, None).unwrap();
        let units = time_units(&model, spacing_s).into_iter();
        let units = units.filter_map(|correction| match correction {
            Correction::Unit(columns) => Some(columns[0].1.name),
            _ => None,
        });
        units.collect()
    }

    #[test]
    fn numbers_are_not_read_as_time_stamps_nor_stamps_as_numbers() {
        for (declared, spacing_s) in [("ms", 1e-5), ("us", 1e-8), ("ns", 1e-11)] {
            assert_eq!(proposed(declared, spacing_s), ["s"], "{declared}");
        }
        assert_eq!(proposed("iso8601", 10.0), [""; 0]);
    }
}
