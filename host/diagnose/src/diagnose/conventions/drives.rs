//! Other kinds of drive that the input column may belong to.

use super::correction::{Correction, LogColumn, named_unit};
use super::reread::written;
use super::trial::{CorrectionTrial, Effort, Trial};
use crate::model::{Dimension, Drive, Model, Motor, Unit};
use rayon::prelude::*;

/// Correlation of input and motion from which the input may be a goal that the joint follows, and
/// the slopes that a goal has.
const FOLLOWS: f64 = 0.8;
const SLOPES: std::ops::Range<f64> = 0.5..2.0;
/// Stall torques tried where none is known, in torques that hold the chain level.
const STALL: [f64; 3] = [1.5, 4.0, 12.0];
/// Gains tried where none is known: duty per rad, duty per rad/s.
const GAINS_PER_RAD: [f64; 4] = [1.5, 5.0, 15.0, 50.0];
const GAINS_S_PER_RAD: [f64; 3] = [0.2, 1.0, 5.0];

/// For each driven joint, the best drive of each other kind that the input may be meant for.
pub(super) fn drives(bench: &CorrectionTrial) -> Vec<Correction> {
    let joints = bench.model.driven_joints().into_iter();
    // Of a slide, torques that hold the chain level say nothing.
    let joints = joints.filter(|joint| bench.model.joints[*joint].slide.is_none());
    let joints = joints.filter(|joint| bench.varies(LogColumn::Input(*joint)));
    let joints = joints.filter(|joint| !names_its_unit(&bench.model, *joint));
    joints.flat_map(|joint| of_joint(bench, joint)).collect()
}

/// Whether the name of a joint's input says the unit that the file declares.
fn names_its_unit(model: &Model, joint: usize) -> bool {
    let column = LogColumn::Input(joint).column(model);
    column.is_some_and(|column| named_unit(column) == Some(column.unit.name))
}

fn of_joint(bench: &CorrectionTrial, joint: usize) -> Vec<Correction> {
    let model = &bench.model;
    let given = &model.joints[joint].drive;
    let motors = match given.motor() {
        Some(motor) => vec![motor.clone()],
        None => {
            let level_nm = level_torque_nm(model, joint);
            let motor = |share: f64| Motor {
                stall_torque_nm: share * level_nm,
                no_load_speed_rad_s: f64::INFINITY,
                nominal_supply_v: None,
            };
            STALL.map(motor).to_vec()
        }
    };
    let with_gains = |gains: &[f64], drive: &dyn Fn(f64, Motor) -> Drive| -> Vec<Drive> {
        let pairs = gains
            .iter()
            .flat_map(|gain| motors.iter().map(move |m| (*gain, m.clone())));
        pairs.map(|(gain, motor)| drive(gain, motor)).collect()
    };
    let mut kinds: Vec<Vec<(Drive, Unit)>> = Vec::new();
    let mut offer = |drives: Vec<Drive>, dimension: Dimension, fits: &dyn Fn(Unit) -> bool| {
        if drives
            .first()
            .is_some_and(|drive| drive.name() != given.name())
        {
            let units: Vec<Unit> = dimension.plain_units().filter(|unit| fits(*unit)).collect();
            let pairs = units
                .iter()
                .flat_map(|unit| drives.iter().map(|d| (d.clone(), *unit)));
            kinds.push(pairs.collect());
        }
    };
    let written = Written::of(bench, joint);
    offer(vec![Drive::Torque], Dimension::Torque, &|_| true);
    let duties = motors.iter().cloned().map(Drive::Duty).collect();
    offer(duties, Dimension::Ratio, &|unit| {
        written.most * unit.si <= 1.001
    });
    let position = |gain_per_rad, motor| Drive::Position {
        gain_per_rad,
        motor,
    };
    let goals = with_gains(&GAINS_PER_RAD, &position);
    offer(goals, Dimension::Angle, &|unit| written.follows_angle(unit));
    let speed = |gain_s_per_rad, motor| Drive::Speed {
        gain_s_per_rad,
        motor,
    };
    let goals = with_gains(&GAINS_S_PER_RAD, &speed);
    offer(goals, Dimension::Speed, &|unit| written.follows_speed(unit));
    let tried = |(drive, unit)| bench.tried(Correction::Drive(joint, drive, unit), Effort::Guess);
    let best = |kind: Vec<(Drive, Unit)>| {
        let trials = kind.into_par_iter().filter_map(tried);
        trials.min_by(|a: &Trial, b: &Trial| a.ratio().total_cmp(&b.ratio()))
    };
    let best = kinds.into_iter().filter_map(best);
    best.map(|trial| trial.correction).collect()
}

