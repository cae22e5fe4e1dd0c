//! A law on an estimated state: a Kalman filter that starts from nothing, and what its owner knows
//! of the drives.
//!
//! The filter's gains are computed beforehand, sample by sample from the first reading on, until
//! they stand still; the start counts as no less certain than three deviations of the settled
//! filter. Rounding to a step counts as noise of step / sqrt(12) (Widrow, Kollar,
//! Quantization Noise (2008)).

use super::dead_zone::AssumedDrive;
use super::plant::{continuous, plant};
use super::sliding::Surface;
use super::{ControllerDesign, ControllerInfo, DesignModel, Speeds};
use crate::error::{Error, Result};
use crate::sim::closed_loop::state_feedback::dot;
use crate::sim::closed_loop::{Controller, Measurement};
use crate::synth::{Discrete, Gains, dlqr, rounding_variance, zoh};
use nalgebra::{DMatrix, DVector};

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

/// A controller with a Kalman filter. It reads all speeds if its speeds are the true ones, else the
/// gyro's only.
#[derive(Debug)]
pub struct ObservedDesign {
    pub(super) info: ControllerInfo,
    pub(super) options: Options,
}

/// How the estimate is made and used.
#[derive(Debug, Clone, Copy)]
pub(super) struct Options {
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
    /// Largest deviation that is assumed of the start, in those of the settled filter. Gains for
    /// more take the first readings, exact ones above all, for proof of speeds and offsets: the
    /// loop of such gains is unstable under a delay that it does not know, and asks for hundreds of
    /// N m. Of less, the angles of balance are found too late for starts far out. Of 60 robots with
    /// exact sensors and 1 to 9 ms of unknown delay all stand with 1 to 3, at 5 ms two fifths with
    /// 5 and none with 8; under everything at once, 300 robots, 92 % with 1, 97 % with 1.5, 99 %
    /// with 2, 3 and 5.
    pub largest_start: f64,
    /// Whether the law is sliding mode with a boundary layer; else it is u = -K z.
    pub sliding: bool,
}

impl Options {
    /// A filter and the paper's weights; of the robot's non-idealities only resolution is in it.
    pub const PAPER: Options = Options {
        offsets: false,
        delay: false,
        servo: false,
        inverse: false,
        weights: [&[100.0], &[100.0]],
        torque_noise_nm: 0.1,
        speed_noise_rad_s: 1e-3,
        offset_walk_rad: 2e-4,
        largest_start: 3.0,
        sliding: false,
    };
}

/// The filter, the law on it, and the drives behind.
#[derive(Debug)]
struct Observed {
    /// z(k+1) = A z + B u, by rows.
    a: Vec<f64>,
    b: Vec<f64>,
    /// How many numbers of z are read, its first: the angles, then speeds.
    readings: usize,
    /// Filter gains of sample 0, 1, ..; the last one stays. States x readings, by rows.
    filter: Vec<Vec<f64>>,
    law: Surface,
    drive: AssumedDrive,
    states: usize,
    drives: usize,
}

impl ControllerDesign for ObservedDesign {
    fn info(&self) -> &ControllerInfo {
        &self.info
    }

    fn build(&self, known: &DesignModel) -> Result<Box<dyn Controller>> {
        let options = &self.options;
        let known = &DesignModel {
            delay_s: if options.delay { known.delay_s } else { 0.0 },
            servo: known.servo.filter(|_| options.servo),
            ..known.clone()
        };
        let believed = plant(known, options.offsets)?;
        let joints = known.joints();
        let readings = match self.info.speeds {
            Speeds::True => 2 * joints,
            _ => joints + 1,
        };
        let mut drive = AssumedDrive::of(known);
        if !options.inverse {
            drive.least_nm = 0.0;
        }
        Ok(Box::new(Observed {
            a: by_rows(&believed.a),
            b: by_rows(&believed.b),
            filter: filter(known, options, &believed, readings)?,
            law: law(known, options)?,
            drive,
            states: believed.a.nrows(),
            drives: known.drives(),
            readings,
        }))
    }
}

