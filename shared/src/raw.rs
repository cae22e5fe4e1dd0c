//! Register codes of the AX-12, each with the SI value of its least significant bit.
//!
//! Everything in SI goes through here once, at the edge. Source: ROBOTIS AX-12 e-manual, control
//! table.

use core::f64::consts::PI;
use serde::{Deserialize, Serialize};

/// A goal or present position: 0..=1023 over 300 degrees, 512 in the middle, counted
/// counter-clockwise.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Default)]
pub struct Position(pub u16);

impl Position {
    /// One code, rad: 300 degrees / 1024.
    pub const LSB_RAD: f64 = 300.0 / 1024.0 * PI / 180.0;
    /// The middle of the range, 0 rad.
    pub const CENTRE: Position = Position(512);
    /// The largest code.
    pub const MAX: Position = Position(1023);

    /// Angle from the centre, rad, counter-clockwise positive.
    pub fn to_rad(self) -> f64 {
        (f64::from(self.0) - f64::from(Self::CENTRE.0)) * Self::LSB_RAD
    }

    /// The nearest code; angles outside the range give its end.
    pub fn from_rad(angle_rad: f64) -> Self {
        let code = angle_rad / Self::LSB_RAD + f64::from(Self::CENTRE.0);
        Position(nearest(code.clamp(0.0, 1023.0)))
    }
}

/// Speed limit of a movement in joint mode (register 32); code 0 means "as fast as possible", not
/// standstill.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct MovingSpeed(pub u16);

impl MovingSpeed {
    /// One code, rad/s: 0.111 revolutions per minute.
    pub const LSB_RAD_S: f64 = 0.111 * 2.0 * PI / 60.0;
    /// No limit.
    pub const UNLIMITED: MovingSpeed = MovingSpeed(0);
    /// The lowest limit.
    pub const LEAST: MovingSpeed = MovingSpeed(1);
    /// The highest limit: 12 rad/s.
    pub const MOST: MovingSpeed = MovingSpeed(1023);

    /// The limit, rad/s; infinite if there is none.
    pub fn to_rad_s(self) -> f64 {
        match self {
            Self::UNLIMITED => f64::INFINITY,
            Self(code) => f64::from(code) * Self::LSB_RAD_S,
        }
    }

    /// The nearest limit that is one: at least 1, at most 1023.
    pub fn from_rad_s(speed_rad_s: f64) -> Self {
        MovingSpeed(nearest((speed_rad_s / Self::LSB_RAD_S).clamp(1.0, 1023.0)))
    }
}

/// A magnitude of 10 bits with its direction in bit 10 (set = clockwise): present speed and load,
/// and the command in wheel mode.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Signed(pub u16);

impl Signed {
    /// Present speed: one code, rad/s.
    pub const SPEED_LSB_RAD_S: f64 = MovingSpeed::LSB_RAD_S;
    /// Load and wheel-mode command: one code as a share of full output, 1 / 1023.
    pub const OUTPUT_LSB: f64 = 1.0 / 1023.0;

    /// The value of a code that the register can have, as [`Signed::get`]; none of one with bits
    /// above the direction's, which servos report now and then.
    pub fn checked(self) -> Option<i16> {
        (self.0 < 0x800).then(|| self.get())
    }

    /// Counter-clockwise positive, -1023..=1023.
    pub fn get(self) -> i16 {
        let magnitude = (self.0 & 0x3ff) as i16;
        if self.0 & 0x400 == 0 {
            magnitude
        } else {
            -magnitude
        }
    }

    /// The code of a counter-clockwise positive value; beyond +-1023 it stays there.
    pub fn new(value: i16) -> Self {
        let magnitude = value.unsigned_abs().min(0x3ff);
        Signed(if value < 0 {
            magnitude | 0x400
        } else {
            magnitude
        })
    }
}

/// Supply (register 42).
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Default)]
pub struct Supply(pub u8);

impl Supply {
    /// One code, V.
    pub const LSB_V: f64 = 0.1;

    /// Volts.
    pub fn to_v(self) -> f64 {
        f64::from(self.0) * Self::LSB_V
    }
}

/// Temperature (register 43): one code is one degree Celsius.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Default)]
pub struct Temperature(pub u8);

impl Temperature {
    /// Degrees Celsius.
    pub fn to_celsius(self) -> f64 {
        f64::from(self.0)
    }
}

/// How long a servo waits before it answers (register 5).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ReturnDelay(pub u8);

impl ReturnDelay {
    /// One code, microseconds.
    pub const LSB_US: u16 = 2;
    /// What a servo leaves the factory with: 500 us.
    pub const FACTORY: ReturnDelay = ReturnDelay(250);

    /// Microseconds.
    pub const fn to_us(self) -> u16 {
        self.0 as u16 * Self::LSB_US
    }
}

/// Torque limit (registers 14 and 34): 1023 is the servo's full torque.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub struct TorqueLimit(pub u16);

impl TorqueLimit {
    /// No limit below the servo's own.
    pub const FULL: TorqueLimit = TorqueLimit(1023);
    /// No torque at all.
    pub const NONE: TorqueLimit = TorqueLimit(0);
}

fn nearest(code: f64) -> u16 {
    // Codes are not negative here, so adding a half and cutting rounds to the nearest; no_std has
    // no `round`.
    (code + 0.5) as u16
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_position_code_survives_the_way_through_si() {
        for code in 0..=1023 {
            assert_eq!(Position::from_rad(Position(code).to_rad()), Position(code));
        }
        assert_eq!(Position::CENTRE.to_rad(), 0.0);
        assert_eq!(Position::from_rad(100.0), Position::MAX);
    }

    /// The e-manual's figures.
    #[test]
    fn codes_are_in_the_manual_s_units() {
        let near = |a: f64, b: f64| (a / b - 1.0).abs() < 1e-12;
        // 114 revolutions per minute.
        assert!(near(
            MovingSpeed(1023).to_rad_s(),
            113.553 * 2.0 * PI / 60.0
        ));
        assert_eq!(MovingSpeed::from_rad_s(5.0), MovingSpeed(430));
        assert!(near(Supply(96).to_v(), 9.6));
        assert_eq!(Temperature(43).to_celsius(), 43.0);
        assert_eq!(ReturnDelay::FACTORY.to_us(), 500);
    }

    #[test]
    fn every_signed_value_survives_its_code() {
        for value in -1023..=1023 {
            assert_eq!(Signed::new(value).get(), value);
        }
        assert_eq!(Signed::new(-1).0, 0x401);
        assert_eq!(Signed(2047).checked(), Some(-1023));
        assert_eq!([3154, 4015].map(|code| Signed(code).checked()), [None; 2]);
        assert_eq!(Signed::new(i16::MIN).get(), -1023);
    }

    #[test]
    fn speed_code_zero_is_unlimited_and_never_made_from_a_speed() {
        assert_eq!(MovingSpeed::UNLIMITED.to_rad_s(), f64::INFINITY);
        assert_eq!(MovingSpeed::from_rad_s(0.0), MovingSpeed(1));
        assert_eq!(MovingSpeed::from_rad_s(1e9), MovingSpeed(1023));
    }
}
