//! What the bytes of servos of Protocol 1.0 say, in SI.

use super::sample::ServoSample;
use crate::{OneServo, Reading};
use handstand_shared::raw::Supply;
use std::collections::BTreeMap;

/// Codes of the registers 36 to 43 and the error flags that came with them.
#[derive(Debug, Clone, Copy)]
pub(super) struct OneCodes {
    /// Present position, where it was read.
    pub position: Option<u16>,
    /// Present speed.
    pub speed: u16,
    /// Present load.
    pub load: u16,
    /// Supply.
    pub supply: u8,
    /// Temperature.
    pub temperature: u8,
    /// Error flags of the answer.
    pub flags: u8,
}

impl OneCodes {
    /// Of a reading of the registers 36 to 43; none if it has other than 8 bytes.
    pub fn of_reading(reading: &Reading) -> Option<Self> {
        let data: [u8; 8] = reading.data[..].try_into().ok()?;
        let [p0, p1, s0, s1, l0, l1, supply, temperature] = data;
        let word = |low, high| u16::from_le_bytes([low, high]);
        Some(OneCodes {
            position: Some(word(p0, p1)),
            speed: word(s0, s1),
            load: word(l0, l1),
            supply,
            temperature,
            flags: reading.error.byte(),
        })
    }

    /// The sample of a servo, without its goal; codes that its registers cannot have are left out,
    /// and noted.
    pub fn sample(&self, servo: &OneServo, odd: &mut OddCodes) -> ServoSample {
        let mut checked = |value: Option<f64>, name, code| {
            if value.is_none() {
                odd.note(servo.id, name, code);
            }
            value
        };
        let position = self.position;
        ServoSample {
            position_rad: position
                .and_then(|code| checked(servo.angle_rad(code), "present position", code)),
            speed_rad_s: checked(servo.speed_rad_s(self.speed), "present speed", self.speed),
            load: checked(servo.load(self.load), "present load", self.load),
            supply_v: Some(Supply(self.supply).to_v()),
            temperature_celsius: Some(f64::from(self.temperature)),
            error: Some(self.flags),
            ..ServoSample::default()
        }
    }
}

impl ServoSample {
    /// Of a reading of the registers 36 to 43 of a servo of Protocol 1.0; `None` if it has other
    /// than 8 bytes. What has a code that its register cannot have is none.
    pub fn of_one(servo: &OneServo, reading: &Reading) -> Option<Self> {
        let codes = OneCodes::of_reading(reading)?;
        Some(codes.sample(servo, &mut OddCodes::default()))
    }
}

/// Codes that a register cannot have, of each servo and register: how many, and the last.
#[derive(Debug, Clone, Default)]
pub(super) struct OddCodes(BTreeMap<(u8, &'static str), (u64, u16)>);

impl OddCodes {
    fn note(&mut self, id: u8, register: &'static str, code: u16) {
        let (count, last) = self.0.entry((id, register)).or_default();
        *count += 1;
        *last = code;
    }

    /// A line for people of each servo and register.
    pub fn remarks(&self) -> Vec<String> {
        let line = |((id, register), (count, last)): (&(u8, &str), &(u64, u16))| {
            format!(
                "servo {id}: {count} codes of its {register} are none that it can have, the last \
                 {last}; their fields are empty"
            )
        };
        self.0.iter().map(line).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::StatusError;
    use handstand_shared::dynamixel::ErrorBits;

    #[test]
    fn codes_above_the_direction_bit_are_left_out_and_told() {
        let servo = OneServo::ax_12(3);
        let reading = Reading {
            error: StatusError::Flags(ErrorBits(0)),
            data: vec![0, 2, 0xaf, 0x0f, 0x32, 0x04, 111, 30],
        };
        let mut odd = OddCodes::default();
        let sample = OneCodes::of_reading(&reading)
            .unwrap()
            .sample(&servo, &mut odd);
        assert_eq!(sample.position_rad, Some(0.0));
        assert_eq!(sample.speed_rad_s, None);
        assert!((sample.load.unwrap() + 50.0 / 1023.0).abs() < 1e-12);
        let remarks = odd.remarks();
        assert_eq!(remarks.len(), 1);
        assert!(
            remarks[0].contains("servo 3: 1 codes of its present speed"),
            "{remarks:?}"
        );
        assert!(remarks[0].contains("4015"), "{remarks:?}");
    }
}
