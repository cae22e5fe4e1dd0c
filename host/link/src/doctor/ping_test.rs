//! Twenty pings to each servo, and twenty readings of one that answers.

use super::super::port::SerialLink;
use super::super::servo_error::ServoError;
use super::super::servos::Servos;
use super::read_test::{ReadTest, read_test};
use crate::error::Result;
use handstand_shared::control_table::RETURN_DELAY;
use serde::Serialize;

/// How often each servo is pinged.
pub(super) const PINGS: usize = 20;

/// Replies of one servo to twenty pings.
#[derive(Debug, Clone, Default, Serialize)]
pub struct PingTest {
    /// Its id.
    pub id: u8,
    /// Valid replies.
    pub answered: usize,
    /// No byte.
    pub silent: usize,
    /// Bytes, but only after the return delay and its margin.
    pub late: usize,
    /// Valid replies with more bytes behind them, as of a second servo.
    pub doubled: usize,
    /// Bytes, but no valid reply.
    pub garbled: usize,
    /// Replies with another id.
    pub unexpected_ids: usize,
    /// Replies that the request's checksum was wrong.
    pub corrupted_requests: usize,
    /// Its other error flags.
    pub error_flags: Vec<&'static str>,
    /// Its answers to twenty readings; none where no ping was answered.
    pub readings: Option<ReadTest>,
}

pub(super) fn ping_test<L: SerialLink>(servos: &mut Servos<L>, id: u8) -> Result<PingTest> {
    let mut test = PingTest {
        id,
        ..PingTest::default()
    };
    // With its return delay known, late replies show.
    if let Err(error) = servos.get(id, RETURN_DELAY) {
        error.port()?;
    }
    let mut alert = false;
    for round in 0..PINGS {
        match servos.ping(id) {
            Ok(error) => {
                test.answered += 1;
                add(&mut test.error_flags, error.names());
                alert |= error.has_alert();
                let surplus = servos.surplus();
                test.doubled += usize::from(servos.stragglers()? > 0 || surplus > 0);
            }
            Err(ServoError::NoResponse { .. }) => match servos.stragglers()? {
                0 => test.silent += 1,
                _ => test.late += 1,
            },
            Err(ServoError::Port(error)) => return Err(error),
            Err(ServoError::UnexpectedId { .. }) => test.unexpected_ids += 1,
            Err(ServoError::CorruptedRequest { .. }) => test.corrupted_requests += 1,
            // What is left is an answer that says nothing.
            Err(_) => test.garbled += 1,
        }
        // An absent servo need not be asked so often.
        if round == 2 && test.silent == 3 {
            test.silent = PINGS;
            break;
        }
    }
    if test.answered > 0 {
        test.readings = Some(read_test(servos, id)?);
    }
    if alert {
        // The alert says no more than that there is one; it comes with good data.
        match servos.hardware_errors(id) {
            Ok(names) => test.error_flags = names,
            Err(error) => drop(error.port()?),
        }
    }
    Ok(test)
}

/// Adds the names that are not there.
fn add(names: &mut Vec<&'static str>, more: Vec<&'static str>) {
    for name in more {
        if !names.contains(&name) {
            names.push(name);
        }
    }
}
