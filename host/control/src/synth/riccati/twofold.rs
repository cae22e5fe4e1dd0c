//! Matrices with twice the digits: unevaluated sums of two, products without rounding error to
//! first order.
//!
//! Dekker, Numerische Mathematik 18 (1971) 224 (splitting, exact products); Ogita, Rump, Oishi,
//! SIAM Journal on Scientific Computing 26 (2005) 1955 (compensated dot products).
//!
//! Kept beside the crate `twofloat` 0.8, whose scalars are normalised after each operation: a
//! product of 60 x 60 matrices takes 0.42 ms against 1.25 ms, and the two differ by 5e-31.
//!
//! Rest on it in `cargo xtask peers`: "K of 60 states, off 60 digits", and the times of all DLQRs.

use super::dense::product;
use nalgebra::DMatrix;

/// 2^27 + 1: splits a double into halves whose products are exact.
const SPLITTER: f64 = 134_217_729.0;

/// hi + lo, with lo beyond the digits of hi.
#[derive(Debug, Clone)]
pub(super) struct Twofold {
    pub hi: DMatrix<f64>,
    pub lo: DMatrix<f64>,
}

/// A matrix of doubles, split once for many products.
#[derive(Debug, Clone)]
pub(super) struct SplitMatrix {
    whole: DMatrix<f64>,
    upper: DMatrix<f64>,
    lower: DMatrix<f64>,
}

impl SplitMatrix {
    pub fn new(whole: DMatrix<f64>) -> SplitMatrix {
        let upper = whole.map(|value| split(value).0);
        let lower = &whole - &upper;
        SplitMatrix {
            whole,
            upper,
            lower,
        }
    }

    /// This times `right`.
    pub fn times(&self, right: &Twofold) -> Twofold {
        self.times_all(right, false)
    }

    /// This times `right`, a product known to be symmetric: half the work.
    pub fn times_symmetric(&self, right: &Twofold) -> Twofold {
        let mut product = self.times_all(right, true);
        for part in [&mut product.hi, &mut product.lo] {
            part.fill_upper_triangle_with_lower_triangle();
        }
        product
    }

    /// Of a symmetric product the lower triangle will do.
    fn times_all(&self, right: &Twofold, symmetric: bool) -> Twofold {
        let mut hi = DMatrix::zeros(self.whole.nrows(), right.hi.ncols());
        let mut lo = product(&self.whole, &right.lo);
        add_product(self, right.hi.as_slice(), [&mut hi, &mut lo], symmetric);
        Twofold { hi, lo }.normal()
    }
}

/// hi + lo += matrix * right, the rounding errors kept in lo. What rounds off a product is the same
/// number however it is found.
#[multiversion::multiversion(targets("x86_64+avx2+fma"))]
fn add_product(
    matrix: &SplitMatrix,
    right: &[f64],
    [hi, lo]: [&mut DMatrix<f64>; 2],
    symmetric: bool,
) {
    let (rows, inner) = matrix.whole.shape();
    let (whole, upper) = (matrix.whole.as_slice(), matrix.upper.as_slice());
    let lower = matrix.lower.as_slice();
    let columns = hi.as_mut_slice().chunks_exact_mut(rows);
    let lows = lo.as_mut_slice().chunks_exact_mut(rows);
    let factors = right.chunks_exact(inner);
    for (j, ((factors, hi), lo)) in factors.zip(columns).zip(lows).enumerate() {
        let first = if symmetric { j } else { 0 };
        let (hi, lo) = (&mut hi[first..], &mut lo[first..]);
        for (k, &factor) in factors.iter().enumerate() {
            let column = k * rows + first..(k + 1) * rows;
            if multiversion::target::target_cfg_f!(target_feature = "fma") {
                add_fused(factor, &whole[column], hi, lo);
            } else {
                let halves = [&upper[column.clone()], &lower[column.clone()]];
                add_split(factor, &whole[column], halves, hi, lo);
            }
        }
    }
}

/// hi + lo += factor * column, in an instruction that rounds product and sum once.
#[inline(always)]
fn add_fused(factor: f64, column: &[f64], hi: &mut [f64], lo: &mut [f64]) {
    for ((value, hi), lo) in column.iter().zip(hi).zip(lo) {
        let product = factor * value;
        let (sum, rest) = two_sum(*hi, product);
        *hi = sum;
        *lo += rest + factor.mul_add(*value, -product);
    }
}

