//! The control law: u = sat(u0 - K (x - x0)), with one rounding and one saturation.

#[cfg(not(target_arch = "avr"))]
use crate::fixed::{mac, saturate, shift_right};
use crate::gains::{GainTable, Row};

#[cfg(target_arch = "avr")]
mod avr;
#[cfg(target_arch = "avr")]
pub(crate) use avr::departure;
#[cfg(target_arch = "avr")]
use avr::{finish, one_sum};

/// The inputs for the states `x`, both in the table's steps.
///
/// Exact up to its one rounding for every `x`, if the table is safe ([`GainTable::is_safe`]).
#[inline]
pub fn control<const M: usize, const N: usize>(table: &GainTable<M, N>, x: &[i16; N]) -> [i16; M] {
    let departure = departure(&table.x0, x);
    let mut u = [0; M];
    for (u, row) in u.iter_mut().zip(&table.rows) {
        *u = input(row, &departure);
    }
    u
}

/// How far the states `x` are from the operating point `x0`, saturating.
#[cfg(not(target_arch = "avr"))]
#[inline]
pub(crate) fn departure<const N: usize>(x0: &[i16; N], x: &[i16; N]) -> [i16; N] {
    let mut departure = [0; N];
    for ((departure, x), x0) in departure.iter_mut().zip(x).zip(x0) {
        *departure = x.saturating_sub(*x0);
    }
    departure
}

/// One row's input at this departure.
#[inline(always)]
pub(crate) fn input<const N: usize>(row: &Row<N>, departure: &[i16; N]) -> i16 {
    finish(one_sum(row.bias, &row.k, departure), row)
}

/// The one rounding and the one saturation.
#[cfg(not(target_arch = "avr"))]
#[inline]
fn finish<const N: usize>(sum: i32, row: &Row<N>) -> i16 {
    saturate(shift_right(sum, row.shift), row.low, row.high)
}

/// `bias` - sum of products, wrapping.
#[cfg(not(target_arch = "avr"))]
fn one_sum(bias: i32, k: &[i16], x: &[i16]) -> i32 {
    bias.wrapping_sub(mac(k, x))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        /// Against integers too wide to overflow.
        #[test]
        fn it_is_the_law(
            k in prop::array::uniform2(prop::array::uniform6(-10_000i16..10_000)),
            u0 in prop::array::uniform2(-1000i16..1000),
            shift in prop::array::uniform2(0u8..17),
            limit in prop::array::uniform2(0i16..i16::MAX),
            x0 in prop::array::uniform6(any::<i16>()),
            x in prop::array::uniform6(any::<i16>()),
        ) {
            let bias = [0, 1].map(|i| (i32::from(u0[i]) << shift[i]) + crate::fixed::half(shift[i]));
            let limits = limit.map(|limit| [-limit, limit]);
            let table = GainTable::new(k, bias, shift, limits, x0);
            prop_assume!(table.is_safe());
            let u = control(&table, &x);
            for i in 0..2 {
                let departure = |j: usize| (i64::from(x[j]) - i64::from(x0[j])).clamp(-32_768, 32_767);
                let sum: i64 = (0..6).map(|j| i64::from(k[i][j]) * departure(j)).sum();
                let exact = f64::from(u0[i]) - sum as f64 / 2f64.powi(i32::from(shift[i]));
                let rounded = (exact + 0.5).floor().clamp(-f64::from(limit[i]), f64::from(limit[i]));
                prop_assert_eq!(f64::from(u[i]), rounded);
            }
        }
    }
}
