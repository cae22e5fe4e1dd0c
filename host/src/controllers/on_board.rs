//! [`best`](super::best) as the CM-5 can run it: every reading with its own age, and one linear
//! machine that updates an estimate from readings and the inputs that really went out.
//!
//! The CM-5 reads one servo after the other and computes at the end, so a reading is older than the
//! moment of the law by what the others took. The filter is told: its output equation is that of
//! the state `age` ago, x(t - age), which the state and the inputs since determine exactly. With s
//! = [x, offsets, past inputs],
//!
//! ```text
//! innovation  = y - C s
//! raw command = -K (s + L innovation)
//! next        = A (s + L innovation) + B applied
//! ```

use super::observed::{Options, regulator};
use super::plant::{Parts, continuous, plant};
use super::{DesignModel, best};
use crate::error::{Error, Result};
use crate::sim::closed_loop::GYRO_STEP_RAD_S;
use crate::synth::{Discrete, kalman, zoh};
use handstand_shared::observer::{
    DELAYS, ESTIMATED, INPUTS, JOINTS, PAST, READINGS, SEEN, STATE, WIDTH,
};
use handstand_shared::raw::Position;
use nalgebra::DMatrix;

/// When things happen in a period, and how well the readings tell.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Timing {
    /// From the law's moment until its inputs act, s.
    pub effect_s: f64,
    /// Age of each reading at the law's moment, s: the angles, then the first link's rate.
    pub age_s: [f64; READINGS],
    /// Standard deviation of each reading, in SI; infinite for one that there is not.
    pub deviation: [f64; READINGS],
}

/// Deviation that stands for a reading that there is not, rad: without any, nothing would tell the
/// first link's angle from its angle of balance, of which only the difference matters.
const NONE: f64 = 0.1;

/// Deviation assumed of an exact angle, rad: that of its step and more, for the model is not exact.
const EXACT_RAD: f64 = 1e-4;

/// Of readings rounded to a step: step / sqrt(12).
const POSITION_RAD: f64 = Position::LSB_RAD * 0.288_675_134_594_812_9;
const GYRO_RAD_S: f64 = GYRO_STEP_RAD_S * 0.288_675_134_594_812_9;

impl Timing {
    /// The law on the CM-5 between 18 servos with return delay 0, its moment being the end of the
    /// last answer; measured by `cargo xtask bench-firmware --only "age of readings"`. What is read
    /// first is oldest. The host says the first link's attitude every period, as it hears a report.
    /// Its rate counts no more than a gyro's of 10 deg/s: trusted more, what the linear model makes
    /// of one so old fells the robot from 2 deg.
    pub const HOST_ATTITUDE: Timing = Timing {
        effect_s: 0.8e-3,
        age_s: [8.7e-3, 4.1e-3, 1.8e-3, 8.7e-3],
        deviation: [EXACT_RAD, POSITION_RAD, POSITION_RAD, GYRO_RAD_S],
    };

    /// The same with a gyro on the CM-5, read at the law's moment; nothing tells the first link's
    /// angle.
    pub const GYRO: Timing = Timing {
        age_s: [0.0, 4.1e-3, 1.8e-3, 0.1e-3],
        deviation: [f64::INFINITY, POSITION_RAD, POSITION_RAD, GYRO_RAD_S],
        ..Timing::HOST_ATTITUDE
    };
}

/// The machine in SI, as [`handstand_shared::observer`] has it in fixed point.
#[derive(Debug, Clone, PartialEq)]
pub struct OnBoard {
    /// 4 x 15.
    pub predict: DMatrix<f64>,
    /// 2 x 19.
    pub feedback: DMatrix<f64>,
    /// 9 x 21.
    pub update: DMatrix<f64>,
}

