//! Communicate with servos: requests, replies in bounded time, retries.

use super::port::{SerialLink, read_some};
use super::reply::{Reading, is_answer, status};
use super::servo_error::{ServoError, ServoResult};
use handstand_shared::control_table::{RETURN_DELAY, Register, TORQUE_ENABLE};
use handstand_shared::dynamixel::{BROADCAST, ErrorBits, MAX_PACKET, Request, status_length};
use handstand_shared::raw::ReturnDelay;
use std::collections::BTreeMap;
use std::time::Duration;

/// From the end of a request to an answer's first byte beside the return delay, and stalls inside
/// it (measured: 22 us and a motor interrupt of 130 us).
const PROCESSING: Duration = Duration::from_micros(600);
/// How late an answer may be that was given up.
const LATE: Duration = Duration::from_millis(2);
/// EEPROM makes a servo deaf for about 6 ms per byte.
const EEPROM_BYTE: Duration = Duration::from_millis(7);

/// Servos behind a line that passes Dynamixel packets.
pub struct Servos<L> {
    link: L,
    /// How often a request is sent at most.
    pub tries: u8,
    /// Requests sent again so far.
    pub retries: u64,
    delays: BTreeMap<u8, ReturnDelay>,
    /// Whether the adapter hears itself; unknown before the first request.
    echo: Option<bool>,
}

impl<L: SerialLink> Servos<L> {
    /// Over this line, three tries each.
    pub fn new(link: L) -> Self {
        Servos {
            link,
            tries: 3,
            retries: 0,
            delays: BTreeMap::new(),
            echo: None,
        }
    }

    /// The line.
    pub fn link(&mut self) -> &mut L {
        &mut self.link
    }

    /// Ping the servo; returns its error flags.
    ///
    /// # Errors
    /// Why there is no good answer.
    pub fn ping(&mut self, id: u8) -> ServoResult<ErrorBits> {
        self.ask(id, &Request::Ping, 0).map(|reading| reading.error)
    }

    /// `count` bytes from `address` on.
    ///
    /// # Errors
    /// Why there is no good answer.
    pub fn read(&mut self, id: u8, address: u8, count: u8) -> ServoResult<Reading> {
        let reading = self.ask(id, &Request::Read { address, count }, count)?;
        match reading.data.len() == usize::from(count) {
            true => Ok(reading),
            false => Err(ServoError::Refused {
                id,
                flags: reading.error,
            }),
        }
    }

    /// A register's code.
    ///
    /// # Errors
    /// Why there is no good answer.
    pub fn get(&mut self, id: u8, register: Register) -> ServoResult<u16> {
        let code = self.read(id, register.address, register.size)?.code();
        if register == RETURN_DELAY {
            self.delays.insert(id, ReturnDelay(code as u8));
        }
        Ok(code)
    }

    /// Sets a register and reads it back, whatever the status level says; waits while EEPROM is
    /// written.
    ///
    /// # Errors
    /// Why there is no good answer, or [`ServoError::Refused`] if the register kept another code.
    pub fn set(&mut self, id: u8, register: Register, code: u16) -> ServoResult<()> {
        let mut left = self.tries;
        loop {
            let error = self.write(id, register, code)?;
            // Its id is what it is asked by.
            let now = if register == handstand_shared::control_table::ID {
                code as u8
            } else {
                id
            };
            let kept = self.get(now, register);
            left -= 1;
            match kept {
                Ok(kept) if kept == code => return Ok(()),
                Ok(_) if error != ErrorBits(0) => {
                    return Err(ServoError::Refused { id, flags: error });
                }
                Ok(_) if left == 0 => {
                    let flags = ErrorBits::RANGE;
                    return Err(ServoError::Refused { id, flags });
                }
                Err(failure) if left == 0 || !failure.is_transient() => return Err(failure),
                Ok(_) | Err(_) => self.retries += 1,
            }
        }
    }

    /// Sends a register once without expecting an answer; the error bits if one comes.
    ///
    /// # Errors
    /// [`ServoError::Port`] only.
    pub fn write(&mut self, id: u8, register: Register, code: u16) -> ServoResult<ErrorBits> {
        let bytes = code.to_le_bytes();
        let data = &bytes[..usize::from(register.size)];
        let request = Request::Write {
            address: register.address,
            data,
        };
        let answer = if id == BROADCAST {
            self.tell(&request)
        } else {
            self.once(id, &request, 0).map(|reading| reading.error)
        };
        if register.is_eeprom() {
            self.link.pause(EEPROM_BYTE * u32::from(register.size));
        }
        match answer {
            Ok(error) => Ok(error),
            Err(ServoError::Port(error)) => Err(ServoError::Port(error)),
            Err(_) => Ok(ErrorBits(0)),
        }
    }

