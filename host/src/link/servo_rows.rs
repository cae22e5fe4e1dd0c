//! The rows of a servo's control table, by its protocol and model.

use super::port::SerialLink;
use super::protocol::{Protocol, ServoRequest};
use super::servo_error::{ServoError, ServoResult};
use super::servos::Servos;
use handstand_shared::control_table::models::ServoModel;
use handstand_shared::control_table::x::{self, X_ITEMS};
use handstand_shared::control_table::{Item, PRESENT_SUPPLY, REGISTERS, Register};
use handstand_shared::dynamixel::BROADCAST;
use std::time::Duration;

/// Which servo of Protocol 2.0 it is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Identity {
    /// Model number.
    pub number: u16,
    /// The model; none of a number that is not known here.
    pub model: Option<&'static ServoModel>,
    /// Firmware version.
    pub firmware: u8,
}

impl Protocol {
    /// The row of an AX-12's register in a table of this protocol; none where it has no such one.
    pub fn item(self, register: Register) -> Option<Item> {
        match self {
            Protocol::One => Some(Item::of_register(&register)),
            Protocol::Two if register == PRESENT_SUPPLY => Some(x::PRESENT_VOLTAGE),
            Protocol::Two => X_ITEMS
                .iter()
                .find(|item| item.is_named(register.name))
                .copied(),
        }
    }
}

impl<L: SerialLink> Servos<L> {
    /// Who servo `id` of Protocol 2.0 is; asked once.
    ///
    /// # Errors
    /// Why there is no good answer.
    pub fn identify(&mut self, id: u8) -> ServoResult<Identity> {
        if let Some(known) = self.identities.get(&id) {
            return Ok(*known);
        }
        let reading = self.ask(id, ServoRequest::Ping)?;
        let [low, high, firmware] = reading.data[..] else {
            return Err(ServoError::Garbled {
                id,
                bytes: reading.data.len(),
            });
        };
        let number = u16::from_le_bytes([low, high]);
        let model = ServoModel::of(number);
        let identity = Identity {
            number,
            model,
            firmware,
        };
        self.identities.insert(id, identity);
        Ok(identity)
    }

    /// Every row of servo `id`'s control table.
    ///
    /// # Errors
    /// Why there is no good answer, or [`ServoError::UnknownModel`].
    pub fn items(&mut self, id: u8) -> ServoResult<Vec<Item>> {
        match self.detect(id)? {
            Protocol::One => Ok(REGISTERS.iter().map(Item::of_register).collect()),
            Protocol::Two => Ok(self.model(id)?.items().copied().collect()),
        }
    }

    /// The model of servo `id` of Protocol 2.0.
    ///
    /// # Errors
    /// Why there is no good answer, or [`ServoError::UnknownModel`].
    pub fn model(&mut self, id: u8) -> ServoResult<&'static ServoModel> {
        let Identity { number, model, .. } = self.identify(id)?;
        model.ok_or(ServoError::UnknownModel { id, number })
    }

    /// A row's code.
    ///
    /// # Errors
    /// Why there is no good answer.
    pub fn code(&mut self, id: u8, item: &Item) -> ServoResult<i32> {
        let reading = self.read(id, item.address, u16::from(item.size))?;
        let bytes = reading.data.len();
        item.code(&reading.data)
            .ok_or(ServoError::Garbled { id, bytes })
    }

    /// The servo's hardware errors in words (Protocol 2.0, register 70).
    ///
    /// # Errors
    /// Why there is no good answer.
    pub fn hardware_errors(&mut self, id: u8) -> ServoResult<Vec<&'static str>> {
        let status = self.code(id, &x::HARDWARE_ERROR)?;
        Ok(x::hardware_errors(status as u8).collect())
    }

    /// Restarts a servo of Protocol 2.0, the only way to torque again after a hardware error; waits
    /// until it answers.
    ///
    /// # Errors
    /// It does not answer before or after.
    pub fn reboot(&mut self, id: u8) -> ServoResult<()> {
        // How long it takes is not published.
        const PATIENCE: u32 = 20;
        match self.once(id, ServoRequest::Reboot) {
            Err(error) if !error.is_transient() => return Err(error),
            // Its answer may be lost: what counts is that it comes back.
            _ => {}
        }
        for _ in 0..PATIENCE {
            self.link().pause(Duration::from_millis(100));
            if self.ping(id).is_ok() {
                return Ok(());
            }
        }
        Err(ServoError::NoResponse { id })
    }

    /// The ids of all servos of Protocol 2.0 that answer a broadcast ping.
    ///
    /// # Errors
    /// The port failed.
    pub fn ping_all(&mut self) -> ServoResult<Vec<u8>> {
        /// Each id has a slot of its own, as ROBOTIS's SDK waits for them.
        const SLOT: Duration = Duration::from_millis(3);
        self.echoes()?;
        self.link().clear()?;
        let packet = Protocol::Two.packet(BROADCAST, ServoRequest::Ping);
        self.link().send(&packet)?;
        let line = self.link().line_time(253 * Protocol::Two.status_length(3));
        let deadline = self.link().now() + line + 253 * SLOT + self.link().latency();
        let bytes = super::port::read_some(self.link(), deadline, |_| false)?;
        let found = super::reply::statuses(&bytes);
        let mut ids: Vec<u8> = found.iter().map(|(id, _)| *id).collect();
        ids.sort_unstable();
        ids.dedup();
        Ok(ids)
    }
}
