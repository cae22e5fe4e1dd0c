//! Which way servos behind a link are sampled: through a CM-5 that streams, or as an adapter.

use super::adapter::Adapter;
use super::latency::no_response;
use super::source::SampleSource;
use super::stream::Stream;
use crate::error::Result;
use crate::link::{SerialLink, Servos, Session, SessionError};
use std::time::Duration;

/// A line at least as fast as this is an adapter's on the servos' bus, baud.
const SERVO_BUS_BAUD: u32 = 900_000;

/// Opens servos to be sampled: from a CM-5 that `streams` them, 100 times a second; else one by one
/// through an adapter, every `period`.
///
/// # Errors
/// No firmware, or no servo answers.
pub fn open_source<L: SerialLink + 'static>(
    link: L,
    ids: &[u8],
    streams: bool,
    period: Duration,
) -> Result<Box<dyn SampleSource>> {
    if streams {
        return Ok(Box::new(Stream::new(link, ids)?));
    }
    let mut servos = Servos::new(link);
    match ids.iter().any(|id| servos.ping(*id).is_ok()) {
        true => Ok(Box::new(Adapter::new(servos, ids, period))),
        false => Err(no_response()),
    }
}

/// Whether Handstand's firmware answers. A line as fast as the servos' bus is an adapter on it,
/// whose servos would hear what is said: it is not asked.
///
/// # Errors
/// The device failed.
pub fn is_cm5<L: SerialLink>(link: &mut L) -> Result<bool> {
    if link.baud() >= SERVO_BUS_BAUD {
        return Ok(false);
    }
    match Session::open(&mut *link) {
        Ok(_) => Ok(true),
        Err(SessionError::NoFirmware { .. }) => Ok(false),
        Err(error) => Err(error.into()),
    }
}
