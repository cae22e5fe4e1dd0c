//! Communicate with servos: requests, replies in bounded time, retries.

use super::port::{SerialLink, read_some};
use super::protocol::{Protocol, ServoRequest, emergency_packet, outlasting_answers};
use super::reply::Reading;
use super::servo_error::{ServoError, ServoResult};
use super::servo_rows::Identity;
use super::status_error::StatusError;
use handstand_shared::control_table::{Item, RETURN_DELAY, Register};
use handstand_shared::dynamixel::{BROADCAST, ErrorBits};
use handstand_shared::dynamixel2::ErrorByte;
use handstand_shared::raw::ReturnDelay;
use std::collections::BTreeMap;
use std::time::Duration;

/// How late an answer may be that was given up.
pub(super) const LATE: Duration = Duration::from_millis(2);
/// EEPROM makes a servo deaf for about 6 ms per byte.
const EEPROM_BYTE: Duration = Duration::from_millis(7);

/// Servos behind a line that passes Dynamixel packets, all of one protocol.
pub struct Servos<L> {
    link: L,
    /// How often a request is sent at most.
    pub tries: u8,
    /// Requests sent again so far.
    pub retries: u64,
    /// The servos' protocol; none until it is set or a servo has answered.
    pub protocol: Option<Protocol>,
    pub(super) delays: BTreeMap<u8, ReturnDelay>,
    pub(super) identities: BTreeMap<u8, Identity>,
    /// Whether the adapter hears itself; unknown before the first request.
    echo: Option<bool>,
    /// Bytes that came with the last answer, behind it.
    pub(super) surplus: usize,
}

impl<L: SerialLink> Servos<L> {
    /// Over this line, three tries each. The protocol is the first servo's that answers: it is
    /// asked in 1.0, and in 2.0 where it is silent.
    pub fn new(link: L) -> Self {
        Servos {
            link,
            tries: 3,
            retries: 0,
            protocol: None,
            delays: BTreeMap::new(),
            identities: BTreeMap::new(),
            echo: None,
            surplus: 0,
        }
    }

    /// The line.
    pub fn link(&mut self) -> &mut L {
        &mut self.link
    }

    /// Ping the servo; returns what it complains of.
    ///
    /// # Errors
    /// Why there is no good answer.
    pub fn ping(&mut self, id: u8) -> ServoResult<StatusError> {
        self.ask(id, ServoRequest::Ping)
            .map(|reading| reading.error)
    }

    /// `count` bytes from `address` on.
    ///
    /// # Errors
    /// Why there is no good answer.
    pub fn read(&mut self, id: u8, address: u16, count: u16) -> ServoResult<Reading> {
        let reading = self.ask(id, ServoRequest::Read { address, count })?;
        let error = reading.error;
        if reading.data.len() == usize::from(count) {
            Ok(reading)
        } else {
            Err(ServoError::Refused { id, error })
        }
    }

    /// The row of an AX-12's register in servo `id`'s table.
    ///
    /// # Errors
    /// [`ServoError::NoRegister`], [`ServoError::UnknownModel`], or why the servo's model is not
    /// told.
    pub fn item(&mut self, id: u8, register: Register) -> ServoResult<Item> {
        let name = register.name;
        let item = self.known_model(id)?.item(register);
        item.ok_or(ServoError::NoRegister { id, name })
    }

    /// Code of a register that all servos have.
    ///
    /// # Errors
    /// As [`Servos::item`], or why there is no good answer.
    pub fn get(&mut self, id: u8, register: Register) -> ServoResult<u16> {
        let item = self.item(id, register)?;
        let code = self.code(id, &item)?;
        if register == RETURN_DELAY {
            self.delays.insert(id, ReturnDelay(code as u8));
        }
        Ok(code as u16)
    }

    /// Sets a register that all servos have, as [`Servos::set_code`] does.
    ///
    /// # Errors
    /// As [`Servos::set_code`].
    pub fn set(&mut self, id: u8, register: Register, code: u16) -> ServoResult<()> {
        let item = self.item(id, register)?;
        self.set_code(id, &item, i32::from(code))
    }

