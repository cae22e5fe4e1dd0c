//! A row of any servo's control table, with what its codes mean.

use super::{Access, Register};
use core::f64::consts::PI;

/// What a register's codes measure; [`Quantity::si`] gives a code's value.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Quantity {
    /// A number, a choice or bits.
    Code,
    /// An angle from the middle of the turn, 2048 codes; 4096 codes a turn.
    Position,
    /// An angle without a zero of its own: limits, offsets and windows.
    Angle,
    /// 0.229 revolutions per minute.
    Speed,
    /// 214.577 revolutions per minute squared.
    Acceleration,
    /// A code of the model's own, A.
    Current,
    /// 0.1 % of full output.
    Load,
    /// Full output is 885.
    Pwm,
    /// 0.1 V.
    Voltage,
    /// 1 degree Celsius.
    Temperature,
    /// 1 ms.
    Milliseconds,
    /// 2 us.
    ReturnDelay,
    /// 20 ms.
    Watchdog,
}

/// One code of a position, rad.
pub const POSITION_LSB_RAD: f64 = 2.0 * PI / 4096.0;
/// The code in the middle of the turn: 0 rad.
pub const POSITION_CENTRE: i32 = 2048;
/// One code of a speed, rad/s. ROBOTIS's model files have 0.0239691, 0.05 % less.
pub const SPEED_LSB_RAD_S: f64 = 0.229 * 2.0 * PI / 60.0;
/// One code of the bus watchdog, ms.
pub const WATCHDOG_LSB_MS: u32 = 20;

impl Quantity {
    /// Value of a code in SI and its unit; none of a plain code. `current_lsb_a` is the model's.
    pub fn si(self, code: i32, current_lsb_a: Option<f64>) -> Option<(f64, &'static str)> {
        let number = f64::from(code);
        Some(match self {
            Quantity::Code => return None,
            Quantity::Position => (f64::from(code - POSITION_CENTRE) * POSITION_LSB_RAD, "rad"),
            Quantity::Angle => (number * POSITION_LSB_RAD, "rad"),
            Quantity::Speed => (number * SPEED_LSB_RAD_S, "rad/s"),
            Quantity::Acceleration => (number * 214.577 * 2.0 * PI / 3600.0, "rad/s^2"),
            Quantity::Current => (number * current_lsb_a?, "A"),
            Quantity::Load => (number * 1e-3, "of full output"),
            Quantity::Pwm => (number / 885.0, "of full output"),
            Quantity::Voltage => (number * 0.1, "V"),
            Quantity::Temperature => (number, "degC"),
            Quantity::Milliseconds => (number * 1e-3, "s"),
            Quantity::ReturnDelay => (number * 2e-6, "s"),
            Quantity::Watchdog => (number * 1e-3 * f64::from(WATCHDOG_LSB_MS), "s"),
        })
    }
}

/// Which servos of a family have a register.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Presence {
    /// All of them.
    All,
    /// Those that measure or limit current.
    Current,
    /// Those that infer a load instead.
    Load,
    /// The X330 only.
    X330,
    /// The MX only.
    Mx,
}

/// One register of one, two or four bytes, the lowest byte first.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Item {
    /// Its name in words, as the manual has it.
    pub name: &'static str,
    /// Address of its lowest byte.
    pub address: u16,
    /// Bytes: 1, 2 or 4.
    pub size: u8,
    /// Whether its codes are two's complement.
    pub is_signed: bool,
    /// Kept without power? Then it can be written only while torque is off.
    pub is_eeprom: bool,
    /// Who may change it.
    pub access: Access,
    /// Smallest code the servo takes.
    pub min: i32,
    /// Largest code the servo takes; the servo's own limits may be closer.
    pub max: i32,
    /// What its codes measure.
    pub quantity: Quantity,
    /// Which servos have it.
    pub presence: Presence,
}

impl Item {
    /// A row of the AX-12's table.
    pub const fn of_register(register: &Register) -> Item {
        Item {
            name: register.name,
            address: register.address as u16,
            size: register.size,
            is_signed: false,
            is_eeprom: register.is_eeprom(),
            access: register.access,
            min: register.min as i32,
            max: register.max as i32,
            quantity: Quantity::Code,
            presence: Presence::All,
        }
    }

    /// The code that these bytes hold; none if they are fewer or more than the register's.
    pub fn code(&self, bytes: &[u8]) -> Option<i32> {
        if bytes.len() != usize::from(self.size) {
            return None;
        }
        let mut four = [0; 4];
        four.get_mut(..bytes.len())?.copy_from_slice(bytes);
        let low = u32::from_le_bytes(four);
        let unused = 32 - 8 * u32::from(self.size);
        Some(if self.is_signed {
            ((low << unused) as i32) >> unused
        } else {
            i32::try_from(low).unwrap_or(i32::MAX)
        })
    }

