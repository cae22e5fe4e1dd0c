//! The control table of X330, X430 and MX(2.0) servos, one row per register. Source: ROBOTIS
//! e-manual, "XL330-M288-T", "XL430-W250-T", "XM430-W350", "MX-28(2.0)".
//!
//! Indirect addresses are left out: where their data begin depends on model and firmware.

use super::Access;
use super::item::{Item, Presence, Quantity};

macro_rules! items {
    ($($NAME:ident $address:literal $kind:ident $access:ident $min:literal $max:literal
        $quantity:ident $presence:ident $name:literal)*) => {
        $(#[doc = concat!("Register ", $address, ", ", $name, ".")]
        pub const $NAME: Item = Item {
            name: $name, address: $address, size: (<$kind>::BITS / 8) as u8,
            is_signed: <$kind>::MIN != 0, is_eeprom: $address < 64, access: Access::$access,
            min: $min, max: $max, quantity: Quantity::$quantity, presence: Presence::$presence,
        };)*

        /// Every register, by address.
        pub const X_ITEMS: &[Item] = &[$($NAME),*];
    };
}

#[rustfmt::skip]
items! {
    // name, address, type, access, smallest and largest code, quantity, presence, name in words
    MODEL                  0 u16 Read         0   65535 Code         All "model number"
    FIRMWARE               6 u8  Read         0     255 Code         All "firmware version"
    ID                     7 u8  Write        0     252 Code         All "id"
    BAUD                   8 u8  Write        0       7 Code         All "baud rate"
    RETURN_DELAY           9 u8  Write        0     254 ReturnDelay  All "return delay time"
    DRIVE_MODE            10 u8  Write        0      15 Code         All "drive mode"
    OPERATING_MODE        11 u8  Write        0      16 Code         All "operating mode"
    SHADOW_ID             12 u8  Write        0     255 Code         All "shadow id"
    PROTOCOL              13 u8  Write        1      22 Code         All "protocol type"
    HOMING_OFFSET         20 i32 Write -1044479 1044479 Angle        All "homing offset"
    MOVING_THRESHOLD      24 u32 Write        0    1023 Speed        All "moving threshold"
    TEMPERATURE_LIMIT     31 u8  Write        0     100 Temperature  All "temperature limit"
    MAX_VOLTAGE           32 u16 Write       31     160 Voltage      All "max voltage limit"
    MIN_VOLTAGE           34 u16 Write       31     160 Voltage      All "min voltage limit"
    PWM_LIMIT             36 u16 Write        0     885 Pwm          All "pwm limit"
    CURRENT_LIMIT         38 u16 Write        0    2352 Current      Current "current limit"
    ACCELERATION_LIMIT    40 u32 Write        0   32767 Acceleration Mx "acceleration limit"
    VELOCITY_LIMIT        44 u32 Write        0    2047 Speed        All "velocity limit"
    MAX_POSITION          48 u32 Write        0    4095 Position     All "max position limit"
    MIN_POSITION          52 u32 Write        0    4095 Position     All "min position limit"
    STARTUP               60 u8  Write        0       3 Code         All "startup configuration"
    PWM_SLOPE             62 u8  Write        1     255 Code         X330 "pwm slope"
    SHUTDOWN              63 u8  Write        0      61 Code         All "shutdown"
    TORQUE_ENABLE         64 u8  Write        0       1 Code         All "torque enable"
    LED                   65 u8  Write        0       1 Code         All "led"
    STATUS_LEVEL          68 u8  Write        0       2 Code         All "status return level"
    REGISTERED            69 u8  Read         0       1 Code         All "registered instruction"
    HARDWARE_ERROR        70 u8  Read         0     255 Code         All "hardware error status"
    VELOCITY_I            76 u16 Write        0   16383 Code         All "velocity i gain"
    VELOCITY_P            78 u16 Write        0   16383 Code         All "velocity p gain"
    POSITION_D            80 u16 Write        0   16383 Code         All "position d gain"
    POSITION_I            82 u16 Write        0   16383 Code         All "position i gain"
    POSITION_P            84 u16 Write        0   16383 Code         All "position p gain"
    FEEDFORWARD_2         88 u16 Write        0   16383 Code         All "feedforward 2nd gain"
    FEEDFORWARD_1         90 u16 Write        0   16383 Code         All "feedforward 1st gain"
    BUS_WATCHDOG          98 i8  Write       -1     127 Watchdog     All "bus watchdog"
    GOAL_PWM             100 i16 Write     -885     885 Pwm          All "goal pwm"
    GOAL_CURRENT         102 i16 Write    -2352    2352 Current      Current "goal current"
    GOAL_VELOCITY        104 i32 Write    -2047    2047 Speed        All "goal velocity"
    PROFILE_ACCELERATION 108 u32 Write        0   32767 Acceleration All "profile acceleration"
    PROFILE_VELOCITY     112 u32 Write        0   32767 Speed        All "profile velocity"
    GOAL_POSITION        116 i32 Write -1048575 1048575 Position     All "goal position"
    REALTIME_TICK        120 u16 Read         0   32767 Milliseconds All "realtime tick"
    MOVING               122 u8  Read         0       1 Code         All "moving"
    MOVING_STATUS        123 u8  Read         0     255 Code         All "moving status"
    PRESENT_PWM          124 i16 Read      -885     885 Pwm          All "present pwm"
    PRESENT_CURRENT      126 i16 Read    -32768   32767 Current      Current "present current"
    PRESENT_LOAD         126 i16 Read     -1000    1000 Load         Load "present load"
    PRESENT_VELOCITY     128 i32 Read     -2047    2047 Speed        All "present velocity"
    PRESENT_POSITION     132 i32 Read  -1048575 1048575 Position     All "present position"
    VELOCITY_TRAJECTORY  136 i32 Read     -2047    2047 Speed        All "velocity trajectory"
    POSITION_TRAJECTORY  140 i32 Read  -1048575 1048575 Position     All "position trajectory"
    PRESENT_VOLTAGE      144 u16 Read         0     255 Voltage      All "present input voltage"
    PRESENT_TEMPERATURE  146 u8  Read         0     100 Temperature  All "present temperature"
    BACKUP_READY         147 u8  Read         0       1 Code         All "backup ready"
}