    /// Sets a register and reads it back, whatever the status level says; waits while EEPROM is
    /// written.
    ///
    /// # Errors
    /// Why there is no good answer, or [`ServoError::Refused`] if the register kept another code.
    pub fn set_code(&mut self, id: u8, item: &Item, code: i32) -> ServoResult<()> {
        let mut left = self.tries;
        loop {
            let error = self.write(id, item, code)?;
            // Its id is what it is asked by.
            let now = if item.is_named(handstand_shared::control_table::ID.name) {
                code as u8
            } else {
                id
            };
            let kept = self.code(now, item);
            left -= 1;
            match kept {
                Ok(kept) if kept == code => return Ok(()),
                Ok(_) if error.is_access() && item.is_eeprom => {
                    let name = item.name;
                    return Err(ServoError::Locked { id, name });
                }
                Ok(_) if error.may_refuse() => return Err(ServoError::Refused { id, error }),
                Ok(_) if left == 0 => {
                    let error = match error {
                        StatusError::Flags(_) => StatusError::Flags(ErrorBits::RANGE),
                        StatusError::Byte(_) => StatusError::Byte(ErrorByte(4)),
                    };
                    return Err(ServoError::Refused { id, error });
                }
                Err(failure) if left == 0 || !failure.is_transient() => return Err(failure),
                Ok(_) | Err(_) => self.retries += 1,
            }
        }
    }

    /// Sends a register once without expecting an answer; what the servo complains of if one comes.
    ///
    /// # Errors
    /// [`ServoError::Port`] only.
    pub fn write(&mut self, id: u8, item: &Item, code: i32) -> ServoResult<StatusError> {
        let bytes = item.bytes(code);
        let data = &bytes[..usize::from(item.size)];
        let address = item.address;
        let request = ServoRequest::Write { address, data };
        let answer = if id == BROADCAST {
            self.tell(request)
        } else {
            self.once(id, request).map(|reading| reading.error)
        };
        if item.is_eeprom {
            self.link.pause(EEPROM_BYTE * u32::from(item.size));
        }
        match answer {
            Ok(error) => Ok(error),
            Err(ServoError::Port(error)) => Err(ServoError::Port(error)),
            Err(_) => Ok(self.no_error()),
        }
    }

    /// Set a register that all servos have of several of them in one packet, which is not answered.
    ///
    /// # Errors
    /// [`ServoError::Port`] only, or [`ServoError::NoRegister`].
    pub fn sync_write(&mut self, register: Register, codes: &[(u8, u16)]) -> ServoResult<()> {
        let Some((id, _)) = codes.first() else {
            return Ok(());
        };
        let item = self.item(*id, register)?;
        let codes: Vec<(u8, i32)> = (codes.iter())
            .map(|(id, code)| (*id, i32::from(*code)))
            .collect();
        self.sync_write_codes(&item, &codes)
    }

    /// Set a row of several servos in one packet, which is not answered.
    ///
    /// # Errors
    /// [`ServoError::Port`] only.
    pub fn sync_write_codes(&mut self, item: &Item, codes: &[(u8, i32)]) -> ServoResult<()> {
        let width = item.size;
        let block = |(id, code): &(u8, i32)| {
            let bytes = item.bytes(*code);
            std::iter::once(*id)
                .chain(bytes.into_iter().take(usize::from(width)))
                .collect::<Vec<_>>()
        };
        // The length of a packet of Protocol 1.0 is one byte.
        for codes in codes.chunks(60) {
            let blocks: Vec<u8> = codes.iter().flat_map(block).collect();
            self.tell(ServoRequest::SyncWrite {
                address: item.address,
                width,
                blocks: &blocks,
            })?;
        }
        Ok(())
    }

    /// Torque off, everywhere. Twice, for a broadcast is not answered, and what is asked before it
    /// may be while the first is said.
    ///
    /// # Errors
    /// [`ServoError::Port`] only.
    pub fn torque_off(&mut self) -> ServoResult<()> {
        // Without an answer so far either protocol may be the servos'.
        let protocols = match self.protocol {
            Some(protocol) => vec![protocol],
            None => vec![Protocol::One, Protocol::Two],
        };
        let off: Vec<u8> = protocols.into_iter().flat_map(emergency_packet).collect();
        let idle = outlasting_answers(self.link.baud());
        for bytes in [&off, &idle, &off] {
            self.link.send(bytes)?;
        }
        Ok(())
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

    /// Bytes that came with the last answer and behind it, as of a second servo of its id.
    pub fn surplus(&self) -> usize {
        self.surplus
    }

    /// Bytes that come after an answer was given up.
    ///
    /// # Errors
    /// The port failed.
    pub fn stragglers(&mut self) -> ServoResult<usize> {
        let length = self.current().status_length(0);
        let deadline = self.link.now() + LATE + self.link.line_time(length);
        Ok(read_some(&mut self.link, deadline, |_| false)?.len())
    }
}
