//! Within which angles, speeds, torques and time an experiment must stay.

use super::clearance::Clearance;
use crate::error::{Error, Result};
use crate::model::{Drive, MeasuredSignal, Model};
use crate::motion::Motion;
use std::f64::consts::PI;

/// Samples over which a speed is taken from readings.
const SPEED_SAMPLES: usize = 4;
/// How far the others may push a joint that rests, rad: three degrees.
const PUSHED_RAD: f64 = 0.05;
/// How much faster than its goal a servo catches up with it.
const CATCHING_UP: f64 = 2.0;
/// Slowest and fastest sampling of an experiment, Hz.
const RATE_HZ: (f64, f64) = (10.0, 1000.0);

/// Limits of an experiment. What the rig does is predicted by every explanation that is left, and
/// none may leave them.
#[derive(Debug, Clone, PartialEq)]
pub struct ExperimentLimits {
    /// Per joint: lowest angle, rad in the log's convention.
    pub low_rad: Vec<f64>,
    /// Per joint: highest angle.
    pub high_rad: Vec<f64>,
    /// Per joint: fastest speed, rad/s.
    pub speed_rad_s: Vec<f64>,
    /// Largest torque of any drive, N m; none for what the motors have.
    pub torque_nm: Option<f64>,
    /// Longest duration, s.
    pub seconds: f64,
    /// Samples per second.
    pub hz: f64,
    /// How near a robot in space may come to itself and to what it stands on.
    pub clearance: Option<Clearance>,
}

impl ExperimentLimits {
    /// What the logs have already covered: their angles, their fastest speeds, their rate; motions
    /// of `seconds`.
    pub fn of_logs(model: &Model, motions: &[Motion], seconds: f64) -> ExperimentLimits {
        let joints = 0..model.link_count();
        let angles = |joint: usize| {
            let all = motions.iter().flat_map(move |m| &m.position_rad[joint]);
            all.copied().filter(|angle| angle.is_finite())
        };
        let low = |joint| angles(joint).reduce(f64::min).unwrap_or(-PI);
        let high = |joint| angles(joint).reduce(f64::max).unwrap_or(PI);
        let fastest = |joint: usize| {
            let speeds = motions.iter().map(|motion| fastest_rad_s(motion, joint));
            let most = speeds.fold(0.0, f64::max);
            if most > 0.0 { most } else { f64::INFINITY }
        };
        ExperimentLimits {
            low_rad: joints.clone().map(low).collect(),
            high_rad: joints.clone().map(high).collect(),
            speed_rad_s: joints.map(fastest).collect(),
            torque_nm: None,
            seconds,
            hz: rate_hz(motions),
            clearance: Clearance::of_logs(model, motions),
        }
    }

    /// What a model's file knows without a log: the end stops of a robot in space, for driven
    /// joints without any `reach_rad` to either side of 0 in the log's convention, nothing for
    /// others; and this speed, rad/s, up to what the motors have.
    pub fn of_model(
        model: &Model,
        (reach_rad, speed_rad_s): (f64, f64),
        hz: f64,
    ) -> ExperimentLimits {
        let stops = |side: fn((f64, f64)) -> f64| {
            let stops = (0..model.link_count()).map(|joint| model.range(joint).map_or(0.0, side));
            model.convention_rad(&stops.collect::<Vec<_>>())
        };
        let (lowest_rad, highest_rad) = (stops(|range| range.0), stops(|range| range.1));
        let ranges = model.joints.iter().enumerate().map(|(joint, own)| {
            if model.range(joint).is_some() {
                (lowest_rad[joint], highest_rad[joint])
            } else if own.drive.is_driven() {
                (-reach_rad, reach_rad)
            } else {
                (f64::NEG_INFINITY, f64::INFINITY)
            }
        });
        let (low_rad, high_rad) = ranges.unzip();
        let fastest = model.joints.iter().map(|joint| match joint.drive.motor() {
            _ if !joint.drive.is_driven() => f64::INFINITY,
            Some(motor) => speed_rad_s.min(motor.no_load_speed_rad_s),
            None => speed_rad_s,
        });
        ExperimentLimits {
            low_rad,
            high_rad,
            speed_rad_s: fastest.collect(),
            torque_nm: None,
            seconds: f64::INFINITY,
            hz,
            clearance: Clearance::of_logs(model, &[]),
        }
    }

    /// Whether there is something between them.
    ///
    /// # Errors
    /// Which limit leaves nothing.
    pub fn check(&self, model: &Model) -> Result<()> {
        let ranges = self.low_rad.iter().zip(&self.high_rad);
        for (joint, (low, high)) in (1..).zip(ranges) {
            // A joint of a robot in space may rest while the others move.
            let rests = model.is_in_space() && low == high;
            if !(rests || low < high) {
                return Err(Error::usage(
                    format!("angles {low:.3} to {high:.3} rad leave joint {joint} no motion"),
                    "give a lower and a higher angle by --angles LOW..HIGH",
                ));
            }
        }
        if self.moved(model).is_empty() {
            return Err(Error::usage(
                "every joint that is driven rests in the logs",
                "give a lower and a higher angle by --angles LOW..HIGH",
            ));
        }
        Ok(())
    }

