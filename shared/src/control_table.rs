//! Control tables, one row per register: the AX-12's here, those of X series and MX(2.0) in [`x`];
//! the models that have them in [`one`] (Protocol 1.0) and [`models`] (2.0). Source: ROBOTIS AX-12
//! e-manual.
//!
//! The AX-12's rows are as narrow as its protocol, for the CM-5's firmware holds them; a program on
//! the PC takes all rows as [`Item`]s.

mod item;
pub mod models;
pub mod one;
pub mod x;

pub use item::{
    Item, POSITION_CENTRE, POSITION_LSB_RAD, Presence, Quantity, SPEED_LSB_RAD_S, WATCHDOG_LSB_MS,
};

/// Who may change a register.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Access {
    /// The servo only.
    Read,
    /// The bus as well.
    Write,
}

/// One register of one or two bytes, the lower byte first.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Register {
    /// Its name in words, as the manual has it.
    pub name: &'static str,
    /// Address of its (lower) byte.
    pub address: u8,
    /// Bytes: 1 or 2.
    pub size: u8,
    /// Who may change it.
    pub access: Access,
    /// Smallest code the servo takes.
    pub min: u16,
    /// Largest code the servo takes.
    pub max: u16,
    /// Code after a reset to factory settings (EEPROM) or at power-on (RAM).
    pub default: u16,
}

impl Register {
    /// Where RAM begins; what lies below is kept in EEPROM.
    pub const RAM: u8 = 24;

    /// Kept without power? Writing it silences the servo for about 6 ms per byte.
    pub const fn is_eeprom(&self) -> bool {
        self.address < Self::RAM
    }

    /// The register at this very address.
    pub fn at(address: u8) -> Option<&'static Register> {
        REGISTERS.iter().find(|r| r.address == address)
    }

    /// The register of this name; spaces, `_` and `-` are one.
    pub fn named(name: &str) -> Option<&'static Register> {
        let plain = |c: u8| {
            if c == b'_' || c == b'-' {
                b' '
            } else {
                c.to_ascii_lowercase()
            }
        };
        REGISTERS
            .iter()
            .find(|r| r.name.bytes().eq(name.bytes().map(plain)))
    }
}

macro_rules! registers {
    ($($NAME:ident $address:literal $size:literal $access:ident $min:literal $max:literal $default:literal $name:literal)*) => {
        $(#[doc = concat!("Register ", $address, ", ", $name, ".")]
        pub const $NAME: Register = Register {
            name: $name, address: $address, size: $size, access: Access::$access,
            min: $min, max: $max, default: $default,
        };)*

        /// Every register, by address.
        pub const REGISTERS: &[Register] = &[$($NAME),*];
    };
}

#[rustfmt::skip]
registers! {
    // name              at  size  access  min  max  default
    MODEL                 0  2     Read     0  65535    12  "model number"
    FIRMWARE              2  1     Read     0    255    24  "firmware version"
    ID                    3  1     Write    0    253     1  "id"
    BAUD                  4  1     Write    0    254     1  "baud rate"
    RETURN_DELAY          5  1     Write    0    254   250  "return delay time"
    CW_LIMIT              6  2     Write    0   1023     0  "cw angle limit"
    CCW_LIMIT             8  2     Write    0   1023  1023  "ccw angle limit"
    MAX_TEMPERATURE      11  1     Write    0    150    70  "highest temperature"
    MIN_SUPPLY           12  1     Write   50    250    60  "lowest voltage"
    MAX_SUPPLY           13  1     Write   50    250   140  "highest voltage"
    MAX_TORQUE           14  2     Write    0   1023  1023  "max torque"
    STATUS_LEVEL         16  1     Write    0      2     2  "status return level"
    ALARM_LED            17  1     Write    0    127    36  "alarm led"
    SHUTDOWN             18  1     Write    0    127    36  "alarm shutdown"
    TORQUE_ENABLE        24  1     Write    0      1     0  "torque enable"
    LED                  25  1     Write    0      1     0  "led"
    CW_MARGIN            26  1     Write    0    254     1  "cw compliance margin"
    CCW_MARGIN           27  1     Write    0    254     1  "ccw compliance margin"
    CW_SLOPE             28  1     Write    1    254    32  "cw compliance slope"
    CCW_SLOPE            29  1     Write    1    254    32  "ccw compliance slope"
    GOAL_POSITION        30  2     Write    0   1023     0  "goal position"
    MOVING_SPEED         32  2     Write    0   2047     0  "moving speed"
    TORQUE_LIMIT         34  2     Write    0   1023  1023  "torque limit"
    PRESENT_POSITION     36  2     Read     0   1023     0  "present position"
    PRESENT_SPEED        38  2     Read     0   2047     0  "present speed"
    PRESENT_LOAD         40  2     Read     0   2047     0  "present load"
    PRESENT_SUPPLY       42  1     Read     0    255     0  "present voltage"
    PRESENT_TEMPERATURE  43  1     Read     0    255     0  "present temperature"
    REGISTERED           44  1     Write    0      1     0  "registered instruction"
    MOVING               46  1     Read     0      1     0  "moving"
    LOCK                 47  1     Write    0      1     0  "lock"
    PUNCH                48  2     Write    0   1023    32  "punch"
}

/// Bits per second of a code of the baud rate register.
pub fn baud_of(code: u8) -> u32 {
    2_000_000 / (u32::from(code) + 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn registers_are_in_order_and_do_not_overlap() {
        for pair in REGISTERS.windows(2) {
            assert!(
                pair[0].address + pair[0].size <= pair[1].address,
                "{}",
                pair[1].name
            );
        }
        for r in REGISTERS {
            assert!(r.min <= r.max && r.default <= r.max && (1..=2).contains(&r.size));
            assert_eq!(Register::at(r.address), Some(r));
            assert_eq!(Register::named(r.name), Some(r));
        }
    }

    #[test]
    fn names_are_found_however_they_are_spelt() {
        assert_eq!(Register::named("Return_Delay-time"), Some(&RETURN_DELAY));
        assert_eq!(Register::named("return"), None);
        assert!(RETURN_DELAY.is_eeprom() && !TORQUE_ENABLE.is_eeprom());
    }

    #[test]
    fn the_factory_baud_is_one_megabit() {
        assert_eq!(baud_of(BAUD.default as u8), 1_000_000);
    }
}
