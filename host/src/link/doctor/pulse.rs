//! Twenty pings to each servo.

use super::super::port::Link;
use super::super::retry::Failure;
use super::super::servos::Servos;
use crate::error::Result;
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
    /// Bytes, but no sound answer.
    pub garbled: usize,
    /// Another servo's answer.
    pub strangers: usize,
    /// What it complains of.
    pub errors: Vec<&'static str>,
}

pub(super) fn pulse<L: Link>(servos: &mut Servos<L>, id: u8) -> Result<Pulse> {
    let mut pulse = Pulse {
        id,
        ..Pulse::default()
    };
    for round in 0..PINGS {
        match servos.ping(id) {
            Ok(errors) => {
                pulse.answered += 1;
                pulse.errors = errors.names().collect();
            }
            Err(Failure::Silent) => pulse.silent += 1,
            Err(Failure::Garbled(_) | Failure::Refused(_)) => pulse.garbled += 1,
            Err(Failure::Stranger(_)) => pulse.strangers += 1,
            Err(Failure::Port(error)) => return Err(error),
        }
        // A servo that is not there is not there: no need to ask so often.
        if round == 2 && pulse.silent == 3 {
            pulse.silent = PINGS;
            break;
        }
    }
    Ok(pulse)
}
