//! What the codes of a servo of Protocol 1.0 mean, which its model and its settings say.
//!
//! Source: ROBOTIS e-manual, "CW/CCW Angle Limit", "Multi Turn Offset", "Resolution Divider" of
//! AX-12A and MX-28.

use super::port::SerialLink;
use super::servo_error::{ServoError, ServoResult};
use super::servo_rows::Model;
use super::servos::Servos;
use handstand_shared::control_table::one::{
    AX_12, MULTI_TURN_CODES, MULTI_TURN_OFFSET, OneFamily, OneModel, RESOLUTION_DIVIDER,
};
use handstand_shared::control_table::{CCW_LIMIT, CW_LIMIT};
use handstand_shared::raw::Signed;
use std::f64::consts::PI;

/// How a servo of Protocol 1.0 takes goals; its angle limits say it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum OneMode {
    /// Both limits 0: it turns without end, and takes no positions.
    Wheel,
    /// Positions between the limits.
    Joint,
    /// Both limits at the last code of an MX: positions over several turns.
    MultiTurn,
}

/// A servo of Protocol 1.0 as its settings have it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OneServo {
    /// Its id.
    pub id: u8,
    /// Its model.
    pub model: &'static OneModel,
    /// How it takes goals.
    pub mode: OneMode,
    /// Angle limits, codes, clockwise and counter-clockwise.
    limits: (i32, i32),
    /// What is added to its position, codes; 0 outside multi-turn mode.
    pub offset: i32,
    /// Codes of the turn that make one of its position; 1 outside multi-turn mode.
    divider: i32,
}

impl OneServo {
    /// An AX-12 with its factory's angle limits.
    pub fn ax_12(id: u8) -> Self {
        OneServo::new(id, AX_12, (0, i32::from(CCW_LIMIT.max)), 0, 1)
    }

    fn new(
        id: u8,
        model: &'static OneModel,
        limits: (i32, i32),
        offset: i32,
        divider: i32,
    ) -> Self {
        let last = i32::from(model.codes) - 1;
        let mode = match limits {
            (0, 0) => OneMode::Wheel,
            (cw, ccw) if model.family == OneFamily::Mx && cw == last && ccw == last => {
                OneMode::MultiTurn
            }
            _ => OneMode::Joint,
        };
        let counts = mode == OneMode::MultiTurn;
        OneServo {
            id,
            model,
            mode,
            limits,
            offset: if counts { offset } else { 0 },
            divider: if counts { divider.clamp(1, 4) } else { 1 },
        }
    }

    /// One code of its position, rad.
    pub fn lsb_rad(&self) -> f64 {
        let turn = self.model.range_deg / f64::from(self.model.codes);
        turn * f64::from(self.divider) * PI / 180.0
    }

    /// The code in the middle of its range: 0 rad.
    fn middle(&self) -> f64 {
        f64::from(self.model.codes / 2) / f64::from(self.divider)
    }

    /// Angle from the middle of its range, rad, counter-clockwise positive; none of a code that its
    /// position cannot have.
    pub fn angle_rad(&self, code: u16) -> Option<f64> {
        let code = match self.mode {
            OneMode::MultiTurn => i32::from(code as i16),
            _ => i32::from(code),
        };
        let is_one = self.mode == OneMode::MultiTurn || code < i32::from(self.model.codes);
        is_one.then(|| self.angle_of(code))
    }

    /// Angle of a goal's code, rad.
    pub fn angle_of(&self, code: i32) -> f64 {
        (f64::from(code) - self.middle()) * self.lsb_rad()
    }

    /// The nearest code of an angle, whether or not the servo can get there.
    pub fn code_of(&self, angle_rad: f64) -> i32 {
        (angle_rad / self.lsb_rad() + self.middle()).round() as i32
    }

    /// The least and the largest goal that it takes, codes; none in wheel mode.
    pub fn goal_limits(&self) -> Option<(i32, i32)> {
        match self.mode {
            OneMode::Wheel => None,
            OneMode::Joint => Some(self.limits),
            OneMode::MultiTurn => Some((-MULTI_TURN_CODES, MULTI_TURN_CODES)),
        }
    }

    /// Where the position's codes begin and end while no turn was made.
    pub fn first_turn(&self) -> std::ops::Range<i32> {
        self.offset..self.offset + i32::from(self.model.codes) / self.divider
    }

    /// Speed, rad/s, counter-clockwise positive; none of a code that the register cannot have.
    pub fn speed_rad_s(&self, code: u16) -> Option<f64> {
        let lsb_rad_s = self.model.speed_lsb_rpm * 2.0 * PI / 60.0;
        Some(f64::from(Signed(code).checked()?) * lsb_rad_s)
    }

    /// Load, a share of full output; none of a code that the register cannot have.
    pub fn load(&self, code: u16) -> Option<f64> {
        Some(f64::from(Signed(code).checked()?) * Signed::OUTPUT_LSB)
    }
}

