//! The rows of a servo's control table, by its protocol and model.

use super::port::SerialLink;
use super::protocol::{Protocol, ServoRequest};
use super::servo_error::{ServoError, ServoResult};
use super::servos::Servos;
use handstand_shared::control_table::models::ServoModel;
use handstand_shared::control_table::one::OneModel;
use handstand_shared::control_table::x::{self, X_ITEMS};
use handstand_shared::control_table::{Item, PRESENT_SUPPLY, Register};
use handstand_shared::dynamixel::BROADCAST;
use handstand_shared::raw::ReturnDelay;
use std::time::Duration;

/// A model whose control table is known.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Model {
    /// Of Protocol 1.0.
    One(&'static OneModel),
    /// Of Protocol 2.0.
    Two(&'static ServoModel),
}

impl Model {
    /// The model of this number among those of a protocol.
    pub fn of(protocol: Protocol, number: u16) -> Option<Model> {
        match protocol {
            Protocol::One => OneModel::of(number).map(Model::One),
            Protocol::Two => ServoModel::of(number).map(Model::Two),
        }
    }

    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Model::One(model) => model.name,
            Model::Two(model) => model.name,
        }
    }

    /// Its registers, by address.
    pub fn items(self) -> Vec<Item> {
        let mut items: Vec<Item> = match self {
            Model::One(model) => model.items().collect(),
            Model::Two(model) => model.items().copied().collect(),
        };
        items.sort_by_key(|item| item.address);
        items
    }

    /// The row of an AX-12's register in its table; none where it has no such one.
    pub fn item(self, register: Register) -> Option<Item> {
        match self {
            Model::One(model) => model.item(register),
            Model::Two(model) => Protocol::Two.item(register).filter(|item| model.has(item)),
        }
    }
}

/// Which servo it is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Identity {
    /// Model number.
    pub number: u16,
    /// The model; none of a number that is not known here.
    pub model: Option<Model>,
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
    /// Who servo `id` is; asked once.
    ///
    /// # Errors
    /// Why there is no good answer.
    pub fn identify(&mut self, id: u8) -> ServoResult<Identity> {
        if let Some(known) = self.identities.get(&id) {
            return Ok(*known);
        }
        let protocol = self.detect(id)?;
        let data = match protocol {
            // Every servo of Protocol 1.0 has model number, firmware version, id, baud rate and
            // return delay at these addresses.
            Protocol::One => self.read(id, 0, 6)?.data,
            Protocol::Two => self.ask(id, ServoRequest::Ping)?.data,
        };
        let bytes = data.len();
        let [low, high, firmware, rest @ ..] = &data[..] else {
            return Err(ServoError::Garbled { id, bytes });
        };
        let number = u16::from_le_bytes([*low, *high]);
        let identity = Identity {
            number,
            model: Model::of(protocol, number),
            firmware: *firmware,
        };
        if let ([_, _, delay], Some(_)) = (rest, identity.model) {
            self.delays.insert(id, ReturnDelay(*delay));
        }
        self.identities.insert(id, identity);
        Ok(identity)
    }

    /// The model of servo `id`, of either protocol.
    ///
    /// # Errors
    /// Why there is no good answer, or [`ServoError::UnknownModel`].
    pub fn known_model(&mut self, id: u8) -> ServoResult<Model> {
        let Identity { number, model, .. } = self.identify(id)?;
        model.ok_or(ServoError::UnknownModel { id, number })
    }

    /// Every row of servo `id`'s control table.
    ///
    /// # Errors
    /// Why there is no good answer, or [`ServoError::UnknownModel`].
    pub fn items(&mut self, id: u8) -> ServoResult<Vec<Item>> {
        Ok(self.known_model(id)?.items())
    }

    /// The model of servo `id` of Protocol 2.0.
    ///
    /// # Errors
    /// Why there is no good answer, [`ServoError::UnknownModel`], or
    /// [`ServoError::OtherProtocol`].
    pub fn model(&mut self, id: u8) -> ServoResult<&'static ServoModel> {
        match self.known_model(id)? {
            Model::Two(model) => Ok(model),
            Model::One(_) => Err(ServoError::OtherProtocol { id }),
        }
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
    /// Why there is no good answer, or [`ServoError::UnknownModel`].
    pub fn hardware_errors(&mut self, id: u8) -> ServoResult<Vec<&'static str>> {
        self.model(id)?;
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

    /// The ids of all servos of Protocol 2.0 that answer a broadcast ping, and how many bytes came
    /// that belong to none of their answers: two servos of one id, or noise.
    ///
    /// # Errors
    /// The port failed.
    pub fn ping_all(&mut self) -> ServoResult<(Vec<u8>, usize)> {
        /// Each id has a slot of its own, as ROBOTIS's SDK waits for them.
        const SLOT: Duration = Duration::from_millis(3);
        let echoes = self.echoes()?;
        self.link().clear()?;
        let packet = Protocol::Two.packet(BROADCAST, ServoRequest::Ping);
        self.link().send(&packet)?;
        let line = self.link().line_time(253 * Protocol::Two.status_length(3));
        let deadline = self.link().now() + line + 253 * SLOT + self.link().latency();
        let bytes = super::port::read_some(self.link(), deadline, |_| false)?;
        let found = super::reply::statuses(&bytes);
        let sound: usize = (found.iter())
            .map(|(_, reading)| Protocol::Two.status_length(reading.data.len()))
            .sum();
        let echo = if echoes { packet.len() } else { 0 };
        let strays = bytes.len().saturating_sub(echo + sound);
        let mut ids: Vec<u8> = found.iter().map(|(id, _)| *id).collect();
        ids.sort_unstable();
        ids.dedup();
        Ok((ids, strays))
    }
}