/// Bits per second of a code of the baud rate register; none of a code that it does not have.
pub fn baud_of(code: u8) -> Option<u32> {
    const RATES: [u32; 8] = [
        9_600, 57_600, 115_200, 1_000_000, 2_000_000, 3_000_000, 4_000_000, 4_500_000,
    ];
    RATES.get(usize::from(code)).copied()
}

/// The code of this speed.
pub fn baud_code(baud: u32) -> Option<u8> {
    (0..8).find(|code| baud_of(*code) == Some(baud))
}

/// Names of the bits of the hardware error status.
pub fn hardware_errors(status: u8) -> impl Iterator<Item = &'static str> {
    const NAMES: [(u8, &str); 5] = [
        (0, "input voltage"),
        (2, "overheating"),
        (3, "motor encoder"),
        (4, "electrical shock"),
        (5, "overload"),
    ];
    let is_set = move |(bit, _): &(u8, &str)| status >> bit & 1 == 1;
    NAMES.into_iter().filter(is_set).map(|(_, name)| name)
}

#[cfg(test)]
mod tests {
    extern crate std;

    use super::*;
    use std::vec::Vec;

    /// As the manual lists them.
    #[test]
    fn baud_rates_have_codes() {
        let rates = [
            9_600, 57_600, 115_200, 1_000_000, 2_000_000, 3_000_000, 4_000_000, 4_500_000,
        ];
        for (code, rate) in (0..).zip(rates) {
            assert_eq!(baud_of(code), Some(rate));
            assert_eq!(baud_code(rate), Some(code));
        }
        assert_eq!((baud_of(8), baud_of(255)), (None, None));
        assert_eq!((baud_code(57_601), baud_code(0)), (None, None));
    }

    #[test]
    fn bits_of_the_hardware_error_have_names() {
        let names = |status| hardware_errors(status).collect::<Vec<_>>();
        assert_eq!(names(0b1100_0010), [""; 0]);
        assert_eq!(names(0b0000_0001), ["input voltage"]);
        assert_eq!(names(0b0010_0100), ["overheating", "overload"]);
        assert_eq!(names(0b0001_1000), ["motor encoder", "electrical shock"]);
    }
}
