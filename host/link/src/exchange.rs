//! One request and its answer: waits in bounded time, tries again, finds out the protocol.

use super::port::{SerialLink, read_some};
use super::protocol::{Protocol, ServoRequest};
use super::reply::{Reading, is_answer, status};
use super::servo_error::{ServoError, ServoResult};
use super::servos::{LATE, Servos};
use super::status_error::StatusError;
use handstand_shared::dynamixel::{BROADCAST, ErrorBits};
use handstand_shared::dynamixel2::ErrorByte;
use handstand_shared::raw::ReturnDelay;
use std::time::Duration;

/// From the end of a request to an answer's first byte beside the return delay, and stalls inside
/// it (measured: 22 us and a motor interrupt of 130 us).
pub(super) const PROCESSING: Duration = Duration::from_micros(600);

impl<L: SerialLink> Servos<L> {
    /// The protocol that is spoken now.
    pub(super) fn current(&self) -> Protocol {
        self.protocol.unwrap_or(Protocol::One)
    }

    /// No complaint, in the protocol that is spoken now.
    pub(super) fn no_error(&self) -> StatusError {
        match self.current() {
            Protocol::One => StatusError::Flags(ErrorBits(0)),
            Protocol::Two => StatusError::Byte(ErrorByte(0)),
        }
    }

    /// The protocol, found out by a ping of servo `id` if no servo has answered yet.
    ///
    /// # Errors
    /// Why there is no good answer.
    pub fn detect(&mut self, id: u8) -> ServoResult<Protocol> {
        if self.protocol.is_none() {
            self.ping(id)?;
        }
        Ok(self.current())
    }

    pub(super) fn tell(&mut self, request: ServoRequest) -> ServoResult<StatusError> {
        self.send(BROADCAST, request)?;
        Ok(self.no_error())
    }

    pub(super) fn ask(&mut self, id: u8, request: ServoRequest) -> ServoResult<Reading> {
        let mut left = self.tries.max(1);
        loop {
            let answer = self.once(id, request);
            left -= 1;
            match answer {
                Err(failure) if left > 0 && failure.is_transient() => {
                    self.retries += 1;
                    // What is late must not be taken for the next answer.
                    self.link().pause(LATE);
                }
                answer => return answer,
            }
        }
    }

    /// One try. A silent servo is pinged in Protocol 2.0 as long as none has answered; if it
    /// answers, the request, whose addresses are of 1.0, is not sent again.
    pub(super) fn once(&mut self, id: u8, request: ServoRequest) -> ServoResult<Reading> {
        let answer = self.once_in(self.current(), id, request);
        match (&answer, self.protocol) {
            (Ok(_) | Err(ServoError::UnexpectedId { .. }), None) => {
                self.protocol = Some(Protocol::One);
            }
            (Err(ServoError::NoResponse { .. }), None) => {
                let other = self.once_in(Protocol::Two, id, ServoRequest::Ping);
                if other.is_ok() {
                    self.protocol = Some(Protocol::Two);
                    return match request {
                        ServoRequest::Ping => other,
                        _ => Err(ServoError::OtherProtocol { id }),
                    };
                }
            }
            _ => {}
        }
        answer
    }

    fn send(&mut self, id: u8, request: ServoRequest) -> ServoResult<Vec<u8>> {
        let packet = self.current().packet(id, request);
        self.link().send(&packet)?;
        Ok(packet)
    }

    /// Waits as long as line, return delay and lengths say, and no longer.
    fn once_in(
        &mut self,
        protocol: Protocol,
        id: u8,
        request: ServoRequest,
    ) -> ServoResult<Reading> {
        let echoes = self.echoes()?;
        self.link().clear()?;
        let sent = protocol.packet(id, request);
        self.link().send(&sent)?;
        let echo = if echoes { sent.len() } else { 0 };
        let delay = self.return_delay(id);
        let count = protocol.answer_bytes(request);
        let bytes = sent.len() + echo + protocol.status_length(count);
        let line = self.link().line_time(bytes);
        let deadline = self.link().now() + line + delay + PROCESSING + self.link().latency();
        let mut found = None;
        let bytes = read_some(self.link(), deadline, |bytes| {
            found = status(protocol, bytes.get(echo..).unwrap_or(&[]), id);
            matches!(&found, Some(it) if it.from == id && is_answer(&it.reading, count))
        })?;
        self.surplus = found.as_ref().map_or(0, |found| found.behind);
        match found.map(|found| (found.from, found.reading)) {
            Some((from, reading)) if from == id && reading.error.is_corrupted_request() => {
                Err(ServoError::CorruptedRequest { id })
            }
            Some((from, reading)) if from == id && is_answer(&reading, count) => Ok(reading),
            Some((from, _)) if from != id => Err(ServoError::UnexpectedId { id, from }),
            _ if bytes.len() <= echo => Err(ServoError::NoResponse { id }),
            _ => {
                let bytes = bytes.len();
                Err(ServoError::Garbled { id, bytes })
            }
        }
    }

    /// How long servo `id` waits before it answers, as far as it is known.
    pub(super) fn return_delay(&self, id: u8) -> Duration {
        let known = self.delays.get(&id).copied();
        let delay = known.unwrap_or(ReturnDelay::FACTORY);
        Duration::from_micros(u64::from(delay.to_us()))
    }
}
