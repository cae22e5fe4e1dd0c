//! Sine and cosine together, short enough to be inlined: the larger part of what a short chain's
//! dynamics cost.
//!
//! Cody and Waite's reduction to an eighth of a turn, then the polynomials of FreeBSD's msun
//! (k_sin.c, k_cos.c). Within 1e-15 of the truth up to a hundred thousand turns; beyond, the
//! system's own functions.
//!
//! Rest on it in `cargo xtask peers`: all rows of forward dynamics, and the closed-loop runs.
//!
//! Kept beside `wide` 0.7, which is as accurate: with it a step of three links takes 222 ns instead
//! of 158 ns, in four lanes 432 ns instead of 345 ns, and 30 links by recursion a tenth longer.

use super::lanes::each;

/// Beyond this, the reduction loses digits.
const FAR: f64 = 6e5;
/// Adding it rounds to an integer, which the last bits of the sum then hold.
const ROUNDER: f64 = 6_755_399_441_055_744.0;
/// Pi / 2 in three parts; the first two have 33 bits, so that their products with the quarter are
/// exact.
const HALF_PI: [f64; 3] = [
    f64::from_bits(0x3FF9_21FB_5440_0000),
    f64::from_bits(0x3DD0_B461_1A60_0000),
    f64::from_bits(0x3BA3_198A_2E03_7073),
];

const SIN: [f64; 6] = [
    -1.666_666_666_666_663_2e-1,
    8.333_333_333_322_49e-3,
    -1.984_126_982_985_795e-4,
    2.755_731_370_707_007e-6,
    -2.505_076_025_340_686_3e-8,
    1.589_690_995_211_55e-10,
];
const COS: [f64; 6] = [
    4.166_666_666_666_66e-2,
    -1.388_888_888_887_411e-3,
    2.480_158_728_947_673e-5,
    -2.755_731_435_139_066_3e-7,
    2.087_572_321_298_175e-9,
    -1.135_964_755_778_819_5e-11,
];

/// Sine and cosine of each angle, rad; an angle's are the same whatever stands beside it.
#[inline(always)]
pub(super) fn sin_cos<const L: usize>(angle: [f64; L]) -> ([f64; L], [f64; L]) {
    // Not a number is far too.
    let far = |angle: &f64| !matches!(angle.abs(), size if size < FAR);
    if angle.iter().any(far) {
        return apart(angle);
    }
    let rounded: [f64; L] = each(|i| angle[i] * std::f64::consts::FRAC_2_PI + ROUNDER);
    let turns: [f64; L] = each(|i| rounded[i] - ROUNDER);
    let x: [f64; L] = each(|i| {
        ((angle[i] - turns[i] * HALF_PI[0]) - turns[i] * HALF_PI[1]) - turns[i] * HALF_PI[2]
    });
    let z: [f64; L] = each(|i| x[i] * x[i]);
    let z2: [f64; L] = each(|i| z[i] * z[i]);
    let polynomial = |c: [f64; 6]| -> [f64; L] {
        each(|i| {
            (c[0] + c[1] * z[i]) + z2[i] * ((c[2] + c[3] * z[i]) + z2[i] * (c[4] + c[5] * z[i]))
        })
    };
    let (odd, even) = (polynomial(SIN), polynomial(COS));
    let sin: [f64; L] = each(|i| x[i] + x[i] * z[i] * odd[i]);
    let cos: [f64; L] = each(|i| 1.0 - (0.5 * z[i] - z2[i] * even[i]));
    // Swapped without a branch: the next quarter cannot be predicted.
    let quarter: [u64; L] = each(|i| rounded[i].to_bits());
    let swap: [u64; L] =
        each(|i| (sin[i].to_bits() ^ cos[i].to_bits()) & 0_u64.wrapping_sub(quarter[i] & 1));
    let signed = |value: f64, swap: u64, negative: u64| {
        f64::from_bits(value.to_bits() ^ swap ^ (negative << 63))
    };
    (
        each(|i| signed(sin[i], swap[i], (quarter[i] >> 1) & 1)),
        each(|i| signed(cos[i], swap[i], ((quarter[i] + 1) >> 1) & 1)),
    )
}

/// Each on its own, those far off by the system's functions.
#[cold]
#[inline(never)]
fn apart<const L: usize>(angle: [f64; L]) -> ([f64; L], [f64; L]) {
    let both = angle.map(|angle| {
        if angle.abs() < FAR {
            let ([sin], [cos]) = sin_cos([angle]);
            (sin, cos)
        } else {
            angle.sin_cos()
        }
    });
    (both.map(|both| both.0), both.map(|both| both.1))
}

#[cfg(test)]
mod tests {
    use super::sin_cos;

    #[test]
    fn agrees_with_the_system() {
        for k in -400_000..400_000 {
            let k = f64::from(k);
            for angle in [1e-3 * k, 1.4999 * k, k * std::f64::consts::FRAC_PI_4] {
                let (([sin], [cos]), theirs) = (sin_cos([angle]), angle.sin_cos());
                let ours = (sin, cos);
                let off = (sin - theirs.0).abs().max((cos - theirs.1).abs());
                assert!(off < 4e-16, "{angle}: {ours:?} {theirs:?}");
            }
        }
        let (sin, cos) = sin_cos([f64::NAN, 0.7, f64::INFINITY, 1e9]);
        assert!(sin[0].is_nan() && cos[2].is_nan());
        let ([alone], _) = sin_cos([0.7]);
        assert_eq!((sin[1], sin[3]), (alone, 1e9_f64.sin()));
    }
}
