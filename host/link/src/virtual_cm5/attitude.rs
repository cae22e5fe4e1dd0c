//! The attitude of a simulated robot's first link, as an exact sensor says it.

use crate::error::Result;
use crate::model::{Model, upright};
use handstand_cm5_sim::{Bus, BusSpec};
use handstand_shared::message::Attitude;
use std::sync::mpsc::channel;

/// Period of the sensor, s.
const PERIOD_S: f64 = 1e-3;

/// Asked for the newest attitude since it was asked before.
pub type AttitudeSensor = Box<dyn FnMut() -> Option<Attitude> + Send>;

/// A sensor of the first link's angle from upright on the robot that hangs on `bus`, as `spec`
/// describes it; none without a robot.
///
/// # Errors
/// The robot's model cannot be read.
pub fn attitude_sensor(bus: &mut Bus, spec: &BusSpec) -> Result<Option<AttitudeSensor>> {
    match &spec.robot {
        Some(described) => Ok(attitude_sensor_of(bus, &Model::load(&described.model)?)),
        None => Ok(None),
    }
}

/// The same of a robot that this model describes.
pub fn attitude_sensor_of(bus: &mut Bus, model: &Model) -> Option<AttitudeSensor> {
    let robot = bus.robot()?;
    let upright_rad = upright(model).first().copied().unwrap_or(0.0);
    let (tell, states) = channel();
    robot.watch_every(PERIOD_S, tell);
    let steps = |value: f64, lsb: f64| {
        let most = f64::from(i16::MAX);
        (value / lsb).round().clamp(-most, most) as i16
    };
    Some(Box::new(move || {
        let state = states.try_iter().last()?;
        let (angle_rad, rate_rad_s) = (state.angle_rad.first()?, state.speed_rad_s.first()?);
        Some(Attitude {
            angle: steps(angle_rad - upright_rad, Attitude::ANGLE_LSB_RAD),
            rate: steps(*rate_rad_s, Attitude::RATE_LSB_RAD_S),
        })
    }))
}
