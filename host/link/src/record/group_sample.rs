//! What the bytes of servos of Protocol 2.0 say, in SI.

use super::sample::ServoSample;
use crate::{Reading, SerialLink, ServoResult, Servos};
use handstand_shared::control_table::models::ServoModel;
use handstand_shared::control_table::x::*;
use handstand_shared::control_table::{POSITION_CENTRE, POSITION_LSB_RAD, SPEED_LSB_RAD_S};

/// Address and bytes of current (or load), velocity and position, one behind the other.
pub(super) const STATE: (u16, u16) = (PRESENT_CURRENT.address, 10);
/// Address and bytes of supply and temperature.
pub(super) const HEALTH: (u16, u16) = (PRESENT_VOLTAGE.address, 3);

/// A sample of the bytes of [`STATE`]; none of more or fewer.
pub(super) fn state(model: &ServoModel, reading: &Reading) -> Option<ServoSample> {
    let data: [u8; 10] = reading.data[..].try_into().ok()?;
    let current = f64::from(PRESENT_CURRENT.code(&data[..2])?);
    let velocity = f64::from(PRESENT_VELOCITY.code(&data[2..6])?);
    let lsb_a = model.current_lsb_a;
    Some(ServoSample {
        position_rad: Some(angle_of(PRESENT_POSITION.code(&data[6..])?)),
        speed_rad_s: Some(velocity * SPEED_LSB_RAD_S),
        current_a: lsb_a.map(|lsb_a| current * lsb_a),
        load: lsb_a.is_none().then_some(current * 1e-3),
        error: Some(reading.error.byte()),
        ..ServoSample::default()
    })
}

/// Address and bytes of all that a servo measures, from [`STATE`] to [`HEALTH`].
const MEASURED: (u16, u16) = (STATE.0, HEALTH.0 + HEALTH.1 - STATE.0);

impl ServoSample {
    /// Asks servo `id` of Protocol 2.0 for all that it measures; also its hardware errors.
    ///
    /// # Errors
    /// Why there is no good answer.
    pub fn ask<L: SerialLink>(
        servos: &mut Servos<L>,
        id: u8,
    ) -> ServoResult<(ServoSample, Vec<&'static str>)> {
        let model = servos.model(id)?;
        let all = servos.read(id, MEASURED.0, MEASURED.1)?;
        let part = |from: usize, count: u16| Reading {
            error: all.error,
            data: all.data[from..from + usize::from(count)].to_vec(),
        };
        let health = health(&part(usize::from(HEALTH.0 - STATE.0), HEALTH.1));
        let errors = if all.error.has_alert() {
            servos.hardware_errors(id)?
        } else {
            Vec::new()
        };
        let sample = ServoSample {
            supply_v: health.map(|(supply_v, _)| supply_v),
            temperature_celsius: health.map(|(_, celsius)| celsius),
            ..state(model, &part(0, STATE.1)).unwrap_or_default()
        };
        Ok((sample, errors))
    }
}

/// Supply, V, and temperature, degrees Celsius, of the bytes of [`HEALTH`].
pub(super) fn health(reading: &Reading) -> Option<(f64, f64)> {
    let data: [u8; 3] = reading.data[..].try_into().ok()?;
    let supply = PRESENT_VOLTAGE.code(&data[..2])?;
    Some((f64::from(supply) * 0.1, f64::from(data[2])))
}

/// Angle from the middle of the turn, rad, of a position's code.
pub(super) fn angle_of(code: i32) -> f64 {
    f64::from(code.saturating_sub(POSITION_CENTRE)) * POSITION_LSB_RAD
}

/// The nearest code of an angle.
pub(super) fn code_of(angle_rad: f64) -> i32 {
    (angle_rad / POSITION_LSB_RAD).round() as i32 + POSITION_CENTRE
}