/// The law on the state without offsets, spread over the whole state: the offsets act as the
/// angles' negatives.
fn law(known: &DesignModel, options: &Options) -> Result<Surface> {
    let without = plant(known, false)?;
    let gains = regulator(known, options, &without)?;
    let surface = if options.sliding {
        Surface::sliding(&without, &gains.riccati)?
    } else {
        Surface::regulator(gains.k)
    };
    Ok(if options.offsets {
        surface.with_offsets(known.joints())
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

/// Covariance of what is not known of the `size` states, per sample; what comes behind angles,
/// speeds and offsets is known.
pub(super) fn process_noise(
    known: &DesignModel,
    options: &Options,
    size: usize,
) -> Result<DMatrix<f64>> {
    let held = zoh(&continuous(known, options.offsets), known.period_s, 0.0)?;
    let torque = &held.b * held.b.transpose() * options.torque_noise_nm.powi(2);
    let mut process = torque.resize(size, size, 0.0);
    let joints = known.joints();
    for i in 0..joints {
        // A whiff on each angle and speed keeps the filter from believing its model blindly.
        process[(i, i)] += 1e-10;
        process[(joints + i, joints + i)] += options.speed_noise_rad_s.powi(2);
        if options.offsets {
            process[(2 * joints + i, 2 * joints + i)] += options.offset_walk_rad.powi(2);
        }
    }
    Ok(process)
}

/// The Kalman filter's gains from the first sample on.
fn filter(
    known: &DesignModel,
    options: &Options,
    believed: &Discrete,
    readings: usize,
) -> Result<Vec<Vec<f64>>> {
    let (size, joints) = (believed.a.nrows(), known.joints());
    let process = process_noise(known, options, size)?;
    let mut p = DMatrix::zeros(size, size);
    for i in 0..joints {
        p[(i, i)] = START_RAD.powi(2);
        p[(joints + i, joints + i)] = START_RAD_S.powi(2);
        if options.offsets {
            p[(2 * joints + i, 2 * joints + i)] = START_OFFSET_RAD.powi(2);
        }
    }
    let rounding = |step: f64, exact: f64| rounding_variance(step).max(exact * exact);
    let noise = DVector::from_fn(readings, |place, _| match place {
        angle if angle < joints => rounding(known.position_step_rad, EXACT_RAD),
        gyro if gyro == joints => rounding(known.gyro_step_rad_s, EXACT_RAD_S),
        _ => EXACT_RAD_S.powi(2),
    });
    let noise = DMatrix::from_diagonal(&noise);
    let (_, stationary) = run(p.clone(), believed, &process, &noise)?;
    for i in 0..size {
        p[(i, i)] = p[(i, i)].min(options.largest_start.powi(2) * stationary[(i, i)]);
    }
    let (gains, _) = run(p, believed, &process, &noise)?;
    Ok(gains)
}

/// The gains from the covariance `p` on, until they stand still, and the covariance there.
fn run(
    mut p: DMatrix<f64>,
    believed: &Discrete,
    process: &DMatrix<f64>,
    noise: &DMatrix<f64>,
) -> Result<(Vec<Vec<f64>>, DMatrix<f64>)> {
    let readings = noise.nrows();
    let mut gains: Vec<Vec<f64>> = Vec::new();
    for _ in 0..LONGEST_START {
        let crossed = p.columns(0, readings).into_owned();
        let measured = crossed.rows(0, readings) + noise;
        let inverse = measured.cholesky().ok_or_else(unobserved)?;
        let gain = inverse.solve(&crossed.transpose()).transpose();
        p -= &gain * crossed.transpose();
        p = &believed.a * &p * believed.a.transpose() + process;
        p = (&p + p.transpose()) / 2.0;
        let gain = by_rows(&gain);
        let near = |(old, new): (&f64, &f64)| (old - new).abs() <= 1e-7 * (1.0 + new.abs());
        let last = gains.last();
        let still = last.is_some_and(|last| last.iter().zip(&gain).all(near));
        gains.push(gain);
        if still {
            break;
        }
    }
    if gains.iter().flatten().any(|gain| !gain.is_finite()) {
        return Err(unobserved());
    }
    Ok((gains, p))
}

/// The filter's innovation has no positive definite covariance.
fn unobserved() -> Error {
    Error::design(
        "the readings do not tell the state",
        "read finer, or sample faster",
    )
}

/// A matrix row by row.
pub(super) fn by_rows(matrix: &DMatrix<f64>) -> Vec<f64> {
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
        room.copy_from_slice(state);
        let readings = measured.angle_rad.iter().chain(measured.speed_rad_s);
        for (reading, value) in readings.take(self.readings).enumerate() {
            let innovation = value - state[reading];
            for (estimate, gains) in room.iter_mut().zip(filter.chunks_exact(self.readings)) {
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