impl<L: SerialLink> Servos<L> {
    /// What servo `id` of Protocol 1.0 is, and how it is set.
    ///
    /// # Errors
    /// Why there is no good answer, [`ServoError::UnknownModel`], or
    /// [`ServoError::OtherProtocol`].
    pub fn one_servo(&mut self, id: u8) -> ServoResult<OneServo> {
        let Model::One(model) = self.known_model(id)? else {
            return Err(ServoError::OtherProtocol { id });
        };
        let data = self.read(id, u16::from(CW_LIMIT.address), 4)?.data;
        let [c0, c1, d0, d1] = data[..] else {
            let bytes = data.len();
            return Err(ServoError::Garbled { id, bytes });
        };
        let word = |low, high| i32::from(u16::from_le_bytes([low, high]));
        let limits = (word(c0, c1), word(d0, d1));
        let servo = OneServo::new(id, model, limits, 0, 1);
        if servo.mode != OneMode::MultiTurn {
            return Ok(servo);
        }
        let offset = self.code(id, &MULTI_TURN_OFFSET)?;
        let divider = self.code(id, &RESOLUTION_DIVIDER)?;
        Ok(OneServo::new(id, model, limits, offset, divider))
    }

    /// The same, of a servo that a CM-5 reads and moves: its firmware takes all for AX-12.
    ///
    /// # Errors
    /// As [`Servos::one_servo`], and [`ServoError::NotAxCodes`].
    pub fn cm5_servo(&mut self, id: u8) -> ServoResult<OneServo> {
        let servo = self.one_servo(id)?;
        let OneModel { number, name, .. } = *servo.model;
        if servo.model.has_ax_codes() {
            Ok(servo)
        } else {
            Err(ServoError::NotAxCodes { id, number, name })
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn servo(number: u16, limits: (i32, i32)) -> OneServo {
        OneServo::new(1, OneModel::of(number).unwrap(), limits, 0, 1)
    }

    /// Centre, range and speed of each family, as the manuals have them.
    #[test]
    fn codes_are_in_each_models_units() {
        for (number, centre, last, degrees, rpm) in [
            (12, 512, 1023, 150.0, 0.111),
            (64, 512, 1023, 150.0, 0.111),
            (107, 2048, 4095, 125.46, 0.111),
            (29, 2048, 4095, 180.0, 0.114),
            (320, 2048, 4095, 180.0, 0.114),
            (360, 2048, 4095, 180.0, 0.916),
        ] {
            let servo = servo(number, (0, last));
            assert_eq!(servo.angle_rad(centre), Some(0.0), "{number}");
            let lowest = servo.angle_rad(0).unwrap().to_degrees();
            assert!((lowest + degrees).abs() < 1e-9, "{number}: {lowest}");
            assert_eq!(servo.angle_rad(last as u16 + 1), None, "{number}");
            let angle = servo.angle_rad(700).unwrap();
            assert_eq!(servo.code_of(angle), 700, "{number}");
            let speed = servo.speed_rad_s(0x400 | 100).unwrap();
            assert!((speed * 60.0 / (2.0 * PI) + 100.0 * rpm).abs() < 1e-9);
        }
    }

    /// Codes that RX-64 servos report at the dead zone.
    #[test]
    fn codes_that_a_register_cannot_have_are_no_speeds() {
        let rx = servo(64, (0, 1023));
        for code in [3154, 4015, 2048] {
            assert_eq!((rx.speed_rad_s(code), rx.load(code)), (None, None));
        }
        assert!(rx.speed_rad_s(2047).is_some());
    }

    #[test]
    fn angle_limits_choose_the_mode() {
        assert_eq!(servo(12, (0, 0)).goal_limits(), None);
        assert_eq!(servo(12, (1023, 1023)).mode, OneMode::Joint);
        assert_eq!(servo(29, (0, 4095)).goal_limits(), Some((0, 4095)));
        assert_eq!(servo(107, (4095, 4095)).mode, OneMode::Joint);
        let turns = servo(29, (4095, 4095));
        assert_eq!(turns.mode, OneMode::MultiTurn);
        assert_eq!(turns.goal_limits(), Some((-28_672, 28_672)));
        // The code of position -1096.
        let angle = turns.angle_rad(64_440).unwrap();
        assert!((angle.to_degrees() - (-1096.0 - 2048.0) * 360.0 / 4096.0).abs() < 1e-9);
    }

    /// The manual's example: 2048 with an offset of 1024 reads 3072, with a divider of 4 besides
    /// (2048 / 4) + 1024.
    #[test]
    fn offset_and_divider_count_in_multi_turn_mode_only() {
        let model = OneModel::of(29).unwrap();
        let turns = OneServo::new(1, model, (4095, 4095), 1024, 4);
        assert!(turns.first_turn().contains(&1536) && !turns.first_turn().contains(&2048));
        assert!((turns.lsb_rad() - 4.0 * 2.0 * PI / 4096.0).abs() < 1e-12);
        assert_eq!(turns.angle_rad(512), Some(0.0));
        let joint = OneServo::new(1, model, (0, 4095), 1024, 4);
        assert_eq!((joint.offset, joint.angle_rad(2048)), (0, Some(0.0)));
    }
}