    /// The same of joints that may catch up with goals as fast as these change: a servo lags behind
    /// its goal, and swings past it.
    pub(super) fn catching_up(&self, model: &Model) -> ExperimentLimits {
        let joints = self.speed_rad_s.iter().zip(&model.joints);
        let speeds = joints.map(|(speed_rad_s, joint)| match joint.drive {
            Drive::Position { .. } => CATCHING_UP * speed_rad_s,
            _ => *speed_rad_s,
        });
        ExperimentLimits {
            speed_rad_s: speeds.collect(),
            ..self.clone()
        }
    }

    /// The driven joints that may move, counted from 0.
    pub(super) fn moved(&self, model: &Model) -> Vec<usize> {
        let mut driven = model.driven_joints();
        driven.retain(|&joint| self.low_rad[joint] < self.high_rad[joint]);
        driven
    }

    /// Whether a predicted motion stays within them.
    pub fn keeps(&self, model: &Model, motion: &Motion) -> bool {
        self.broken_by(model, motion).is_none()
    }

    /// Which of them a predicted motion leaves, in words that read on from "the model".
    pub fn broken_by(&self, model: &Model, motion: &Motion) -> Option<String> {
        let of_joint = |joint: usize| {
            let name = model.joint_name(joint);
            let name = name.map_or_else(|| format!("joint {}", joint + 1), str::to_string);
            let most_nm = || most_torque_nm(model, motion, joint);
            let fastest_rad_s = fastest_rad_s(motion, joint);
            if !self.keeps_angles(motion, joint) {
                Some(format!("leaves the angles of {name}"))
            } else if fastest_rad_s > self.speed_rad_s[joint] {
                Some(format!(
                    "turns {name} at {fastest_rad_s:.2} rad/s, faster than {:.2}",
                    self.speed_rad_s[joint]
                ))
            } else if self.torque_nm.is_some_and(|most| most_nm() > most) {
                Some(format!(
                    "asks the drive of {name} for more torque than it may"
                ))
            } else {
                None
            }
        };
        let clearance = self.clearance.as_ref();
        let broken = clearance.and_then(|least| least.broken_by(model, motion));
        broken.or_else(|| (0..model.link_count()).find_map(of_joint))
    }

    fn keeps_angles(&self, motion: &Motion, joint: usize) -> bool {
        let (low, high) = (self.low_rad[joint], self.high_rad[joint]);
        let pushed = if low == high { PUSHED_RAD } else { 0.0 };
        let allowed = low - pushed..=high + pushed;
        let mut angles = motion.position_rad[joint].iter();
        angles.all(|angle| angle.is_nan() || allowed.contains(angle))
    }
}

/// Largest speed of a joint over a few samples, rad/s.
fn fastest_rad_s(motion: &Motion, joint: usize) -> f64 {
    if let Some(rate) = &motion.velocity_rad_s[joint]
        && motion.position_rad[joint]
            .iter()
            .all(|angle| angle.is_nan())
    {
        let rates = rate.iter().filter(|rate| rate.is_finite());
        return rates.fold(0.0, |most, rate| most.max(rate.abs()));
    }
    let (time, position) = (&motion.time_s, &motion.position_rad[joint]);
    let ends = (0..position.len().saturating_sub(SPEED_SAMPLES)).map(|k| {
        let end = k + SPEED_SAMPLES;
        ((position[end] - position[k]) / (time[end] - time[k])).abs()
    });
    ends.filter(|speed| speed.is_finite()).fold(0.0, f64::max)
}

/// Largest torque that a joint's drive is asked for, N m, before any effect.
fn most_torque_nm(model: &Model, motion: &Motion, joint: usize) -> f64 {
    let Some(input) = &motion.input[joint] else {
        return 0.0;
    };
    let position = &motion.position_rad[joint];
    let torque = |(k, &input): (usize, &f64)| {
        let on = motion.torque_on.as_ref().is_none_or(|on| on[k]);
        let duty = match &model.joints[joint].drive {
            _ if !on => 0.0,
            Drive::Passive => 0.0,
            Drive::Torque | Drive::Duty(_) => input,
            Drive::Position { gain_per_rad, .. } => {
                let error = input - position[k];
                // An angle that is not measured says nothing of the torque: the most there is.
                if error.is_nan() {
                    1.0
                } else {
                    (gain_per_rad * error).clamp(-1.0, 1.0)
                }
            }
            Drive::Speed { .. } => 1.0,
        };
        let full = model.joints[joint].drive.motor();
        full.map_or(1.0, |motor| motor.stall_torque_nm) * duty.abs()
    };
    input.iter().enumerate().map(torque).fold(0.0, f64::max)
}

/// Median rate of the samples, Hz.
fn rate_hz(motions: &[Motion]) -> f64 {
    let steps = motions.iter().flat_map(|motion| motion.time_s.windows(2));
    let mut steps: Vec<f64> = steps.map(|pair| pair[1] - pair[0]).collect();
    steps.sort_by(f64::total_cmp);
    let median = steps.get(steps.len() / 2).copied().unwrap_or(0.01);
    (1.0 / median).round().clamp(RATE_HZ.0, RATE_HZ.1)
}

/// What a log would hold of a joint.
pub(super) fn signal(model: &Model, joint: usize) -> MeasuredSignal {
    model.log.joints[joint].signal()
}
