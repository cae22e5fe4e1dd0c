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

use super::best::BEST;
use super::observed::{Options, process_noise, regulator};
use super::plant::{continuous, plant, with_offsets};
use super::{ControllerReason, DesignModel};
use crate::error::Result;
use crate::sim::closed_loop::GYRO_STEP_RAD_S;
use crate::synth::{Discrete, kalman, zoh};
use handstand_shared::observer::{
    DELAYS, ESTIMATED, INPUTS, JOINTS, PAST, READINGS, SEEN, STATE, WIDTH,
};
use handstand_shared::raw::Position;
use nalgebra::{DMatrix, stack};

/// When things happen in a period, and how well the readings tell.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BoardTiming {
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

impl BoardTiming {
    /// The law on the CM-5 between 18 servos with return delay 0, its moment being the end of the
    /// last answer; measured by `cargo xtask bench-firmware --only "age of readings"`. What is read
    /// first is oldest. The host says the first link's attitude every period, as it hears a report.
    /// Its rate counts no more than a gyro's of 10 deg/s: trusted more, what the linear model makes
    /// of one so old fells the robot from 2 deg.
    pub const HOST_ATTITUDE: BoardTiming = BoardTiming {
        effect_s: 0.8e-3,
        age_s: [8.7e-3, 4.1e-3, 1.8e-3, 8.7e-3],
        deviation: [EXACT_RAD, POSITION_RAD, POSITION_RAD, GYRO_RAD_S],
    };

    /// The same with a gyro on the CM-5, read at the law's moment; nothing tells the first link's
    /// angle.
    pub const GYRO: BoardTiming = BoardTiming {
        age_s: [0.0, 4.1e-3, 1.8e-3, 0.1e-3],
        deviation: [f64::INFINITY, POSITION_RAD, POSITION_RAD, GYRO_RAD_S],
        ..BoardTiming::HOST_ATTITUDE
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
    pub fn new(known: &DesignModel, timing: &BoardTiming) -> Result<OnBoard> {
        let (joints, drives) = (known.joints(), known.drives());
        if (joints, drives) != (JOINTS, INPUTS) {
            return Err(ControllerReason::BoardSize { joints, drives }.into());
        }
        let known = &DesignModel {
            delay_s: timing.effect_s,
            servo: None,
            ..known.clone()
        };
        let options = &BEST.options;
        let predict = outputs(known, timing)?;
        let believed = Discrete {
            c: predict.clone(),
            ..widened(known)?
        };
        let variance = timing.deviation.map(|sd| sd.min(NONE).powi(2));
        let filter = kalman(
            &believed,
            &process_noise(known, options, ESTIMATED + PAST)?,
            &DMatrix::from_diagonal(&variance.to_vec().into()),
        )?;
        let gains = gains(known, options)?;
        let (a, b, l) = (&believed.a, &believed.b, &filter.gain);
        Ok(OnBoard {
            feedback: -stack![gains, &gains * l],
            update: stack![a, a * l, b].rows(0, ESTIMATED).into_owned(),
            predict,
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

/// The regulator's gains; offsets act as the angles' negatives.
fn gains(known: &DesignModel, options: &Options) -> Result<DMatrix<f64>> {
    let narrow = regulator(known, options, &plant(known, false)?)?.k;
    Ok(with_offsets(&narrow, JOINTS).resize_horizontally(ESTIMATED + PAST, 0.0))
}

/// The sampled plant with offsets and as many past inputs as the CM-5 keeps.
fn widened(known: &DesignModel) -> Result<Discrete> {
    let late = plant(known, true)?;
    if late.delayed_inputs > DELAYS {
        let delay_s = known.delay_s;
        return Err(ControllerReason::TooLate { delay_s }.into());
    }
    let size = ESTIMATED + PAST;
    let mut a = late
        .a
        .rows(0, ESTIMATED)
        .into_owned()
        .resize(size, size, 0.0);
    let mut b = late
        .b
        .rows(0, ESTIMATED)
        .into_owned()
        .resize(size, INPUTS, 0.0);
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

/// What each reading tells of [x, offsets, past inputs], given its age.
fn outputs(known: &DesignModel, timing: &BoardTiming) -> Result<DMatrix<f64>> {
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
    let mut ago = DMatrix::identity(ESTIMATED, ESTIMATED + PAST);
    let wide = continuous(known, true);
    let (mut at_s, mut past) = (0.0, 1_usize);
    while at_s > -age_s + 1e-9 {
        let begins_s = effect_s - past as f64 * known.period_s;
        let span_s = at_s - begins_s.max(-age_s);
        if span_s > 1e-9 {
            if past > DELAYS {
                let delay_s = effect_s + age_s;
                return Err(ControllerReason::TooLate { delay_s }.into());
            }
            let held = zoh(&wide, span_s, 0.0)?;
            let from = ESTIMATED + INPUTS * (past - 1);
            let mut columns = ago.columns_mut(from, INPUTS);
            columns -= &held.b;
            let before = held.a.lu().solve(&ago);
            ago = before.ok_or(ControllerReason::Irreversible)?;
            at_s -= span_s;
        }
        past += 1;
    }
    Ok(ago)
}