/// Torque that holds the chain from this joint on out level, or moves it by some rad/s^2 where
/// gravity does not pull, N m.
fn level_torque_nm(model: &Model, joint: usize) -> f64 {
    let (mut reach_m, mut torque_nm) = (0.0, 0.0);
    for link in &model.links[joint..] {
        let arm_m = reach_m + link.com_m.abs();
        let inertia = link.inertia_kg_m2 + link.mass_kg * arm_m * arm_m;
        torque_nm += model.gravity_m_s2 * link.mass_kg * arm_m + 10.0 * inertia;
        reach_m += link.length_m;
    }
    torque_nm
}

/// The input as written, against the motion.
struct Written {
    /// Largest magnitude.
    most: f64,
    angle: Line,
    speed: Line,
}

/// Correlation, and change of the motion per change of the input.
struct Line {
    correlation: f64,
    slope: f64,
}

impl Line {
    fn of(pairs: &[(f64, f64)]) -> Line {
        let count = pairs.len().max(1) as f64;
        let mean = |value: fn(&(f64, f64)) -> f64| pairs.iter().map(value).sum::<f64>() / count;
        let (x, y) = (mean(|p| p.0), mean(|p| p.1));
        let sum = |value: &dyn Fn(f64, f64) -> f64| {
            pairs.iter().map(|p| value(p.0 - x, p.1 - y)).sum::<f64>()
        };
        let (xx, xy, yy) = (sum(&|x, _| x * x), sum(&|x, y| x * y), sum(&|_, y| y * y));
        Line {
            correlation: xy / (xx * yy).sqrt().max(1e-300),
            slope: xy / xx.max(1e-300),
        }
    }

    fn follows(&self, unit: Unit) -> bool {
        self.correlation > FOLLOWS && SLOPES.contains(&(self.slope / unit.si))
    }
}

impl Written {
    fn of(bench: &CorrectionTrial, joint: usize) -> Written {
        let (mut angles, mut speeds, mut most) = (Vec::new(), Vec::new(), 0.0_f64);
        let column = bench.model.log.joints[joint].input.as_ref();
        for motion in &bench.motions {
            let (Some(input), Some(column)) = (&motion.input[joint], column) else {
                continue;
            };
            let (angle, time_s) = (&motion.position_rad[joint], &motion.time_s);
            for k in 1..motion.len() {
                // A drive that is off follows nothing.
                if motion.torque_on.as_ref().is_some_and(|on| !on[k]) {
                    continue;
                }
                let written = written(input[k - 1], column);
                if !angle[k].is_finite() || !angle[k - 1].is_finite() {
                    continue;
                }
                most = most.max(written.abs());
                angles.push((written, angle[k]));
                speeds.push((
                    written,
                    (angle[k] - angle[k - 1]) / (time_s[k] - time_s[k - 1]),
                ));
            }
        }
        Written {
            most,
            angle: Line::of(&angles),
            speed: Line::of(&speeds),
        }
    }

    fn follows_angle(&self, unit: Unit) -> bool {
        self.angle.follows(unit)
    }

    fn follows_speed(&self, unit: Unit) -> bool {
        self.speed.follows(unit)
    }
}
