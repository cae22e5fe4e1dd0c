//! Simulated ports: servos behind an adapter or behind a CM-5 (feature `virtual-cm5`).

use super::port::AnyLink;
use handstand::Result;
#[cfg(feature = "robot")]
pub use handstand::deploy::balance::AttitudeSource as Attitude;
#[cfg(feature = "virtual-cm5")]
use handstand::link::virtual_cm5::{
    AdapterPort, Bus, Cm5Port, SimLink, attitude_sensor, set_up, spec,
};

/// No attitude comes with a port of a program without the robot.
#[cfg(not(feature = "robot"))]
pub type Attitude = std::convert::Infallible;

/// Opens the simulated port that `text` describes, a CM-5's or an adapter's.
///
/// # Errors
/// The text describes no bus, or its robot does not fit.
#[cfg(feature = "virtual-cm5")]
pub fn open(text: &str, is_cm5: bool) -> Result<AnyLink> {
    Ok(link(set_up(&spec(text)?)?, is_cm5))
}

/// The same with the first link's attitude of the robot on it, if there is one.
///
/// # Errors
/// As [`open`].
#[cfg(feature = "virtual-cm5")]
pub fn open_with_attitude(text: &str, is_cm5: bool) -> Result<(AnyLink, Option<Attitude>)> {
    let spec = spec(text)?;
    let mut bus = set_up(&spec)?;
    let sensor = attitude_sensor(&mut bus, &spec)?;
    Ok((link(bus, is_cm5), sensor.map(Attitude::Simulated)))
}

/// The port of a CM-5 in front of this bus, or of an adapter on it.
#[cfg(feature = "virtual-cm5")]
pub fn link(bus: Bus, is_cm5: bool) -> AnyLink {
    if is_cm5 {
        Box::new(SimLink(Cm5Port::new(bus)))
    } else {
        Box::new(SimLink(AdapterPort::new(bus)))
    }
}

/// Refuses: this program was built without the feature.
///
/// # Errors
/// Always.
#[cfg(not(feature = "virtual-cm5"))]
pub fn open(_text: &str, _is_cm5: bool) -> Result<AnyLink> {
    Err(absent())
}

/// Refuses: this program was built without the feature.
///
/// # Errors
/// Always.
#[cfg(not(feature = "virtual-cm5"))]
pub fn open_with_attitude(_text: &str, _is_cm5: bool) -> Result<(AnyLink, Option<Attitude>)> {
    Err(absent())
}

/// The error of a program without simulated servos.
#[cfg(not(feature = "virtual-cm5"))]
pub fn absent() -> handstand::Error {
    handstand::Error::usage(
        "this program was built without simulated servos",
        "build it with the cargo feature `virtual-cm5`, which is on by default",
    )
}
