//! Twenty pings to each servo.

use super::super::port::Link;
use super::super::retry::Failure;
use super::super::servos::Servos;
use crate::error::Result;
use handstand_shared::control_table::RETURN_DELAY;
use handstand_shared::dynamixel::ErrorBits;
use serde::Serialize;

/// How often each servo is pinged.
pub(super) const PINGS: usize = 20;

/// How one servo answered twenty pings.
#[derive(Debug, Clone, Default, Serialize)]
pub struct Pulse {
    /// Its id.
    pub id: u8,
    /// Sound answers.
    pub answered: usize,
    /// No byte.
    pub silent: usize,
    /// Bytes, but only after the return delay and its margin.
    pub late: usize,
    /// Sound answers with more bytes behind them, as of a second servo.
    pub doubled: usize,
    /// Bytes, but no sound answer.
    pub garbled: usize,
    /// Another servo's answer.
    pub strangers: usize,
    /// Complaints of a wrong checksum.
    pub misheard: usize,
    /// What else it complains of.
    pub errors: Vec<&'static str>,
}

pub(super) fn pulse<L: Link>(servos: &mut Servos<L>, id: u8) -> Result<Pulse> {
    let mut pulse = Pulse {
        id,
        ..Pulse::default()
    };
    // With its return delay known, what is late shows.
    if let Err(Failure::Port(error)) = servos.get(id, RETURN_DELAY) {
        return Err(error);
    }
    let mut errors = ErrorBits(0);
    for round in 0..PINGS {
        match servos.ping(id) {
            Ok(error) => {
                pulse.answered += 1;
                errors = errors.with(error);
                let more = servos.stragglers().map_err(|failure| failure.of(id))?;
                pulse.doubled += usize::from(more > 0);
            }
            Err(Failure::Silent) => match servos.stragglers() {
                Ok(0) => pulse.silent += 1,
                Ok(_) => pulse.late += 1,
                Err(failure) => return Err(failure.of(id)),
            },
            Err(Failure::Garbled(_) | Failure::Refused(_)) => pulse.garbled += 1,
            Err(Failure::Stranger(_)) => pulse.strangers += 1,
            Err(Failure::Misheard) => pulse.misheard += 1,
            Err(Failure::Port(error)) => return Err(error),
        }
        // A servo that is not there is not there: no need to ask so often.
        if round == 2 && pulse.silent == 3 {
            pulse.silent = PINGS;
            break;
        }
    }
    pulse.errors = errors.names().collect();
    Ok(pulse)
}
