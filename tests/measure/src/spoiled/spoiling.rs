//! Ways to spoil a log, or the model file's account of it, and what mends each.

use super::edits::{
    anonymise, another_drive, clip, count_whole, declare, input_factor, scale_input,
    scale_position, stall,
};
use super::rig::Rig;
use handstand::Model;
use handstand::diagnose::conventions::{Correction, LogColumn, scales_torque_by};
use handstand::model::{AngleZero, Angles, Unit};
use handstand::motion::Motion;
use std::f64::consts::{PI, TAU};

/// A way to spoil a log; joints count from 0.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Spoiling {
    /// The joint's angle and speed count the other way round.
    PositionSign(usize),
    /// The joint's input counts the other way round.
    InputSign(usize),
    /// The joint's angle is 0.5 rad off.
    Zero(usize),
    /// The angles are said to be zero where they are not: hanging, upright.
    AngleZero,
    /// Degrees are declared as radians.
    Degrees(usize),
    /// Radians are declared as degrees.
    Radians(usize),
    /// Counts of 4096 per turn are declared as radians.
    Counts(usize),
    /// Counts of 4096 per turn are declared as of 1024.
    CountsPerTurn(usize),
    /// The input is in another unit than declared.
    InputUnit(usize),
    /// Relative angles are declared as absolute, or the other way round.
    Angles,
    /// The model names another kind of drive.
    Drive(usize, &'static str),
    /// Milliseconds are declared as seconds.
    Milliseconds,
    /// A column was taken so much later than the others, s.
    Shift(LogColumn, f64),
    /// All joints stand still for the last 25 s.
    Stalled,
    /// The input is cut off at half its most.
    Clipped(usize),
}

/// A rig with a spoiled log.
#[derive(Debug, Clone)]
pub struct Spoiled {
    /// The model, whose file may be what is wrong.
    pub model: Model,
    /// The motions as that model reads them.
    pub motions: Vec<Motion>,
}

/// Offset of a wrong zero, rad.
const OFFSET_RAD: f64 = 0.5;
/// Shift of a column, s, or this many samples where they are rare.
const SHIFT_S: f64 = 0.1;
const SHIFT_SAMPLES: f64 = 3.0;

/// Every way to spoil this rig's log.
pub fn spoilings(rig: &Rig) -> Vec<Spoiling> {
    use Spoiling as S;
    let joints = rig.model.link_count();
    let samples: usize = rig.motions.iter().map(Motion::len).sum();
    let seconds: f64 = rig.motions.iter().map(Motion::duration_s).sum();
    let shift_s = SHIFT_S.max(SHIFT_SAMPLES * seconds / samples.max(1) as f64);
    let mut all = vec![S::AngleZero, S::Milliseconds, S::Stalled];
    for joint in 0..joints {
        all.extend([S::PositionSign, S::Zero, S::Degrees, S::Radians, S::Counts].map(|s| s(joint)));
        all.push(S::CountsPerTurn(joint));
        let drive = &rig.model.joints[joint].drive;
        if drive.is_driven() {
            all.extend([S::InputSign, S::InputUnit, S::Clipped].map(|s| s(joint)));
            let others = ["torque", "duty", "position", "speed"].into_iter();
            let others = others.filter(|name| *name != drive.name());
            let others = others.map(|name| S::Drive(joint, name));
            all.extend(others.filter(|other| !other.only_scales(rig)));
            // Later instead of earlier is what a delay of the drive does: no fault of the log.
            all.push(S::Shift(LogColumn::Input(joint), -shift_s));
        }
        if joint > 0 {
            all.push(S::Shift(LogColumn::Position(joint), shift_s));
        }
    }
    if joints > 1 {
        all.push(S::Angles);
    }
    all
}

impl Spoiling {
    /// Whether it is no fault of the log but a stall torque that may be wrong: a duty declared as a
    /// torque, or the other way round.
    fn only_scales(&self, rig: &Rig) -> bool {
        let Spoiling::Drive(joint, _) = *self else {
            return false;
        };
        let Some(column) = LogColumn::Input(joint).column(&rig.model) else {
            return false;
        };
        let mended = Correction::Drive(joint, rig.model.joints[joint].drive.clone(), column.unit);
        scales_torque_by(&mended, &self.applied(rig).model).is_some()
    }

