//! A law on an estimated state: a Kalman filter that starts from nothing, and what its owner knows
//! of the drives.
//!
//! The filter's gains are computed beforehand, sample by sample from the first reading on, until
//! they stand still. Rounding to a step counts as noise of step / sqrt(12) (Widrow, Kollar,
//! Quantization Noise (2008)).

use super::DesignModel;
use super::dead_zone::Drive;
use super::plant::{Parts, plant};
use super::sliding::Surface;
use crate::error::{Error, Result};
use crate::sim::closed_loop::{Controller, Measurement};
use crate::synth::{Discrete, Gains, dlqr};
use nalgebra::DMatrix;

/// Samples after which the filter's gains stand still at the latest.
const LONGEST_START: usize = 1000;

/// Noise that is assumed of an exact angle, rad, and of an exact speed, rad/s: the model isn't
/// exact.
const EXACT_RAD: f64 = 3e-4;
const EXACT_RAD_S: f64 = 3e-3;

/// What is assumed of the start: spread of angles, rad, of speeds, rad/s, and of the angles of
/// balance, rad.
const START_RAD: f64 = 0.05;
const START_RAD_S: f64 = 0.05;
const START_OFFSET_RAD: f64 = 0.03;

/// How the estimate is made and used.
#[derive(Debug, Clone)]
pub(super) struct Options {
    /// Whether all true speeds are read; else the gyro's only.
    pub true_speeds: bool,
    /// Whether the angles of balance are estimated.
    pub offsets: bool,
    /// Whether the delay is in the model.
    pub delay: bool,
    /// Whether the servos are.
    pub servo: bool,
    /// Whether commands pass the dead zone's inverse.
    pub inverse: bool,
    /// Weights of the angles and of the speeds from the first joint on; joints beyond have the last
    /// one's. Torques weigh 1.
    pub weights: [&'static [f64]; 2],
    /// Standard deviation of unknown torques, N m, from sample to sample.
    pub torque_noise_nm: f64,
    /// Standard deviation of unknown changes of every speed, rad/s, from sample to sample: the
    /// model is not exact.
    pub speed_noise_rad_s: f64,
    /// Wander of the angles of balance in a sample, rad.
    pub offset_walk_rad: f64,
    /// The law.
    pub law: Law,
}

/// What becomes of the estimate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Law {
    /// u = -K z.
    Regulator,
    /// Sliding mode with a boundary layer.
    Sliding,
}

impl Options {
    /// A filter and the paper's weights; of the robot's troubles only resolution is thought of.
    pub fn paper() -> Self {
        Options {
            true_speeds: false,
            offsets: false,
            delay: false,
            servo: false,
            inverse: false,
            weights: [&[100.0], &[100.0]],
            torque_noise_nm: 0.1,
            speed_noise_rad_s: 1e-3,
            offset_walk_rad: 2e-4,
            law: Law::Regulator,
        }
    }
}

/// The filter, the law on it, and the drives behind.
#[derive(Debug)]
pub(super) struct Observed {
    /// z(k+1) = A z + B u, by rows.
    a: Vec<f64>,
    b: Vec<f64>,
    /// Place in z of each reading.
    reads: Vec<usize>,
    /// Filter gains of sample 0, 1, ..; the last one stays. States x readings, by rows.
    filter: Vec<Vec<f64>>,
    law: Surface,
    drive: Drive,
    joints: usize,
    states: usize,
    drives: usize,
}

impl Observed {
    /// Designs filter and law.
    ///
    /// # Errors
    /// Plants that cannot be held, or not be observed.
    pub fn new(known: &DesignModel, options: &Options) -> Result<Self> {
        let parts = Parts {
            offsets: options.offsets,
            delay: options.delay,
            servo: options.servo,
        };
        let believed = plant(known, parts)?;
        let joints = known.joints();
        let readings = if options.true_speeds {
            2 * joints
        } else {
            joints + 1
        };
        let reads: Vec<usize> = (0..readings).collect();
        let mut drive = Drive::of(known);
        if !options.inverse {
            drive.least_nm = 0.0;
        }
        Ok(Observed {
            a: rows(&believed.a),
            b: rows(&believed.b),
            filter: filter(known, options, &believed, &reads)?,
            law: law(known, options, parts)?,
            drive,
            joints,
            states: believed.a.nrows(),
            drives: known.drives(),
            reads,
        })
    }
}

/// The law on the state without offsets, spread over the whole state: the offsets act as the
/// angles' negatives.
fn law(known: &DesignModel, options: &Options, parts: Parts) -> Result<Surface> {
    let without = plant(
        known,
        Parts {
            offsets: false,
            ..parts
        },
    )?;
    let gains = regulator(known, options, &without)?;
    let joints = known.joints();
    let surface = match options.law {
        Law::Regulator => Surface::regulator(gains.k),
        Law::Sliding => Surface::sliding(&without, &gains.riccati)?,
    };
    Ok(if parts.offsets {
        surface.with_offsets(joints)
    } else {
        surface
    })
}

