//! Models of Protocol 1.0: how many codes their turn has, what a code of speed is worth, and the
//! registers in which they differ from the AX-12.
//!
//! Sources: ROBOTIS e-manual, "AX-12A", "AX-12W", "AX-18A", "RX-10" .. "RX-64", "EX-106+", "MX-12W",
//! "MX-28", "MX-64", "MX-106"; range and middle of the EX-106+, which its page gives as the RX's, by
//! ROBOTIS's dynamixel-workbench (`dynamixel_item.cpp`). Registers 0 to 9, 16, 24 and 30 to 43 are
//! the same in all of them.

use super::item::{Presence, Quantity};
use super::{Access, CCW_LIMIT, CW_LIMIT, GOAL_POSITION, Item, PRESENT_POSITION};
use super::{REGISTERS, Register};

/// Servos of Protocol 1.0 of one control table.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum OneFamily {
    /// AX.
    Ax,
    /// RX: the AX's table.
    Rx,
    /// EX: the AX's table, a drive mode and a current.
    Ex,
    /// MX with its first firmware: gains in place of compliance, and turns that are counted.
    Mx,
}

/// A servo model of Protocol 1.0.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OneModel {
    /// Its name.
    pub name: &'static str,
    /// Its model number, register 0.
    pub number: u16,
    /// Whose table it has.
    pub family: OneFamily,
    /// Codes of its range; the one in the middle is half of it.
    pub codes: u16,
    /// Its range, degrees.
    pub range_deg: f64,
    /// One code of a speed in joint mode, revolutions per minute.
    pub speed_lsb_rpm: f64,
    /// Whether it measures its current, and can be driven by torque (MX-64, MX-106).
    pub has_torque_mode: bool,
}

macro_rules! models {
    ($($name:literal $number:literal $family:ident $codes:literal $deg:literal $rpm:literal
        $torque:literal)*) => {
        /// Every model of Protocol 1.0 that is known.
        pub const ONE_MODELS: &[OneModel] = &[$(OneModel {
            name: $name, number: $number, family: OneFamily::$family, codes: $codes,
            range_deg: $deg, speed_lsb_rpm: $rpm, has_torque_mode: $torque,
        }),*];
    };
}

#[rustfmt::skip]
models! {
    // name    number  codes degrees rpm   torque mode
    "AX-12"      12 Ax 1024 300.0  0.111 false
    "AX-18"      18 Ax 1024 300.0  0.111 false
    "AX-12W"    300 Ax 1024 300.0  0.111 false
    "RX-10"      10 Rx 1024 300.0  0.111 false
    "RX-24F"     24 Rx 1024 300.0  0.111 false
    "RX-28"      28 Rx 1024 300.0  0.111 false
    "RX-64"      64 Rx 1024 300.0  0.111 false
    "EX-106+"   107 Ex 4096 250.92 0.111 false
    "MX-12W"    360 Mx 4096 360.0  0.916 false
    "MX-28"      29 Mx 4096 360.0  0.114 false
    "MX-64"     310 Mx 4096 360.0  0.114 true
    "MX-106"    320 Mx 4096 360.0  0.114 true
}

/// The AX-12, after which the others are told.
pub const AX_12: &OneModel = &ONE_MODELS[0];

/// The farthest goal of an MX in multi-turn mode, codes either way.
pub const MULTI_TURN_CODES: i32 = 28_672;

const fn row(
    name: &'static str,
    address: u16,
    size: u8,
    access: Access,
    min: i32,
    max: i32,
) -> Item {
    Item {
        name,
        address,
        size,
        is_signed: min < 0,
        is_eeprom: address < Register::RAM as u16,
        access,
        min,
        max,
        quantity: Quantity::Code,
        presence: Presence::All,
    }
}

/// EX-106+, MX-106: the second of two coupled servos.
pub const DRIVE_MODE: Item = row("drive mode", 10, 1, Access::Write, 0, 3);
/// MX: what is added to the position in multi-turn mode, codes.
pub const MULTI_TURN_OFFSET: Item = row("multi turn offset", 20, 2, Access::Write, -24_576, 24_576);
/// MX: turns' codes that make one code of the position in multi-turn mode.
pub const RESOLUTION_DIVIDER: Item = row("resolution divider", 22, 1, Access::Write, 1, 4);
/// MX-64, MX-106: whether torque is commanded, and no position.
pub const TORQUE_MODE: Item = row("torque control mode enable", 70, 1, Access::Write, 0, 1);

const MX_ROWS: [Item; 7] = [
    MULTI_TURN_OFFSET,
    RESOLUTION_DIVIDER,
    row("d gain", 26, 1, Access::Write, 0, 254),
    row("i gain", 27, 1, Access::Write, 0, 254),
    row("p gain", 28, 1, Access::Write, 0, 254),
    row("realtime tick", 50, 2, Access::Read, 0, 32_767),
    row("goal acceleration", 73, 1, Access::Write, 0, 254),
];
const TORQUE_ROWS: [Item; 3] = [
    row("current", 68, 2, Access::Read, 0, 4095),
    TORQUE_MODE,
    row("goal torque", 71, 2, Access::Write, 0, 2047),
];
const EX_ROWS: [Item; 2] = [
    DRIVE_MODE,
    row("sensed current", 56, 2, Access::Read, 0, 1023),
];
const MX_106_ROWS: [Item; 1] = [DRIVE_MODE];