impl OnBoard {
    /// Designs filter and gains with the settings of `best`.
    ///
    /// # Errors
    /// Robots of other than three joints, two of them driven; effects or readings later than three
    /// periods; plants that cannot be held or are not seen.
    pub fn new(known: &DesignModel, timing: &Timing) -> Result<OnBoard> {
        if (known.joints(), known.drives()) != (JOINTS, INPUTS) {
            return Err(Error::design(
                format!(
                    "{} joints, {} of them driven",
                    known.joints(),
                    known.drives()
                ),
                "the CM-5 balances three joints of which two are driven",
            ));
        }
        let known = DesignModel {
            delay_s: timing.effect_s,
            ..known.clone()
        };
        let options = Options {
            servo: false,
            ..best::options()
        };
        let believed = widened(&known)?;
        let seen = outputs(&known, timing)?;
        let with_outputs = Discrete {
            c: seen.clone(),
            ..believed.clone()
        };
        let variance = timing.deviation.map(|sd| sd.min(NONE).powi(2));
        let filter = kalman(
            &with_outputs,
            &process(&known, &options)?,
            &DMatrix::from_diagonal(&variance.to_vec().into()),
        )?;
        let gains = gains(&known, &options)?;
        let (a, b, l) = (&believed.a, &believed.b, &filter.gain);
        Ok(OnBoard {
            feedback: -beside(&[&gains, &(&gains * l)]),
            update: beside(&[a, &(a * l), b]).rows(0, ESTIMATED).into_owned(),
            predict: seen,
        })
    }

    /// The inputs commanded; `memory` is what the machine remembers.
    pub fn raw_command(
        &self,
        memory: &mut [f64; WIDTH],
        readings: &[f64; READINGS],
    ) -> [f64; INPUTS] {
        for (i, reading) in readings.iter().enumerate() {
            memory[STATE + i] = reading - times(&self.predict, i, &memory[..STATE]);
        }
        std::array::from_fn(|i| times(&self.feedback, i, &memory[..SEEN]))
    }

    /// Goes on by a sample under the inputs that were applied.
    pub fn update(&self, memory: &mut [f64; WIDTH], applied: [f64; INPUTS]) {
        memory[SEEN..].copy_from_slice(&applied);
        let next: [f64; ESTIMATED] = std::array::from_fn(|i| times(&self.update, i, memory));
        memory.copy_within(ESTIMATED..ESTIMATED + PAST - INPUTS, ESTIMATED + INPUTS);
        memory[..ESTIMATED].copy_from_slice(&next);
        memory[ESTIMATED..ESTIMATED + INPUTS].copy_from_slice(&applied);
    }
}

fn times(matrix: &DMatrix<f64>, row: usize, vector: &[f64]) -> f64 {
    let products = matrix.row(row);
    products.iter().zip(vector).map(|(k, x)| k * x).sum()
}

const OFFSETS: Parts = Parts {
    offsets: true,
    delay: true,
    servo: false,
};

/// The regulator's gains; offsets act as the angles' negatives.
fn gains(known: &DesignModel, options: &Options) -> Result<DMatrix<f64>> {
    let without = plant(
        known,
        Parts {
            offsets: false,
            ..OFFSETS
        },
    )?;
    let narrow = regulator(known, options, &without)?.k;
    let angles = -narrow.columns(0, JOINTS);
    let mut gains = narrow.insert_columns(2 * JOINTS, JOINTS, 0.0);
    gains.columns_mut(2 * JOINTS, JOINTS).copy_from(&angles);
    Ok(gains.resize_horizontally(ESTIMATED + PAST, 0.0))
}

/// The sampled plant with offsets and as many past inputs as the CM-5 keeps.
fn widened(known: &DesignModel) -> Result<Discrete> {
    let late = plant(known, OFFSETS)?;
    if late.delayed_inputs > DELAYS {
        return Err(too_late(known.delay_s));
    }
    let size = ESTIMATED + PAST;
    let (mut a, mut b) = (DMatrix::zeros(size, size), DMatrix::zeros(size, INPUTS));
    let columns = late.a.ncols();
    a.view_mut((0, 0), (ESTIMATED, columns))
        .copy_from(&late.a.rows(0, ESTIMATED));
    b.view_mut((0, 0), (ESTIMATED, INPUTS))
        .copy_from(&late.b.rows(0, ESTIMATED));
    b.view_mut((ESTIMATED, 0), (INPUTS, INPUTS))
        .fill_with_identity();
    a.view_mut(
        (ESTIMATED + INPUTS, ESTIMATED),
        (PAST - INPUTS, PAST - INPUTS),
    )
    .fill_with_identity();
    Ok(Discrete {
        a,
        b,
        c: DMatrix::identity(size, size),
        ts_s: late.ts_s,
        delayed_inputs: DELAYS,
    })
}