/// The regulator on the state without offsets, with these weights.
pub(super) fn regulator(
    known: &DesignModel,
    options: &Options,
    without: &Discrete,
) -> Result<Gains> {
    let (size, m, joints) = (without.a.nrows(), known.drives(), known.joints());
    let mut q = DMatrix::zeros(size, size);
    for i in 0..joints {
        for (part, weights) in options.weights.iter().enumerate() {
            let weight = weights.get(i).or(weights.last());
            q[(part * joints + i, part * joints + i)] = weight.copied().unwrap_or(0.0);
        }
    }
    Ok(dlqr(without, &q, &DMatrix::identity(m, m))?)
}

/// The Kalman filter's gains from the first sample on.
fn filter(
    known: &DesignModel,
    options: &Options,
    believed: &Discrete,
    reads: &[usize],
) -> Result<Vec<Vec<f64>>> {
    let (size, joints) = (believed.a.nrows(), known.joints());
    let held = plant(
        known,
        Parts {
            offsets: options.offsets,
            delay: false,
            servo: false,
        },
    )?;
    let inner = held.a.nrows();
    let mut process = DMatrix::zeros(size, size);
    let torque = &held.b * held.b.transpose() * options.torque_noise_nm.powi(2);
    process.view_mut((0, 0), (inner, inner)).copy_from(&torque);
    let mut p = DMatrix::zeros(size, size);
    for i in 0..joints {
        p[(i, i)] = START_RAD.powi(2);
        p[(joints + i, joints + i)] = START_RAD_S.powi(2);
        // A whiff on each angle and speed keeps the filter from believing its model blindly.
        process[(i, i)] += 1e-10;
        process[(joints + i, joints + i)] += options.speed_noise_rad_s.powi(2);
        if options.offsets {
            p[(2 * joints + i, 2 * joints + i)] = START_OFFSET_RAD.powi(2);
            process[(2 * joints + i, 2 * joints + i)] = options.offset_walk_rad.powi(2);
        }
    }
    let rounding = |step: f64, exact: f64| (step * step / 12.0).max(exact * exact);
    let noise = reads.iter().map(|&place| match place {
        angle if angle < joints => rounding(known.position_step_rad, EXACT_RAD),
        gyro if gyro == joints => rounding(known.gyro_step_rad_s, EXACT_RAD_S),
        _ => EXACT_RAD_S.powi(2),
    });
    let noise = DMatrix::from_diagonal(&nalgebra::DVector::from_iterator(reads.len(), noise));
    let mut gains: Vec<Vec<f64>> = Vec::new();
    for _ in 0..LONGEST_START {
        let crossed = p.select_columns(reads);
        let measured = crossed.select_rows(reads) + &noise;
        let inverse = measured.cholesky().ok_or_else(unobserved)?;
        let gain = inverse.solve(&crossed.transpose()).transpose();
        p -= &gain * crossed.transpose();
        p = &believed.a * &p * believed.a.transpose() + &process;
        p = (&p + p.transpose()) / 2.0;
        let gain = rows(&gain);
        let still = gains.last().is_some_and(|last| {
            last.iter()
                .zip(&gain)
                .all(|(old, new)| (old - new).abs() <= 1e-7 * (1.0 + new.abs()))
        });
        gains.push(gain);
        if still {
            break;
        }
    }
    if gains.iter().flatten().any(|gain| !gain.is_finite()) {
        return Err(unobserved());
    }
    Ok(gains)
}

fn unobserved() -> Error {
    Error::design(
        "the readings do not tell the state",
        "read finer, or sample faster",
    )
}

/// A matrix row by row.
pub(super) fn rows(matrix: &DMatrix<f64>) -> Vec<f64> {
    matrix.transpose().as_slice().to_vec()
}

impl Controller for Observed {
    /// The state, what the inverse owes, how many samples were measured, and room to compute in.
    fn memory_len(&self) -> usize {
        2 * self.states + self.drives + 1
    }

    fn control(&self, memory: &mut [f64], measured: Measurement<'_>, command_nm: &mut [f64]) {
        let (state, rest) = memory.split_at_mut(self.states);
        let (room, rest) = rest.split_at_mut(self.states);
        let (carry, count) = rest.split_at_mut(self.drives);
        let sample = (count[0] as usize).min(self.filter.len() - 1);
        count[0] = (sample + 1) as f64;
        let filter = &self.filter[sample];
        let readings = self.reads.len();
        room.copy_from_slice(state);
        for (reading, &place) in self.reads.iter().enumerate() {
            let value = match place.checked_sub(self.joints) {
                None => measured.angle_rad[place],
                Some(joint) => measured.speed_rad_s[joint],
            };
            let innovation = value - state[place];
            for (estimate, gains) in room.iter_mut().zip(filter.chunks_exact(readings)) {
                *estimate += gains[reading] * innovation;
            }
        }
        self.law.torque(room, command_nm);
        for (torque, carry) in command_nm.iter_mut().zip(carry) {
            *torque = self.drive.command(*torque, carry);
        }
        let models = self
            .a
            .chunks_exact(self.states)
            .zip(self.b.chunks_exact(self.drives));
        for (next, (a, b)) in state.iter_mut().zip(models) {
            *next = dot(a, room) + dot(b, command_nm);
        }
    }
}

#[inline]
pub(super) fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
