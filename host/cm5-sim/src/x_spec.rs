//! Simulated servos of Protocol 2.0 as text: `model=XL330-M288,firmware=52,mode=3`.

use super::spec_error::SpecError;
use super::x_servo::XServo;
use handstand_shared::control_table::models::{MODELS, ServoModel};
use handstand_shared::control_table::{Register, x};

/// Which servos of Protocol 2.0 there are.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct XSpec {
    model: &'static ServoModel,
    firmware: u8,
    mode: u8,
    turns: f64,
    turnaround_us: u16,
}

impl XSpec {
    /// Of the model with this name, its firmware new enough for everything that it can have.
    pub fn of(name: &str) -> Result<Self, SpecError> {
        let wrong = || {
            let names: Vec<&str> = MODELS.iter().map(|model| model.name).collect();
            SpecError::value("model", name, &names.join(", "))
        };
        Ok(XSpec {
            model: ServoModel::named(name).ok_or_else(wrong)?,
            firmware: 52,
            mode: 3,
            turns: 0.0,
            turnaround_us: 50,
        })
    }

    /// Sets what one of its keys says.
    pub fn set(&mut self, key: &str, value: &str) -> Result<(), SpecError> {
        let code = |most: u16| {
            let code = value.parse().ok().filter(|code: &u16| *code <= most);
            code.ok_or_else(|| SpecError::value(key, value, &format!("a code from 0 to {most}")))
        };
        match key {
            "firmware" => self.firmware = code(255)? as u8,
            "mode" => self.mode = code(16)? as u8,
            "turns" => {
                let turns = value
                    .parse()
                    .ok()
                    .filter(|turns: &f64| turns.abs() <= 200.0);
                let expected = "turns from -200 to 200";
                self.turns = turns.ok_or_else(|| SpecError::value(key, value, expected))?;
            }
            _ => self.turnaround_us = code(10_000)?,
        }
        Ok(())
    }

    /// A servo, with these registers of the same name as an AX-12's.
    pub fn servo(&self, id: u8, registers: &[(Register, u16)]) -> XServo {
        let mut servo = XServo::new(self.model, id, self.firmware);
        for (register, code) in registers {
            let mut items = x::X_ITEMS.iter();
            if let Some(item) = items.find(|item| item.is_named(register.name)) {
                servo.set(*item, i32::from(*code));
            }
        }
        servo.set(x::OPERATING_MODE, i32::from(self.mode));
        servo.shaft.angle_rad = self.turns * 2.0 * std::f64::consts::PI;
        servo.turnaround_ns = u64::from(self.turnaround_us) * 1000;
        let level = servo.get(x::STATUS_LEVEL);
        servo.reboot();
        servo.set(x::STATUS_LEVEL, level);
        servo
    }
}
