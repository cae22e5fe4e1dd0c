//! [`best`](super::best) as the CM-5 can run it: every reading with its own age, and one linear
//! machine that updates an estimate from readings and the inputs that really went out.
//!
//! The CM-5 reads one servo after the other and computes at the end, so a reading is older than the
//! moment of the law by what the others took. The filter is told: its output equation is that of
//! the state `age` ago, x(t - age), which the state and the inputs since determine exactly. A
//! servo's torque follows its input with a lag, so that both torques are states. With s = [x,
//! offsets, torques, past inputs],
//!
//! ```text
//! innovation  = y - C s
//! raw command = -K (s + L innovation)
//! next        = A (s + L innovation) + B applied
//! ```

use super::DesignModel;
use super::best::BEST;
use super::board_timing::{BoardTiming, ROUNDED};
use super::observed::{Options, process_noise, regulator};
use super::plant::{continuous, with_offsets};
use crate::error::{Error, Result};
use crate::synth::{Continuous, Discrete, kalman, zoh, zoh_each};
use handstand_shared::observer::{
    DELAYS, ESTIMATED, INPUTS, JOINTS, PAST, READINGS, SEEN, STATE, WIDTH,
};
use nalgebra::{DMatrix, stack};

/// Wander of a gyro's offset in a sample times the gyro's step, (rad/s)^2: the coarser the step,
/// the longer its mean must be taken. Found on steps of 1 and 10 deg/s.
const OFFSET_WALK: f64 = 1.75e-5;

/// Weights and noise where nothing measures the first link's angle. With those of `best` the joints
/// swing by 90 deg from a lean of 1 deg, until the gyro has told enough; these, found by a random
/// search over starts of 1 to 2 deg on the paper's robot, hold them back: more weight on the
/// joints' angles, less on the shoulder's speed.
const BY_GYRO: Options = Options {
    weights: [&[0.01, 7.0, 7.0], &[0.2, 0.01, 25.0]],
    torque_noise_nm: 0.12,
    ..BEST.options
};

/// Place of the gyro's offset where no angle of the first link is measured.
const GYRO_OFFSET: usize = 2 * JOINTS;

/// Place of the first torque.
const TORQUES: usize = 3 * JOINTS;

/// The machine in SI, as [`handstand_shared::observer`] has it in fixed point.
#[derive(Debug, Clone, PartialEq)]
pub struct OnBoard {
    /// 4 x 17.
    pub predict: DMatrix<f64>,
    /// 2 x 21.
    pub feedback: DMatrix<f64>,
    /// 11 x 23.
    pub update: DMatrix<f64>,
}

