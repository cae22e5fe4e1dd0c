//! Numbers side by side, so that one instruction serves several runs.
//!
//! Lane by lane the operations are those of plain numbers in the same order, so the results are the
//! same bit for bit.
//!
//! Rests on it in `cargo xtask peers`: "closed-loop run of 5 s, rigid: numba".

use super::sin_cos::sin_cos;
use std::ops::{Add, Mul, Sub};

/// A number for each place of an array.
///
/// The standard library's `from_fn` and `map` are not inlined from another unit of code without
/// optimisation across units, as in builds for tests: there a simulation takes a third longer.
#[inline(always)]
pub(super) fn each<T: Copy + Default, const N: usize>(of: impl Fn(usize) -> T) -> [T; N] {
    let mut out = [T::default(); N];
    for (i, out) in out.iter_mut().enumerate() {
        *out = of(i);
    }
    out
}

/// What the equations of motion ask of a number.
pub trait Lane:
    Copy + Default + std::fmt::Debug + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self>
{
    /// The same number in every lane.
    fn splat(value: f64) -> Self;
    /// 1 / x.
    fn inverse(self) -> Self;
    /// Sine and cosine of an angle, rad.
    fn sin_cos(self) -> (Self, Self);
    /// Of several angles, rad: all sines and all cosines.
    fn sin_cos_of<const N: usize>(angles: [Self; N]) -> ([Self; N], [Self; N]);
}

impl Lane for f64 {
    #[inline(always)]
    fn splat(value: f64) -> Self {
        value
    }

    #[inline(always)]
    fn inverse(self) -> Self {
        1.0 / self
    }

    #[inline(always)]
    fn sin_cos(self) -> (Self, Self) {
        let ([sin], [cos]) = sin_cos([self]);
        (sin, cos)
    }

    #[inline(always)]
    fn sin_cos_of<const N: usize>(angles: [f64; N]) -> ([f64; N], [f64; N]) {
        sin_cos(angles)
    }
}

/// `L` numbers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Lanes<const L: usize>(pub [f64; L]);

impl<const L: usize> Default for Lanes<L> {
    #[inline(always)]
    fn default() -> Self {
        Lanes([0.0; L])
    }
}

impl<const L: usize> Lane for Lanes<L> {
    #[inline(always)]
    fn splat(value: f64) -> Self {
        Lanes([value; L])
    }

    #[inline(always)]
    fn inverse(self) -> Self {
        Lanes(each(|i| 1.0 / self.0[i]))
    }

    #[inline(always)]
    fn sin_cos(self) -> (Self, Self) {
        let (sin, cos) = sin_cos(self.0);
        (Lanes(sin), Lanes(cos))
    }

    #[inline(always)]
    fn sin_cos_of<const N: usize>(angles: [Self; N]) -> ([Self; N], [Self; N]) {
        let (mut sin, mut cos) = ([Self::default(); N], [Self::default(); N]);
        for i in 0..N {
            (sin[i], cos[i]) = angles[i].sin_cos();
        }
        (sin, cos)
    }
}

impl<const L: usize> Add for Lanes<L> {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Lanes(each(|i| self.0[i] + other.0[i]))
    }
}

impl<const L: usize> Sub for Lanes<L> {
    type Output = Self;

    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Lanes(each(|i| self.0[i] - other.0[i]))
    }
}

impl<const L: usize> Mul for Lanes<L> {
    type Output = Self;

    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        Lanes(each(|i| self.0[i] * other.0[i]))
    }
}