    /// The bytes of a code; the first [`Item::size`] are the register's.
    pub fn bytes(&self, code: i32) -> [u8; 4] {
        code.to_le_bytes()
    }

    /// Whether `name` names it; spaces, `_` and `-` are one, and so are capitals.
    pub fn is_named(&self, name: &str) -> bool {
        let plain = |c: u8| match c {
            b'_' | b'-' => b' ',
            other => other.to_ascii_lowercase(),
        };
        self.name.bytes().eq(name.bytes().map(plain))
    }
}

#[cfg(test)]
mod tests {
    use super::super::models::MODELS;
    use super::super::{REGISTERS, x};
    use super::*;

    #[test]
    fn codes_keep_sign_and_size() {
        assert_eq!(x::PRESENT_CURRENT.code(&[0xff, 0xff]), Some(-1));
        assert_eq!(
            x::PRESENT_VELOCITY.code(&[0xfd, 0xff, 0xff, 0xff]),
            Some(-3)
        );
        assert_eq!(x::BUS_WATCHDOG.code(&[0xff]), Some(-1));
        assert_eq!(x::MODEL.code(&[0xff, 0xff]), Some(65535));
        assert_eq!(x::PRESENT_CURRENT.code(&[0xff]), None);
        for code in [-1_048_575, -1, 0, 1, 1_048_575] {
            assert_eq!(
                x::GOAL_POSITION.code(&x::GOAL_POSITION.bytes(code)),
                Some(code)
            );
        }
    }

    #[test]
    fn the_manuals_units() {
        let si = |quantity: Quantity, code| quantity.si(code, Some(2.69e-3)).unwrap().0;
        assert_eq!(si(Quantity::Position, 2048), 0.0);
        assert!((si(Quantity::Position, 2049) - 0.00153398).abs() < 1e-8);
        assert!((si(Quantity::Speed, 1) - 0.0239691227).abs() < 0.0006 * 0.024);
        assert!((si(Quantity::Acceleration, 1) - 0.3745).abs() < 1e-4);
        assert!((si(Quantity::Current, -100) + 0.269).abs() < 1e-12);
        assert_eq!(si(Quantity::Pwm, 885), 1.0);
        // A whole turn, 50 %, 12 V, 40 degrees, 2 s, 500 us, 200 ms.
        assert!((si(Quantity::Angle, -4096) + 2.0 * PI).abs() < 1e-12);
        assert!((si(Quantity::Load, -500) + 0.5).abs() < 1e-12);
        assert!((si(Quantity::Voltage, 120) - 12.0).abs() < 1e-12);
        assert_eq!(si(Quantity::Temperature, 40), 40.0);
        assert!((si(Quantity::Milliseconds, 2000) - 2.0).abs() < 1e-12);
        assert!((si(Quantity::ReturnDelay, 250) - 500e-6).abs() < 1e-12);
        assert!((si(Quantity::Watchdog, 10) - 0.2).abs() < 1e-12);
        let unit = |quantity: Quantity| quantity.si(1, Some(1.0)).unwrap().1;
        assert_eq!(unit(Quantity::Position), "rad");
        assert_eq!(unit(Quantity::Acceleration), "rad/s^2");
        assert_eq!(unit(Quantity::Load), "of full output");
        assert_eq!(unit(Quantity::Watchdog), "s");
        assert_eq!(Quantity::Current.si(1, None), None);
        assert_eq!(Quantity::Code.si(1, None), None);
    }

    #[test]
    fn rows_are_in_order_and_overlap_in_no_servo() {
        for model in MODELS {
            let mut free = 0;
            for item in model.items() {
                assert!(item.address >= free, "{}: {}", model.name, item.name);
                assert!(matches!(item.size, 1 | 2 | 4) && item.min <= item.max);
                assert_eq!(item.is_eeprom, item.address < 64, "{}", item.name);
                assert!(item.min >= 0 || item.is_signed, "{}", item.name);
                free = item.address + u16::from(item.size);
            }
        }
        assert!(x::PRESENT_POSITION.is_named("Present_Position"));
        assert!(x::PRESENT_POSITION.is_named("present-position"));
        for other in ["present positio", "present positions", "goal position", ""] {
            assert!(!x::PRESENT_POSITION.is_named(other), "{other}");
        }
    }

    #[test]
    fn rows_of_the_ax_12_are_the_same_rows() {
        for register in REGISTERS {
            let item = Item::of_register(register);
            assert_eq!(
                item.code(&[7, 1][..usize::from(item.size)]).unwrap() & 0xff,
                7
            );
            assert!(item.is_named(register.name));
            assert_eq!(item.address, u16::from(register.address));
            assert_eq!(item.is_eeprom, register.address < 24, "{}", item.name);
            assert_eq!(item.access, register.access);
            let bounds = [register.min, register.max].map(i32::from);
            assert_eq!([item.min, item.max], bounds, "{}", item.name);
        }
    }
}