fn too_late(delay_s: f64) -> Error {
    Error::design(
        format!("inputs or readings {:.1} ms late", 1e3 * delay_s),
        format!(
            "the CM-5 keeps the inputs of {DELAYS} periods: shorten the delay, or sample more slowly"
        ),
    )
}

/// What each reading tells of [x, offsets, past inputs], given its age.
fn outputs(known: &DesignModel, timing: &Timing) -> Result<DMatrix<f64>> {
    let mut c = DMatrix::zeros(READINGS, ESTIMATED + PAST);
    for (reading, age_s) in timing.age_s.into_iter().enumerate() {
        let ago = ago(known, timing.effect_s, age_s)?;
        c.row_mut(reading).copy_from(&ago.row(reading));
    }
    Ok(c)
}

/// The state [x, offsets] `age_s` ago as a linear function of [x, offsets, past inputs] now.
///
/// Input u(k - n) begins to act at `effect_s` - n periods. Backwards over a span h under one input,
/// x(t - h) = e^{-Ah} (x(t) - S(h) B u).
fn ago(known: &DesignModel, effect_s: f64, age_s: f64) -> Result<DMatrix<f64>> {
    let now = plant(
        known,
        Parts {
            delay: false,
            ..OFFSETS
        },
    )?;
    let mut ago = DMatrix::identity(now.a.nrows(), ESTIMATED + PAST);
    let wide = continuous(known, true);
    let (mut at_s, mut past) = (0.0, 1_usize);
    while at_s > -age_s + 1e-9 {
        let begins_s = effect_s - past as f64 * known.period_s;
        let span_s = at_s - begins_s.max(-age_s);
        if span_s > 1e-9 {
            if past > DELAYS {
                return Err(too_late(effect_s + age_s));
            }
            let held = zoh(&wide, span_s, 0.0)?;
            let from = ESTIMATED + INPUTS * (past - 1);
            let mut columns = ago.columns_mut(from, INPUTS);
            columns -= &held.b;
            ago = held.a.lu().solve(&ago).ok_or_else(|| {
                Error::design("the plant cannot be followed back", "sample faster")
            })?;
            at_s -= span_s;
        }
        past += 1;
    }
    Ok(ago)
}

/// Covariance of what is not known, per sample; past inputs are known.
fn process(known: &DesignModel, options: &Options) -> Result<DMatrix<f64>> {
    let held = plant(
        known,
        Parts {
            delay: false,
            ..OFFSETS
        },
    )?;
    let mut process = DMatrix::zeros(ESTIMATED + PAST, ESTIMATED + PAST);
    let torque = &held.b * held.b.transpose() * options.torque_noise_nm.powi(2);
    process
        .view_mut((0, 0), (ESTIMATED, ESTIMATED))
        .copy_from(&torque);
    for i in 0..JOINTS {
        process[(i, i)] += 1e-10;
        process[(JOINTS + i, JOINTS + i)] += options.speed_noise_rad_s.powi(2);
        process[(2 * JOINTS + i, 2 * JOINTS + i)] += options.offset_walk_rad.powi(2);
    }
    Ok(process)
}

fn beside(parts: &[&DMatrix<f64>]) -> DMatrix<f64> {
    let width = parts.iter().map(|part| part.ncols()).sum();
    let mut all = DMatrix::zeros(parts[0].nrows(), width);
    let mut at = 0;
    for part in parts {
        all.columns_mut(at, part.ncols()).copy_from(part);
        at += part.ncols();
    }
    all
}
