//! The control law: u = sat(u0 - K (x - x0)), with one rounding and one saturation.

#[cfg(not(target_arch = "avr"))]
use crate::fixed::{mac, mac_one, saturate, shift_right};
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
    rounded(sum, row.shift, [row.low, row.high])
}

#[cfg(not(target_arch = "avr"))]
#[inline]
fn rounded(sum: i32, shift: u8, [low, high]: [i16; 2]) -> i16 {
    saturate(shift_right(sum, shift), low, high)
}

/// A row of gains whose number of states is known at run time: what a simulation of any robot
/// computes with. Same arithmetic as [`control`].
#[cfg(not(target_arch = "avr"))]
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct RowRef<'a> {
    /// As [`Row::k`].
    pub k: &'a [i16],
    /// As [`Row::bias`].
    pub bias: i32,
    /// As [`Row::shift`].
    pub shift: u8,
    /// [`Row::low`] and [`Row::high`].
    pub limits: [i16; 2],
}

#[cfg(not(target_arch = "avr"))]
impl RowRef<'_> {
    /// The row's input for the states `x` about `x0`, all in the table's steps.
    #[inline]
    pub fn input(&self, x0: &[i16], x: &[i16]) -> i16 {
        let departures = x.iter().zip(x0).map(|(x, x0)| x.saturating_sub(*x0));
        let products = self.k.iter().zip(departures);
        let sum = products.fold(0, |sum: i32, (k, x)| mac_one(sum, *k, x));
        rounded(self.bias.wrapping_sub(sum), self.shift, self.limits)
    }
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
                let row = RowRef { k: &k[i], bias: bias[i], shift: shift[i], limits: limits[i] };
                prop_assert_eq!(row.input(&x0, &x), u[i]);
            }
        }
    }
}
