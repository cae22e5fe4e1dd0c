//! Fixed-point arithmetic that costs an 8-bit machine little: one rounding, one saturation.
//!
//! A raw value stands for itself times a step (LSB) that its owner knows. Products of 16-bit values
//! are summed in 32 bits; whoever makes the factors proves that the sum cannot overflow (see
//! [`crate::gains`]), so the arithmetic wraps. Checked and saturating products of 32 bits are
//! avoided throughout: the AVR's compiler calls a routine for them that spoils a register.

/// The half that turns the floor of [`shift_right`] into rounding to the nearest, halves upwards.
pub const fn half(shift: u8) -> i32 {
    match shift {
        0 => 0,
        _ => 1 << (shift - 1),
    }
}

/// Floor of `value` / 2^`shift`, for shifts below 32. Shifts by whole bytes only rename registers.
#[inline]
pub const fn shift_right(value: i32, shift: u8) -> i32 {
    match shift {
        0 => value,
        8 => value >> 8,
        16 => value >> 16,
        // Whole bytes first: the AVR shifts the rest bit by bit.
        9..16 => (value >> 8) >> (shift - 8),
        17..32 => (value >> 16) >> (shift - 16),
        _ => value >> (shift & 31),
    }
}

/// `value` within `low..=high`; needs `low <= high`.
#[inline]
pub const fn saturate(value: i32, low: i16, high: i16) -> i16 {
    if value < low as i32 {
        low
    } else if value > high as i32 {
        high
    } else {
        value as i16
    }
}

/// Sum of products; wraps, so the factors must be known to be small enough.
#[inline]
pub fn mac(k: &[i16], x: &[i16]) -> i32 {
    k.iter()
        .zip(x)
        .fold(0, |sum: i32, (&k, &x)| mac_one(sum, k, x))
}

/// `sum` and one product more; wraps likewise.
#[inline]
pub(crate) const fn mac_one(sum: i32, k: i16, x: i16) -> i32 {
    sum.wrapping_add((k as i32).wrapping_mul(x as i32))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rounds_to_the_nearest_and_halves_upwards() {
        let round = |value: i32, shift| shift_right(value + half(shift), shift);
        for (value, rounded) in [
            (0, 0),
            (127, 0),
            (128, 1),
            (-128, 0),
            (-129, -1),
            (383, 1),
            (384, 2),
        ] {
            assert_eq!(round(value, 8), rounded, "{value}");
        }
        for shift in 0..24 {
            for value in [-1_000_003, -77, -1, 0, 1, 5, 999_999] {
                let nearest = (f64::from(value) / f64::from(1 << shift) + 0.5).floor();
                assert_eq!(
                    f64::from(round(value, shift)),
                    nearest,
                    "{value} >> {shift}"
                );
            }
        }
    }

    #[test]
    fn products_of_the_extremes_are_exact() {
        assert_eq!(mac(&[i16::MIN], &[i16::MIN]), 1 << 30);
        assert_eq!(mac(&[i16::MIN, i16::MAX], &[i16::MAX, i16::MAX]), -32_767);
    }

    #[test]
    fn saturates_at_its_limits() {
        assert_eq!(saturate(40_000, -5, i16::MAX), i16::MAX);
        assert_eq!(saturate(-40_000, -5, 7), -5);
        assert_eq!(saturate(6, -5, 7), 6);
    }
}