/// hi + lo += factor * column, by the column's halves.
#[inline(always)]
fn add_split(
    factor: f64,
    column: &[f64],
    [upper, lower]: [&[f64]; 2],
    hi: &mut [f64],
    lo: &mut [f64],
) {
    let (factor_upper, factor_lower) = split(factor);
    let n = hi.len();
    let (column, upper, lower, lo) = (&column[..n], &upper[..n], &lower[..n], &mut lo[..n]);
    for i in 0..n {
        let product = factor * column[i];
        let error = lower[i] * factor_lower
            - (((product - upper[i] * factor_upper) - lower[i] * factor_upper)
                - upper[i] * factor_lower);
        let (sum, rest) = two_sum(hi[i], product);
        hi[i] = sum;
        lo[i] += rest + error;
    }
}

impl Twofold {
    pub fn exact(hi: DMatrix<f64>) -> Twofold {
        let lo = DMatrix::zeros(hi.nrows(), hi.ncols());
        Twofold { hi, lo }
    }

    pub fn transpose(&self) -> Twofold {
        Twofold {
            hi: self.hi.transpose(),
            lo: self.lo.transpose(),
        }
    }

    /// This plus `sign` times `other`.
    pub fn plus(mut self, sign: f64, other: &Twofold) -> Twofold {
        let others = other.hi.as_slice().iter().zip(other.lo.as_slice());
        for ((hi, lo), (other_hi, other_lo)) in self.entries().zip(others) {
            let (sum, rest) = two_sum(*hi, sign * other_hi);
            (*hi, *lo) = two_sum(sum, *lo + (rest + sign * other_lo));
        }
        self
    }

    /// This plus doubles.
    pub fn plus_exact(mut self, other: &DMatrix<f64>) -> Twofold {
        for ((hi, lo), other) in self.entries().zip(other.as_slice()) {
            let (sum, rest) = two_sum(*hi, *other);
            (*hi, *lo) = two_sum(sum, *lo + rest);
        }
        self
    }

    /// Rounded to doubles.
    pub fn rounded(&self) -> DMatrix<f64> {
        &self.hi + &self.lo
    }

    /// Moves what `lo` has grown to back into `hi`.
    fn normal(mut self) -> Twofold {
        for (hi, lo) in self.entries() {
            (*hi, *lo) = two_sum(*hi, *lo);
        }
        self
    }

    fn entries(&mut self) -> impl Iterator<Item = (&mut f64, &mut f64)> {
        let lo = self.lo.as_mut_slice().iter_mut();
        self.hi.as_mut_slice().iter_mut().zip(lo)
    }
}

/// a + b rounded, and what rounding lost (Knuth).
#[inline(always)]
fn two_sum(a: f64, b: f64) -> (f64, f64) {
    let sum = a + b;
    let b_seen = sum - a;
    (sum, (a - (sum - b_seen)) + (b - b_seen))
}

/// Upper and lower half of the digits (Veltkamp).
#[inline(always)]
fn split(value: f64) -> (f64, f64) {
    let big = SPLITTER * value;
    let upper = big - (big - value);
    (upper, value - upper)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        /// Sums that cancel to nothing in double precision keep what is left.
        #[test]
        fn products_keep_twice_the_digits(
            values in prop::collection::vec(-1.0f64..1.0, 6),
            small in -1.0f64..1.0,
        ) {
            let row: Vec<f64> = values.iter().chain(&values).copied().chain([1e-20]).collect();
            let both = values.iter().copied().chain(values.iter().map(|v| -v));
            let column: Vec<f64> = both.chain([small]).collect();
            let product = SplitMatrix::new(DMatrix::from_row_slice(1, 13, &row))
                .times(&Twofold::exact(DMatrix::from_column_slice(13, 1, &column)));
            prop_assert!((product.rounded()[0] - 1e-20 * small).abs() < 1e-30);
        }

        /// To the bit, whatever instructions a machine has.
        #[test]
        fn a_product_s_error_is_the_same_fused_or_split(
            column in prop::collection::vec(-1.0f64..1.0, 7),
            factor in -1e3f64..1e3,
        ) {
            let matrix = SplitMatrix::new(DMatrix::from_column_slice(7, 1, &column));
            let (mut hi, mut lo) = ([1.0 / 3.0; 7], [1e-18; 7]);
            let (mut other_hi, mut other_lo) = (hi, lo);
            add_fused(factor, matrix.whole.as_slice(), &mut hi, &mut lo);
            let halves = [matrix.upper.as_slice(), matrix.lower.as_slice()];
            add_split(factor, matrix.whole.as_slice(), halves, &mut other_hi, &mut other_lo);
            prop_assert_eq!((hi, lo), (other_hi, other_lo));
        }

        #[test]
        fn sums_keep_twice_the_digits(a in -1.0f64..1.0, b in -1e-17f64..1e-17) {
            let one = |value| Twofold::exact(DMatrix::from_element(1, 1, value));
            let sum = one(a).plus(1.0, &one(b)).plus_exact(&DMatrix::from_element(1, 1, -a));
            prop_assert!((sum.rounded()[0] - b).abs() < 1e-32);
        }
    }
}