impl OnBoard {
    /// Designs filter and gains with the settings of `best`, or with its own for a gyro alone.
    ///
    /// # Errors
    /// Robots of other than three joints, two of them driven; effects or readings later than three
    /// periods; plants that cannot be held or are not seen.
    pub fn new(known: &DesignModel, timing: &BoardTiming) -> Result<OnBoard> {
        let known = &on_time(known, timing)?;
        let options = if timing.is_gyro() {
            &BY_GYRO
        } else {
            &BEST.options
        };
        let wide = lagging(known, timing);
        let predict = outputs(known, timing, &wide)?;
        let believed = widened(known, timing, &wide)?;
        let l = filter(known, options, timing, &believed, &wide, &predict)?;
        let gains = gains(known, options, timing, &wide)?;
        let (a, b) = (&believed.a, &believed.b);
        Ok(OnBoard {
            feedback: -stack![gains, &gains * &l],
            update: stack![a, a * &l, b].rows(0, ESTIMATED).into_owned(),
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

/// What the board's drives do and its readings tell, sampled: the state is [angles, speeds,
/// torques, past inputs], the outputs are the readings, each of its own age.
///
/// # Errors
/// Robots of other than three joints, two of them driven; effects or readings later than three
/// periods.
pub fn board_plant(known: &DesignModel, timing: &BoardTiming) -> Result<Discrete> {
    let known = &on_time(known, timing)?;
    let wide = lagging(known, timing);
    let predict = outputs(known, timing, &wide)?;
    let believed = widened(known, timing, &wide)?;
    // Offsets are a filter's: the plant has none.
    let plain = |matrix: DMatrix<f64>| matrix.remove_columns(2 * JOINTS, JOINTS);
    Ok(Discrete {
        a: plain(believed.a).remove_rows(2 * JOINTS, JOINTS),
        b: believed.b.remove_rows(2 * JOINTS, JOINTS),
        c: plain(predict),
        ..believed
    })
}

/// What is known, with the board's timing.
fn on_time(known: &DesignModel, timing: &BoardTiming) -> Result<DesignModel> {
    let (joints, drives) = (known.joints(), known.drives());
    if (joints, drives) != (JOINTS, INPUTS) {
        return Err(Error::design(
            format!("{joints} joints, {drives} of them driven"),
            "the CM-5 balances three joints of which two are driven",
        ));
    }
    Ok(DesignModel {
        delay_s: timing.latest_effect_s(),
        servo: None,
        ..known.clone()
    })
}

fn times(matrix: &DMatrix<f64>, row: usize, vector: &[f64]) -> f64 {
    let products = matrix.row(row);
    products.iter().zip(vector).map(|(k, x)| k * x).sum()
}

/// x' = A x + B u of [angles, speeds, offsets, torques].
fn lagging(known: &DesignModel, timing: &BoardTiming) -> Continuous {
    let plain = continuous(known, true);
    let mut a = plain.a.resize(ESTIMATED, ESTIMATED, 0.0);
    if timing.is_gyro() {
        // Its angle is that from equilibrium; in the place of that one the gyro's offset stays.
        a.column_mut(GYRO_OFFSET).fill(0.0);
    }
    let mut b = plain.b.resize(ESTIMATED, INPUTS, 0.0);
    if timing.lag_s > 0.0 {
        a.columns_mut(TORQUES, INPUTS).copy_from(&b);
        b.fill(0.0);
    }
    for drive in TORQUES..ESTIMATED {
        // Torques that follow at once are of no effect, and fade.
        a[(drive, drive)] = if timing.lag_s > 0.0 {
            -1.0 / timing.lag_s
        } else {
            -1.0 / known.period_s
        };
        if timing.lag_s > 0.0 {
            b[(drive, drive - TORQUES)] = 1.0 / timing.lag_s;
        }
    }
    for (place, &joint) in known.driven.iter().enumerate() {
        if timing.is_filtered(place) {
            // The state of a torque that follows at once is free: T f' + f = angle.
            let per_s = 1.0 / timing.sensor_lag_s[place];
            a[(TORQUES + place, TORQUES + place)] = -per_s;
            a[(TORQUES + place, joint)] = per_s;
        }
    }
    Continuous {
        a,
        b,
        c: DMatrix::identity(ESTIMATED, ESTIMATED),
    }
}

/// The regulator's gains; offsets act as the angles' negatives.
fn gains(
    known: &DesignModel,
    options: &Options,
    timing: &BoardTiming,
    wide: &Continuous,
) -> Result<DMatrix<f64>> {
    // Without the offsets, of which nothing is controllable.
    let a = wide.a.clone().remove_columns(2 * JOINTS, JOINTS);
    let narrow = Continuous {
        a: a.remove_rows(2 * JOINTS, JOINTS),
        b: wide.b.clone().remove_rows(2 * JOINTS, JOINTS),
        c: DMatrix::identity(ESTIMATED - JOINTS, ESTIMATED - JOINTS),
    };
    let narrow = zoh_each(&narrow, known.period_s, &timing.effects_s())?;
    let narrow = regulator(known, options, &narrow)?.k;
    let mut gains = with_offsets(&narrow, JOINTS).resize_horizontally(ESTIMATED + PAST, 0.0);
    if timing.is_gyro() {
        gains.column_mut(GYRO_OFFSET).fill(0.0);
    }
    Ok(gains)
}

/// The stationary filter's gains, for each reading one column; a reading that there is not has
/// none.
fn filter(
    known: &DesignModel,
    options: &Options,
    timing: &BoardTiming,
    believed: &Discrete,
    wide: &Continuous,
    predict: &DMatrix<f64>,
) -> Result<DMatrix<f64>> {
    let mut process = process_noise(known, options, ESTIMATED + PAST)?;
    if timing.lag_s > 0.0 {
        let held = zoh(wide, known.period_s, 0.0)?.b * options.torque_noise_nm;
        let mut late = process.view_mut((0, 0), (ESTIMATED, ESTIMATED));
        late += &held * held.transpose();
    }
    if timing.is_gyro() {
        let step_rad_s = timing.deviation[JOINTS] / ROUNDED;
        process[(GYRO_OFFSET, GYRO_OFFSET)] = (OFFSET_WALK / step_rad_s).powi(2);
    }
    let first = usize::from(timing.is_gyro());
    let variance: Vec<f64> = timing.deviation[first..]
        .iter()
        .map(|sd| sd.powi(2))
        .collect();
    let measured = Discrete {
        c: predict.rows(first, READINGS - first).into_owned(),
        ..believed.clone()
    };
    let filter = kalman(
        &measured,
        &process,
        &DMatrix::from_diagonal(&variance.into()),
    )?;
    Ok(filter.gain.insert_columns(0, first, 0.0))
}

/// The sampled plant with offsets, torques and as many past inputs as the CM-5 keeps.
fn widened(known: &DesignModel, timing: &BoardTiming, wide: &Continuous) -> Result<Discrete> {
    let late = zoh_each(wide, known.period_s, &timing.effects_s())?;
    if late.delayed_inputs > DELAYS {
        return Err(too_late(known.delay_s));
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

/// What each reading tells of [x, offsets, torques, past inputs], given its age.
fn outputs(known: &DesignModel, timing: &BoardTiming, wide: &Continuous) -> Result<DMatrix<f64>> {
    let mut c = DMatrix::zeros(READINGS, ESTIMATED + PAST);
    for (reading, age_s) in timing.age_s.into_iter().enumerate() {
        for (input, effect_s) in timing.effects_s().into_iter().enumerate() {
            let ago = ago(known, wide, effect_s, age_s)?;
            let row = ago.row(read_state(known, timing, reading));
            if input == 0 {
                c.row_mut(reading).copy_from(&row);
            }
            // Inputs add up: each has the share that it has where all act when it does.
            for place in (ESTIMATED + input..ESTIMATED + PAST).step_by(INPUTS) {
                c[(reading, place)] = row[place];
            }
        }
    }
    if timing.is_gyro() {
        c[(JOINTS, GYRO_OFFSET)] += 1.0;
    }
    Ok(c)
}

/// The state that a reading tells: that of the filter which it comes through, else the joint's own.
fn read_state(known: &DesignModel, timing: &BoardTiming, reading: usize) -> usize {
    let place = known.driven.iter().position(|joint| *joint == reading);
    match place.filter(|place| timing.is_filtered(*place)) {
        Some(place) => TORQUES + place,
        None => reading,
    }
}

/// The state [x, offsets, torques] `age_s` ago as a linear function of that and past inputs now.
///
/// Input u(k - n) begins to act at `effect_s` - n periods. Backwards over a span h under one input,
/// x(t - h) = e^{-Ah} (x(t) - S(h) B u).
fn ago(known: &DesignModel, wide: &Continuous, effect_s: f64, age_s: f64) -> Result<DMatrix<f64>> {
    let mut ago = DMatrix::identity(ESTIMATED, ESTIMATED + PAST);
    let (mut at_s, mut past) = (0.0, 1_usize);
    while at_s > -age_s + 1e-9 {
        let begins_s = effect_s - past as f64 * known.period_s;
        let span_s = at_s - begins_s.max(-age_s);
        if span_s > 1e-9 {
            if past > DELAYS {
                return Err(too_late(effect_s + age_s));
            }
            let held = zoh(wide, span_s, 0.0)?;
            let from = ESTIMATED + INPUTS * (past - 1);
            let mut columns = ago.columns_mut(from, INPUTS);
            columns -= &held.b;
            let before = held.a.lu().solve(&ago);
            ago = before.ok_or_else(|| {
                Error::design("the plant cannot be followed back", "sample faster")
            })?;
            at_s -= span_s;
        }
        past += 1;
    }
    Ok(ago)
}

/// Inputs or readings older than the CM-5 keeps inputs.
fn too_late(delay_s: f64) -> Error {
    Error::design(
        format!("inputs or readings {:.1} ms late", 1e3 * delay_s),
        format!(
            "the CM-5 keeps the inputs of {DELAYS} periods: shorten the delay, or sample more \
             slowly"
        ),
    )
}