    /// Its kind, as the rows of the table name it.
    pub fn kind(&self) -> &'static str {
        match self {
            Spoiling::PositionSign(_) => "position reversed",
            Spoiling::InputSign(_) => "input reversed",
            Spoiling::Zero(_) => "zero 0.5 rad off",
            Spoiling::AngleZero => "hanging and upright confused",
            Spoiling::Degrees(_) => "degrees declared as rad",
            Spoiling::Radians(_) => "rad declared as degrees",
            Spoiling::Counts(_) => "counts declared as rad",
            Spoiling::CountsPerTurn(_) => "wrong counts per turn",
            Spoiling::InputUnit(_) => "input in another unit",
            Spoiling::Angles => "relative and absolute angles confused",
            Spoiling::Drive(..) => "another kind of drive",
            Spoiling::Milliseconds => "milliseconds declared as s",
            Spoiling::Shift(..) => "column shifted in time",
            Spoiling::Stalled => "stalled run",
            Spoiling::Clipped(_) => "clipped input",
        }
    }

    /// The rig with its log spoiled.
    pub fn applied(&self, rig: &Rig) -> Spoiled {
        let mut spoiled = Spoiled {
            model: rig.model.clone(),
            motions: rig.motions.clone(),
        };
        let (model, motions) = (&mut spoiled.model, &mut spoiled.motions);
        // A unit that a column's name says is not doubted.
        anonymise(model);
        match *self {
            Spoiling::PositionSign(joint) => scale_position(motions, joint, -1.0),
            Spoiling::InputSign(joint) => scale_input(motions, joint, -1.0),
            Spoiling::Zero(joint) => {
                for motion in motions {
                    motion.position_rad[joint]
                        .iter_mut()
                        .for_each(|q| *q += OFFSET_RAD);
                }
            }
            Spoiling::AngleZero => model.angle_zero = other_zero(model.angle_zero),
            Spoiling::Degrees(joint) => scale_position(motions, joint, 180.0 / PI),
            Spoiling::Radians(joint) => {
                declare(model, joint, "deg", None);
                scale_position(motions, joint, PI / 180.0);
            }
            Spoiling::Counts(joint) => {
                // Whatever the file declared, counts are what the log now holds.
                scale_position(motions, joint, 4096.0 / TAU);
                declare(model, joint, "rad", None);
                count_whole(model, motions, joint);
            }
            Spoiling::CountsPerTurn(joint) => {
                declare(model, joint, "ticks", Some(1024.0));
                scale_position(motions, joint, 4.0);
                count_whole(model, motions, joint);
            }
            Spoiling::InputUnit(joint) => scale_input(motions, joint, input_factor(model, joint)),
            Spoiling::Angles => {
                model.angles = match model.angles {
                    Angles::Relative => Angles::Absolute,
                    Angles::Absolute => Angles::Relative,
                }
            }
            Spoiling::Drive(joint, name) => another_drive(model, motions, joint, name),
            Spoiling::Milliseconds => {
                for motion in motions {
                    motion.time_s.iter_mut().for_each(|t| *t *= 1e3);
                }
            }
            Spoiling::Shift(column, shift_s) => {
                // What was taken later is written too early: the remedy moves it back.
                let moved = Correction::Shift(column, -shift_s);
                *motions = moved.reread(model, motions);
            }
            Spoiling::Stalled => motions.iter_mut().take(1).for_each(stall),
            Spoiling::Clipped(joint) => clip(motions, joint),
        }
        spoiled
    }

    /// Whether this remedy mends it.
    pub fn mended_by(&self, correction: &Correction, rig: &Rig, spoiled: &Spoiled) -> bool {
        let near = |value: f64, wanted: f64, by: f64| (value - wanted).abs() <= by;
        let factor = |quantity: LogColumn, unit: &Unit| {
            quantity
                .column(&spoiled.model)
                .map_or(0.0, |column| unit.si / column.unit.si)
        };
        let scaled = |quantity: LogColumn, wanted: f64| match correction {
            Correction::Unit(columns) => {
                let mut columns = columns.iter();
                columns.any(|(q, unit)| {
                    *q == quantity && near(factor(quantity, unit) / wanted, 1.0, 0.03)
                })
            }
            _ => false,
        };
        let offset = |joint: usize| match correction {
            Correction::Offset(columns, added) => columns
                .contains(&LogColumn::Position(joint))
                .then_some(*added),
            _ => None,
        };
        match *self {
            Spoiling::PositionSign(joint) => reverses(correction, LogColumn::Position(joint)),
            Spoiling::InputSign(joint) => reverses(correction, LogColumn::Input(joint)),
            Spoiling::Zero(joint) => offset(joint).is_some_and(|o| near(o, -OFFSET_RAD, 0.15)),
            Spoiling::AngleZero => {
                let (is, was) = (spoiled.model.angle_zero, rig.model.angle_zero);
                let wanted = was.from_hanging_rad() - is.from_hanging_rad();
                let turned = |o: f64| near((o - wanted + PI).rem_euclid(TAU), PI, 0.15);
                *correction == Correction::AngleZero(was) || offset(0).is_some_and(turned)
            }
            Spoiling::Degrees(joint) => scaled(LogColumn::Position(joint), PI / 180.0),
            Spoiling::Radians(joint) => scaled(LogColumn::Position(joint), 180.0 / PI),
            Spoiling::Counts(joint) => scaled(LogColumn::Position(joint), TAU / 4096.0),
            Spoiling::CountsPerTurn(joint) => scaled(LogColumn::Position(joint), 0.25),
            Spoiling::InputUnit(joint) => scaled(
                LogColumn::Input(joint),
                1.0 / input_factor(&rig.model, joint),
            ),
            Spoiling::Angles => matches!(correction, Correction::Angles(_)),
            Spoiling::Drive(joint, _) => match correction {
                Correction::Drive(j, drive, _) => {
                    *j == joint && drive.name() == rig.model.joints[joint].drive.name()
                }
                _ => false,
            },
            Spoiling::Milliseconds => scaled(LogColumn::Time, 1e-3),
            Spoiling::Shift(column, shift_s) => match correction {
                Correction::Shift(c, s) => *c == column && near(*s / shift_s, 1.0, 0.5),
                _ => false,
            },
            Spoiling::Stalled | Spoiling::Clipped(_) => false,
        }
    }
}

fn reverses(correction: &Correction, quantity: LogColumn) -> bool {
    matches!(correction, Correction::Reverse(columns) if columns.contains(&quantity))
}

fn other_zero(zero: AngleZero) -> AngleZero {
    match zero {
        AngleZero::Hanging => AngleZero::Upright,
        AngleZero::Upright | AngleZero::Horizontal => AngleZero::Hanging,
    }
}
