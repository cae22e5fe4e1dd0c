//! Sine and cosine together, short enough to be inlined: the larger part of what a short chain's dynamics cost.
//!
//! Cody and Waite's reduction to an eighth of a turn, then the polynomials of FreeBSD's msun (k_sin.c, k_cos.c).
//! Within 1e-15 of the truth up to a hundred thousand turns; beyond, the system's own functions.

/// Beyond this, the reduction loses digits.
const FAR: f64 = 6e5;
/// Adding it rounds to an integer, which the last bits of the sum then hold.
const ROUNDER: f64 = 6_755_399_441_055_744.0;
/// Pi / 2 in three parts; the first two have 33 bits, so that their products with the quarter are exact.
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

#[inline]
pub(super) fn sin_cos(angle: f64) -> (f64, f64) {
    // Not a number comes here too.
    if angle.abs() >= FAR || angle.is_nan() {
        return angle.sin_cos();
    }
    let rounded = angle * std::f64::consts::FRAC_2_PI + ROUNDER;
    let quarter = rounded.to_bits();
    let turns = rounded - ROUNDER;
    let x = ((angle - turns * HALF_PI[0]) - turns * HALF_PI[1]) - turns * HALF_PI[2];
    let z = x * x;
    let z2 = z * z;
    let polynomial =
        |c: [f64; 6]| (c[0] + c[1] * z) + z2 * ((c[2] + c[3] * z) + z2 * (c[4] + c[5] * z));
    let sin = x + x * z * polynomial(SIN);
    let cos = 1.0 - (0.5 * z - z2 * polynomial(COS));
    // Swapped without a branch: which quarter comes next nobody can foretell.
    let swap = (sin.to_bits() ^ cos.to_bits()) & 0_u64.wrapping_sub(quarter & 1);
    let swapped = |value: f64| f64::from_bits(value.to_bits() ^ swap);
    let (sin, cos) = (swapped(sin), swapped(cos));
    let signed = |value: f64, negative: u64| f64::from_bits(value.to_bits() ^ (negative << 63));
    (
        signed(sin, (quarter >> 1) & 1),
        signed(cos, ((quarter + 1) >> 1) & 1),
    )
}

#[cfg(test)]
mod tests {
    use super::sin_cos;

    #[test]
    fn agrees_with_the_system() {
        for k in -400_000..400_000 {
            let k = f64::from(k);
            for angle in [1e-3 * k, 1.4999 * k, k * std::f64::consts::FRAC_PI_4] {
                let (ours, theirs) = (sin_cos(angle), angle.sin_cos());
                let off = (ours.0 - theirs.0).abs().max((ours.1 - theirs.1).abs());
                assert!(off < 4e-16, "{angle}: {ours:?} {theirs:?}");
            }
        }
        assert!(sin_cos(f64::NAN).0.is_nan() && sin_cos(f64::INFINITY).1.is_nan());
    }
}
