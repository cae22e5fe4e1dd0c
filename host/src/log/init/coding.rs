//! Registers of servos whose numbers are no plain ones: sign and magnitude.

use super::values::slope_correlation;

/// Bits that hold a sign: Feetech's speed and current, Dynamixel 1.0's speed and load.
const SIGN_BITS: [u32; 2] = [15, 10];

/// The bit that is the sign of values whose other bits are their magnitude; none of plain ones.
///
/// Such values are whole and lie in two bands, from 0 up and from 2^bit up. Where the bands leave
/// no gap, they must be the slope of the angles once decoded, and not as they stand.
pub fn sign_bit(values: &[f64], time_s: &[f64], angle_rad: Option<&[f64]>) -> Option<u32> {
    let known = || values.iter().copied().filter(|value| value.is_finite());
    let whole = known().all(|value| value >= 0.0 && value.fract() == 0.0);
    SIGN_BITS.into_iter().find(|bit| {
        let sign = f64::from(1u32 << bit);
        let below = known().filter(|value| *value < sign).reduce(f64::max);
        let above = known().filter(|value| *value >= sign).reduce(f64::max);
        let (Some(below), Some(above)) = (below, above.filter(|_| whole)) else {
            return false;
        };
        let apart = below.max(above - sign) < 0.5 * sign;
        let likeness = |values: &[f64]| {
            angle_rad.map_or(0.0, |angle| slope_correlation(time_s, angle, values).abs())
        };
        let is_speed_decoded = || {
            let decoded = likeness(&decoded(values, *bit));
            decoded > 0.7 && decoded > likeness(values) + 0.1
        };
        above < 2.0 * sign && (apart || is_speed_decoded())
    })
}

fn decoded(values: &[f64], bit: u32) -> Vec<f64> {
    let sign = f64::from(1u32 << bit);
    let plain = |value: &f64| match *value >= sign {
        true => sign - value,
        false => *value,
    };
    values.iter().map(plain).collect()
}

/// What such a coding is called.
pub fn words(bit: u32) -> String {
    let of = match bit {
        15 => "Feetech",
        _ => "Dynamixel 1.0",
    };
    format!("sign in bit {bit}, magnitude below it, as registers of {of} hold it")
}

/// What to do about it.
pub fn remedy(bit: u32) -> String {
    let sign = 1u32 << bit;
    format!(
        "no unit reads it: write {sign} - value for values from {sign} on, in a column of its own"
    )
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
        let bit = |values: &[f64]| sign_bit(values, &time_s, Some(&angle));
        assert_eq!(bit(&coded(1095.0, 15)), Some(15));
        assert_eq!(bit(&coded(145.0, 10)), Some(10));
        // The bands meet; the slope of the angles tells.
        assert_eq!(bit(&coded(1000.0, 10)), Some(10));
        assert_eq!(sign_bit(&coded(1000.0, 10), &time_s, None), None);
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