    /// Set a register of several servos in one packet, which is not answered.
    ///
    /// # Errors
    /// [`ServoError::Port`] only.
    pub fn sync_write(&mut self, register: Register, codes: &[(u8, u16)]) -> ServoResult<()> {
        let width = register.size;
        let block = |(id, code): &(u8, u16)| {
            let bytes = code.to_le_bytes();
            std::iter::once(*id)
                .chain(bytes.into_iter().take(usize::from(width)))
                .collect::<Vec<_>>()
        };
        // A packet's length is one byte.
        for codes in codes.chunks(60) {
            let blocks: Vec<u8> = codes.iter().flat_map(block).collect();
            self.tell(&Request::SyncWrite {
                address: register.address,
                width,
                blocks: &blocks,
            })?;
        }
        Ok(())
    }

    /// Torque off, everywhere. Twice, for a broadcast is not answered.
    ///
    /// # Errors
    /// [`ServoError::Port`] only.
    pub fn torque_off(&mut self) -> ServoResult<()> {
        for _ in 0..2 {
            self.write(BROADCAST, TORQUE_ENABLE, 0)?;
        }
        Ok(())
    }

    fn tell(&mut self, request: &Request) -> ServoResult<ErrorBits> {
        self.send(BROADCAST, request)?;
        Ok(ErrorBits(0))
    }

    fn ask(&mut self, id: u8, request: &Request, count: u8) -> ServoResult<Reading> {
        let mut left = self.tries.max(1);
        loop {
            let answer = self.once(id, request, count);
            left -= 1;
            match answer {
                Err(failure) if left > 0 && failure.is_transient() => {
                    self.retries += 1;
                    // What is late must not be taken for the next answer.
                    self.link.pause(LATE);
                }
                answer => return answer,
            }
        }
    }

    fn send(&mut self, id: u8, request: &Request) -> ServoResult<Vec<u8>> {
        let mut out = [0; MAX_PACKET];
        let length = request.emit(id, &mut out).unwrap_or(0);
        self.link.send(&out[..length])?;
        Ok(out[..length].to_vec())
    }

    /// Whether the adapter sends back what it is sent. A PING and the answer of a servo with a
    /// supply error are the same bytes, so this must be known first: two bytes that no servo and no
    /// controller heeds tell.
    ///
    /// # Errors
    /// [`ServoError::Port`] only.
    pub fn echoes(&mut self) -> ServoResult<bool> {
        if let Some(echo) = self.echo {
            return Ok(echo);
        }
        const PROBE: [u8; 2] = [0x55, 0x2a];
        self.link.clear()?;
        self.link.send(&PROBE)?;
        let deadline = self.link.now() + self.link.line_time(2 * PROBE.len()) + self.link.latency();
        let heard = read_some(&mut self.link, deadline, |bytes| bytes.ends_with(&PROBE))?;
        Ok(*self.echo.insert(heard.ends_with(&PROBE)))
    }

    /// Bytes that come after an answer was given up.
    ///
    /// # Errors
    /// The port failed.
    pub fn stragglers(&mut self) -> ServoResult<usize> {
        let deadline = self.link.now() + LATE + self.link.line_time(status_length(0));
        Ok(read_some(&mut self.link, deadline, |_| false)?.len())
    }

    /// One request and its answer: waits as long as line, return delay and lengths say, and no
    /// longer.
    fn once(&mut self, id: u8, request: &Request, count: u8) -> ServoResult<Reading> {
        let echoes = self.echoes()?;
        self.link.clear()?;
        let sent = self.send(id, request)?;
        let echo = if echoes { sent.len() } else { 0 };
        let delay = self
            .delays
            .get(&id)
            .copied()
            .unwrap_or(ReturnDelay::FACTORY);
        let delay = Duration::from_micros(u64::from(delay.to_us()));
        let line = self
            .link
            .line_time(sent.len() + echo + status_length(count));
        let deadline = self.link.now() + line + delay + PROCESSING + self.link.latency();
        let mut found = None;
        let bytes = read_some(&mut self.link, deadline, |bytes| {
            found = status(bytes.get(echo..).unwrap_or(&[]), id);
            matches!(&found, Some((from, reading)) if *from == id && is_answer(reading, count))
        })?;
        match found {
            Some((from, reading)) if from == id && reading.error.has(ErrorBits::CHECKSUM) => {
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
}
