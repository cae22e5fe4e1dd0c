//! What an outside torque does to a servo that holds an angle, and to one that is told a speed.

use super::figure::Holds;
use super::findings::Conclusion;
use super::servo;
use crate::error::Result;
use crate::model::{AngleZero, Drive, Model};
use crate::motion::Motion;
use crate::output::number::short;
use crate::sim::StartState;

/// What an outside torque does to a servo that holds an angle, and to one that is told a speed.
pub(super) fn position_and_velocity() -> Result<Conclusion> {
    let base = servo::model()?;
    let Some(motor) = base.joints[0].drive.motor().cloned() else {
        return Ok(("the servo has no motor".to_string(), Holds::NotReproducible));
    };
    let phase = (0..1200).map(|k| 0.02 * f64::from(k));
    let sine: Vec<f64> = phase.clone().map(|phase| 0.5 * phase.sin()).collect();
    let duty: Vec<f64> = phase.map(|phase| duty(phase.cos())).collect();
    let follow = Drive::Position {
        gain_per_rad: 10.0,
        motor: motor.clone(),
    };
    let position = shift_rad(&base, follow, sine);
    let velocity = shift_rad(&base, Drive::Duty(motor), duty);
    let holds = position.abs() < 0.1 && velocity.abs() > 3.0 * position.abs();
    let said = format!(
        "In simulation 0.3 N m from 6 s on move the position-controlled servo off its sine by {} \
         deg and the speed-commanded one by {} deg within 6 s.",
        short(position.to_degrees()),
        short(velocity.to_degrees())
    );
    Ok((said, Holds::when(holds)))
}

/// Duty for a speed: past the dead zone, full at 11.9 rad/s.
fn duty(speed_rad_s: f64) -> f64 {
    (speed_rad_s.abs() / 11.9 + 0.085).copysign(speed_rad_s)
}

/// Largest shift, rad, that 0.3 N m of a mass on a horizontal lever bring from 6 s on.
fn shift_rad(base: &Model, drive: Drive, input: Vec<f64>) -> f64 {
    let mut model = base.clone();
    model.joints[0].drive = drive;
    // The lever's weight pulls the same way at every angle that is reached: gravity's moment about
    // the level.
    model.angle_zero = AngleZero::Horizontal;
    let samples = input.len();
    let free = servo::empty_motion(input);
    let loaded = Motion {
        payload_kg: 0.3 / (model.gravity_m_s2 * model.log.payload_at_m),
        ..free.clone()
    };
    let level = StartState {
        angle_rad: vec![std::f64::consts::FRAC_PI_2],
        speed_rad_s: vec![0.0],
        ..StartState::default()
    };
    let (_, at_six) = servo::predicted(&model, &free, 0..600, &level);
    let (calm, _) = servo::predicted(&model, &free, 599..samples, &at_six);
    let (pulled, _) = servo::predicted(&model, &loaded, 599..samples, &at_six);
    let shifts = calm.iter().zip(&pulled).map(|(a, b)| (a - b).abs());
    shifts.fold(0.0, f64::max)
}
