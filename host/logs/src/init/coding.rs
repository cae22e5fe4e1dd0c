//! Registers of servos whose numbers below zero are no plain ones.

use super::values::slope_correlation;

/// Bits that hold a sign: Feetech's speed and current, Dynamixel 1.0's speed and load.
const SIGN_BITS: [u32; 2] = [15, 10];
/// Bits of numbers that programs read without their sign.
const WIDTHS: [u32; 2] = [16, 32];
/// Bands of values that go through zero begin within this share of where they may begin.
const NEAR: f64 = 0.25;

/// How whole numbers below zero are written as others above.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Coding {
    /// A bit for the sign; the others are the magnitude.
    SignBit(u32),
    /// Two's complement of so many bits, read without its sign.
    Unsigned(u32),
}

/// How values are coded; none of plain ones.
///
/// Such values are whole and lie in two bands: from 0 up and from 2^bit up, or from 0 up and from
/// 2^bits down. Where the bands of a sign leave no gap, they must be the slope of the angles once
/// decoded, and not as they stand.
pub fn coding(values: &[f64], time_s: &[f64], angle_rad: Option<&[f64]>) -> Option<Coding> {
    let known = || values.iter().copied().filter(|value| value.is_finite());
    if !known().all(|value| value >= 0.0 && value.fract() == 0.0) {
        return None;
    }
    let unsigned = WIDTHS.into_iter().find(|bits| {
        let end = 2.0_f64.powi(*bits as i32);
        let below = known().filter(|value| *value < 0.5 * end).reduce(f64::max);
        let above = known().filter(|value| *value >= 0.5 * end).reduce(f64::min);
        let most = known().fold(0.0, f64::max);
        let (Some(below), Some(above)) = (below, above) else {
            return false;
        };
        most < end && below < NEAR * end && above > (1.0 - NEAR) * end
    });
    let likeness = |values: &[f64]| {
        angle_rad.map_or(0.0, |angle| slope_correlation(time_s, angle, values).abs())
    };
    let signed = SIGN_BITS.into_iter().find(|bit| {
        let sign = f64::from(1u32 << bit);
        let below = || known().filter(|value| *value < sign);
        let above = || {
            known()
                .filter(|value| *value >= sign)
                .map(|value| value - sign)
        };
        let (Some(highest), Some(farthest)) = (below().reduce(f64::max), above().reduce(f64::max))
        else {
            return false;
        };
        let begin = |least: Option<f64>| least.is_some_and(|least| least < NEAR * sign);
        let apart = highest.max(farthest) < 0.5 * sign
            && begin(below().reduce(f64::min))
            && begin(above().reduce(f64::min));
        let is_speed_decoded = || {
            let decoded = likeness(&decoded(values, *bit));
            decoded > 0.7 && decoded > likeness(values) + 0.1
        };
        farthest < sign && (apart || is_speed_decoded())
    });
    let unsigned = unsigned.map(Coding::Unsigned);
    unsigned.or_else(|| signed.map(Coding::SignBit))
}

fn decoded(values: &[f64], bit: u32) -> Vec<f64> {
    let sign = f64::from(1u32 << bit);
    let plain = |value: &f64| if *value >= sign { sign - value } else { *value };
    values.iter().map(plain).collect()
}

impl Coding {
    /// What it is called.
    pub fn words(self) -> String {
        match self {
            Coding::SignBit(bit) => {
                let of = match bit {
                    15 => "Feetech",
                    _ => "Dynamixel 1.0",
                };
                format!("sign in bit {bit}, magnitude below it, as registers of {of} hold it")
            }
            Coding::Unsigned(bits) => {
                format!("numbers below zero are read as {bits} bits without a sign")
            }
        }
    }

    /// What to do about it.
    pub fn remedy(self) -> String {
        let (what, from) = match self {
            Coding::SignBit(bit) => (format!("{} - value", 1u64 << bit), 1u64 << bit),
            Coding::Unsigned(bits) => (format!("value - {}", 1u64 << bits), 1u64 << (bits - 1)),
        };
        format!("no unit reads it: write {what} for values from {from} on, in a column of its own")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sign_bit_is_told_from_large_numbers() {
        let time_s: Vec<f64> = (0..500).map(|k| 0.02 * f64::from(k)).collect();
        let angle: Vec<f64> = time_s.iter().map(|t| 0.8 * (2.1 * t).sin()).collect();
        let coded = |scale: f64, bit: u32| -> Vec<f64> {
            let speed = time_s.iter().map(|t| scale * (2.1 * t).cos());
            let coded =
                |v: f64| v.abs().trunc() + if v < 0.0 { f64::from(1u32 << bit) } else { 0.0 };
            speed.map(coded).collect()
        };
        let bit = |values: &[f64]| coding(values, &time_s, Some(&angle));
        assert_eq!(bit(&coded(1095.0, 15)), Some(Coding::SignBit(15)));
        assert_eq!(bit(&coded(145.0, 10)), Some(Coding::SignBit(10)));
        // The bands meet; the slope of the angles tells.
        assert_eq!(bit(&coded(1000.0, 10)), Some(Coding::SignBit(10)));
        assert_eq!(coding(&coded(1000.0, 10), &time_s, None), None);
        // Two's complement without its sign, of angles too.
        for bits in [16, 32] {
            let unsigned = time_s.iter().map(|t| {
                let value = (1000.0 * (2.1 * t).cos()).trunc();
                let below = f64::from(u8::from(value < 0.0));
                value + below * 2.0_f64.powi(bits as i32)
            });
            let unsigned: Vec<f64> = unsigned.collect();
            assert_eq!(bit(&unsigned), Some(Coding::Unsigned(bits)));
            assert_eq!(
                coding(&unsigned, &time_s, None),
                Some(Coding::Unsigned(bits))
            );
        }
        // Two places that are far apart, neither of them zero.
        let two: Vec<f64> = (0..500).map(|k| [400.0, 1400.0][k / 250]).collect();
        assert_eq!(coding(&two, &time_s, None), None);
        // Plain numbers, signed and not.
        let plain: Vec<f64> = time_s
            .iter()
            .map(|t| (900.0 * (2.1 * t).cos()).trunc())
            .collect();
        assert_eq!(bit(&plain), None);
        let lifted: Vec<f64> = plain.iter().map(|v| v + 1000.0).collect();
        assert_eq!(bit(&lifted), None);
        assert_eq!(bit(&[0.0; 500]), None);
    }
}