impl OneModel {
    /// The model of this number.
    pub fn of(number: u16) -> Option<&'static OneModel> {
        ONE_MODELS.iter().find(|model| model.number == number)
    }

    /// Its registers, those of the AX-12 first.
    pub fn items(&self) -> impl Iterator<Item = Item> + '_ {
        let (mx, ex): (&[Item], &[Item]) = match (self.family, self.number) {
            (OneFamily::Mx, 320) => (&MX_ROWS, &MX_106_ROWS),
            (OneFamily::Mx, _) => (&MX_ROWS, &[]),
            (OneFamily::Ex, _) => (&[], &EX_ROWS),
            (OneFamily::Ax | OneFamily::Rx, _) => (&[], &[]),
        };
        let torque: &[Item] = if self.has_torque_mode {
            &TORQUE_ROWS
        } else {
            &[]
        };
        let own = REGISTERS.iter().filter_map(|register| self.item(*register));
        own.chain(mx.iter().chain(ex).chain(torque).copied())
    }

    /// The row of an AX-12's register in its table; none where it has no such one.
    pub fn item(&self, register: Register) -> Option<Item> {
        let item = Item::of_register(&register);
        let is_compliance = (26..=29).contains(&register.address);
        let last = i32::from(self.codes) - 1;
        let turns = self.family == OneFamily::Mx;
        match register {
            _ if is_compliance && turns => None,
            CW_LIMIT | CCW_LIMIT => Some(Item { max: last, ..item }),
            GOAL_POSITION | PRESENT_POSITION if turns => Some(Item {
                is_signed: true,
                min: -MULTI_TURN_CODES,
                max: MULTI_TURN_CODES,
                ..item
            }),
            GOAL_POSITION | PRESENT_POSITION => Some(Item { max: last, ..item }),
            _ => Some(item),
        }
    }

    /// Whether its codes of position are the AX-12's, which a CM-5's firmware goes by.
    pub fn has_ax_codes(&self) -> bool {
        (self.codes, self.range_deg) == (1024, 300.0)
    }

    /// Bits per second of a code of its baud rate register.
    pub fn baud_of(&self, code: u8) -> u32 {
        match (self.family, code) {
            (OneFamily::Mx, 250) => 2_250_000,
            (OneFamily::Mx, 251) => 2_500_000,
            (OneFamily::Mx, 252) => 3_000_000,
            _ => super::baud_of(code),
        }
    }
}

#[cfg(test)]
mod tests {
    extern crate std;

    use super::super::models::MODELS;
    use super::*;
    use std::vec::Vec;

    fn model(number: u16) -> &'static OneModel {
        OneModel::of(number).unwrap()
    }

    #[test]
    fn model_numbers_are_of_one_protocol_only() {
        for (place, model) in ONE_MODELS.iter().enumerate() {
            assert_eq!(OneModel::of(model.number), Some(model));
            let others = ONE_MODELS[..place].iter().map(|other| other.number);
            let mut others = others.chain(MODELS.iter().map(|other| other.number));
            assert!(
                others.all(|number| number != model.number),
                "{}",
                model.name
            );
        }
        assert_eq!(AX_12.number, 12);
        // An XL-320 speaks Protocol 2.0.
        assert_eq!(OneModel::of(350), None);
    }

    #[test]
    fn registers_of_each_model_do_not_overlap() {
        for model in ONE_MODELS {
            let mut items: Vec<Item> = model.items().collect();
            items.sort_by_key(|item| item.address);
            for pair in items.windows(2) {
                let end = pair[0].address + u16::from(pair[0].size);
                assert!(end <= pair[1].address, "{}: {}", model.name, pair[1].name);
            }
        }
    }

    /// The AX-12's rows are those that the firmware has, untouched.
    #[test]
    fn the_ax_12_has_its_own_table() {
        let rows: Vec<Item> = REGISTERS.iter().map(Item::of_register).collect();
        for number in [12, 18, 300, 10, 24, 28, 64] {
            assert!(model(number).items().eq(rows.iter().copied()), "{number}");
            assert!(model(number).has_ax_codes());
        }
    }

    #[test]
    fn an_mx_has_gains_turns_and_signed_positions() {
        let mx = model(29);
        let named = |name: &str| mx.items().find(|item| item.is_named(name));
        assert!(named("p gain").is_some() && named("cw compliance slope").is_none());
        assert!(named("current").is_none() && model(310).items().any(|i| i == TORQUE_MODE));
        let position = mx.item(PRESENT_POSITION).unwrap();
        assert_eq!(position.code(&[0xb8, 0xfb]), Some(-1096));
        assert_eq!(model(12).item(PRESENT_POSITION).unwrap().max, 1023);
        assert_eq!(model(107).item(GOAL_POSITION).unwrap().max, 4095);
        assert!(!mx.has_ax_codes() && !model(107).has_ax_codes());
        assert_eq!(
            (mx.baud_of(252), model(12).baud_of(1)),
            (3_000_000, 1_000_000)
        );
    }
}
