//! Quantise the observer-based law to the board's fixed point.
//!
//! Steps are such that rounding lies far below what the sensors round: estimated angles in 1/128 of
//! a position code or half a step of attitude, speeds in 5e-4 rad/s, equilibrium angles four times
//! as fine as angles, torques in 2^-13 N m.

use crate::error::{Error, Result};
use crate::synth::controllers::OnBoard;
use crate::synth::{Format, Ranges, quantise};
use handstand_shared::gains::GainTable;
use handstand_shared::message::Attitude;
use handstand_shared::observer::{
    ESTIMATED, FINE, INPUTS, JOINTS, Observer, READINGS, SEEN, STATE, WIDTH,
};
use handstand_shared::raw::Position;
use nalgebra::DMatrix;

/// Step of a torque, N m.
pub(super) const INPUT_STEP_NM: f64 = 1.0 / 8192.0;
/// See [`Observer`].
const READING_PLACES: [u8; READINGS] = [1, 2, 2, 1];
const BALANCE_PLACES: [u8; JOINTS] = [3, 4, 4];
/// Largest estimate or reading in steps: a little below 16 bits, that rounding a range does not
/// exceed them.
pub(super) const WORD: f64 = 32_766.0;

/// SI value of one step of each word of the observer's state.
pub fn state_steps() -> [f64; WIDTH] {
    let mut step = [INPUT_STEP_NM; WIDTH];
    let reading = reading_steps();
    let finer = |reading: f64, places: u8| reading / f64::from(1 << places);
    let innovation: [f64; READINGS] = std::array::from_fn(|i| finer(reading[i], READING_PLACES[i]));
    for joint in 0..JOINTS {
        step[joint] = innovation[joint];
        step[JOINTS + joint] = innovation[JOINTS];
        step[2 * JOINTS + joint] = finer(reading[joint], BALANCE_PLACES[joint]);
    }
    step[STATE..SEEN].copy_from_slice(&innovation);
    step
}

/// SI value of one step of each reading.
pub fn reading_steps() -> [f64; READINGS] {
    let joint = Position::LSB_RAD / f64::from(1 << FINE);
    [
        Attitude::ANGLE_LSB_RAD,
        joint,
        joint,
        Attitude::RATE_LSB_RAD_S,
    ]
}

/// Round the observer to 16-bit words.
///
/// # Errors
/// Gains that overflow their words.
pub(super) fn quantised(machine: &OnBoard, limit_nm: [f64; INPUTS]) -> Result<Observer> {
    let step = state_steps();
    let feedback = rounded(
        &machine.feedback,
        &step[..SEEN],
        &[INPUT_STEP_NM; INPUTS],
        &limit_nm.map(|limit_nm| limit_nm / INPUT_STEP_NM),
    )?;
    let update = rounded(
        &machine.update,
        &step,
        &step[..ESTIMATED],
        &[WORD; ESTIMATED],
    )?;
    let predict = rounded(
        &machine.predict,
        &step[..STATE],
        &step[STATE..SEEN],
        &[WORD; READINGS],
    )?;
    Ok(Observer {
        predict: table(&predict)?,
        feedback: table(&feedback)?,
        update: table(&update)?,
        reading_places: READING_PLACES,
        balance_places: BALANCE_PLACES,
    })
}

/// Rows of `matrix` in fixed point; outputs saturate at so many steps.
fn rounded(
    matrix: &DMatrix<f64>,
    from_step: &[f64],
    to_step: &[f64],
    most: &[f64],
) -> Result<Vec<u8>> {
    let ranges = Ranges {
        state: from_step.iter().map(|step| step * WORD).collect(),
        input: to_step
            .iter()
            .zip(most)
            .map(|(step, most)| step * most)
            .collect(),
    };
    let format = Format {
        state_step: Some(from_step.to_vec()),
        input_step: Some(to_step.to_vec()),
        ..Format::default()
    };
    let (x0, u0) = (vec![0.0; from_step.len()], vec![0.0; to_step.len()]);
    // The law subtracts its gains.
    Ok(quantise(&-matrix, &x0, &u0, &ranges, &format)?.bytes())
}

fn table<const M: usize, const N: usize>(bytes: &[u8]) -> Result<GainTable<M, N>> {
    GainTable::from_bytes(bytes)
        .filter(GainTable::is_safe)
        .ok_or_else(|| Error::design("the observer overflows its words", "take a coarser step"))
}
