//! Square matrices that iterations run on: of any size in memory, small ones in registers.
//!
//! A DLQR of 6 states spent more time on memory, bounds and loops of unknown length than on its
//! sums; in registers, and with fused products in `twofold`, it takes half the time.
//!
//! Rest on it in `cargo xtask peers`: "DLQR, 6 states: scipy" and "drake".

use super::dense;
use nalgebra::DMatrix;
use std::array::from_fn;

/// What doubling asks of a matrix.
pub(super) trait Square: Clone {
    /// This times `right`.
    fn times(&self, right: &Self) -> Self;
    /// Rows as columns.
    fn transposed(&self) -> Self;
    /// Adds another, entry by entry.
    fn add(&mut self, other: &Self);
    /// Adds 1 to each entry of the diagonal.
    fn add_identity(&mut self);
    /// Replaces it by its symmetric part.
    fn symmetrise(&mut self);
    /// This^-1 a and this^-1 b; `None` if it is singular.
    fn solve_both(self, a: &Self, b: &Self) -> Option<(Self, Self)>;
    /// Largest magnitude of an entry.
    fn largest(&self) -> f64;
    /// Root of the sum of squares.
    fn length(&self) -> f64;
}

impl Square for DMatrix<f64> {
    fn times(&self, right: &Self) -> Self {
        dense::product(self, right)
    }

    fn transposed(&self) -> Self {
        self.transpose()
    }

    fn add(&mut self, other: &Self) {
        *self += other;
    }

    fn add_identity(&mut self) {
        for i in 0..self.nrows() {
            self[(i, i)] += 1.0;
        }
    }

    fn symmetrise(&mut self) {
        super::doubling::symmetrise(self);
    }

    fn solve_both(self, a: &Self, b: &Self) -> Option<(Self, Self)> {
        dense::solve_both(self, a, b)
    }

    fn largest(&self) -> f64 {
        largest(self.as_slice())
    }

    fn length(&self) -> f64 {
        self.norm()
    }
}

/// In lanes: one maximum would wait for the one before.
#[inline(always)]
fn largest(values: &[f64]) -> f64 {
    let (chunks, rest) = values.as_chunks::<4>();
    let mut most = [0.0f64; 4];
    for chunk in chunks {
        most = from_fn(|lane| most[lane].max(chunk[lane].abs()));
    }
    let all = most.iter().chain(rest);
    all.fold(0.0, |most, value| most.max(value.abs()))
}

/// N x N, row by row.
#[derive(Debug, Clone, Copy)]
pub(super) struct FixedMatrix<const N: usize>([[f64; N]; N]);

impl<const N: usize> FixedMatrix<N> {
    /// A matrix of at most N rows, with zeros beyond them: they stay zeros in every doubling.
    pub fn padded(m: &DMatrix<f64>) -> FixedMatrix<N> {
        let mut rows = [[0.0; N]; N];
        for (i, row) in rows.iter_mut().enumerate().take(m.nrows()) {
            for (value, entry) in row.iter_mut().zip(m.row(i).iter()) {
                *value = *entry;
            }
        }
        FixedMatrix(rows)
    }

    /// Its first n rows and columns.
    pub fn first(self, n: usize) -> DMatrix<f64> {
        DMatrix::from_fn(n, n, |i, j| self.0[i][j])
    }
}

/// row += factor * other.
#[inline(always)]
fn add_row<const N: usize>(row: &mut [f64; N], factor: f64, other: &[f64; N]) {
    for (value, other) in row.iter_mut().zip(other) {
        *value += factor * other;
    }
}

impl<const N: usize> Square for FixedMatrix<N> {
    #[inline(always)]
    fn times(&self, right: &Self) -> Self {
        let mut rows = [[0.0; N]; N];
        for (row, factors) in rows.iter_mut().zip(&self.0) {
            for (factor, other) in factors.iter().zip(&right.0) {
                add_row(row, *factor, other);
            }
        }
        FixedMatrix(rows)
    }

    #[inline(always)]
    fn transposed(&self) -> Self {
        FixedMatrix(from_fn(|i| from_fn(|j| self.0[j][i])))
    }

    #[inline(always)]
    fn add(&mut self, other: &Self) {
        for (row, other) in self.0.iter_mut().zip(&other.0) {
            add_row(row, 1.0, other);
        }
    }

    #[inline(always)]
    fn add_identity(&mut self) {
        for i in 0..N {
            self.0[i][i] += 1.0;
        }
    }

    #[inline(always)]
    fn symmetrise(&mut self) {
        *self = FixedMatrix(from_fn(|i| {
            from_fn(|j| 0.5 * (self.0[i][j] + self.0[j][i]))
        }));
    }

    /// By Gauss's and Jordan's elimination with row pivots.
    #[inline(always)]
    fn solve_both(self, a: &Self, b: &Self) -> Option<(Self, Self)> {
        let (mut w, mut a, mut b) = (self.0, a.0, b.0);
        for k in 0..N {
            let mut pivot = k;
            for i in k + 1..N {
                if w[i][k].abs() > w[pivot][k].abs() {
                    pivot = i;
                }
            }
            if w[pivot][k] == 0.0 {
                return None;
            }
            if pivot != k {
                w.swap(k, pivot);
                a.swap(k, pivot);
                b.swap(k, pivot);
            }
            let inverse = 1.0 / w[k][k];
            for row in [&mut w[k], &mut a[k], &mut b[k]] {
                row.iter_mut().for_each(|value| *value *= inverse);
            }
            let (row_w, row_a, row_b) = (w[k], a[k], b[k]);
            for i in 0..N {
                if i != k {
                    let factor = -w[i][k];
                    add_row(&mut w[i], factor, &row_w);
                    add_row(&mut a[i], factor, &row_a);
                    add_row(&mut b[i], factor, &row_b);
                }
            }
        }
        Some((FixedMatrix(a), FixedMatrix(b)))
    }

    #[inline(always)]
    fn largest(&self) -> f64 {
        largest(self.0.as_flattened())
    }

    #[inline(always)]
    fn length(&self) -> f64 {
        let values = self.0.as_flattened().iter();
        values.map(|value| value * value).sum::<f64>().sqrt()
    }
}

/// An expression of a constant size that n fits into, where n is small, or else another. Every
/// second size will do: states mostly come in pairs, and each size is compiled by itself.
macro_rules! by_size {
    ($n:expr, $size:ident => $fixed:expr, $any:expr) => {
        by_size!(@ $size, $fixed, $any, $n, 2, 4, 6, 8)
    };
    (@ $size:ident, $fixed:expr, $any:expr, $n:expr, $($small:literal),*) => {
        match $n {
            $(n if n <= $small => {
                const $size: usize = $small;
                $fixed
            })*
            _ => $any,
        }
    };
}
pub(super) use by_size;

#[cfg(test)]
mod tests {
    use super::*;

    fn wave(n: usize, k: f64) -> DMatrix<f64> {
        DMatrix::from_fn(n, n, |i, j| (k * (1 + i + 7 * j) as f64).sin())
    }

    /// Of n x n, in registers of N.
    fn agree<const N: usize>(n: usize) {
        let (a, b) = (wave(n, 1.0), wave(n, 0.7));
        let (mut any, mut fixed) = (a.clone(), FixedMatrix::<N>::padded(&a));
        let other = FixedMatrix::<N>::padded(&b);
        let near =
            |fixed: FixedMatrix<N>, any: &DMatrix<f64>| (fixed.first(n) - any).amax() < 1e-12;
        assert!(near(fixed.times(&other), &any.times(&b)), "{n}");
        assert!(near(fixed.transposed(), &any.transposed()), "{n}");
        any.add(&b);
        fixed.add(&other);
        any.symmetrise();
        fixed.symmetrise();
        assert!(near(fixed, &any), "{n}");
        assert!((fixed.largest() - any.amax()).abs() < 1e-15, "{n}");
        assert!((fixed.length() - any.length()).abs() < 1e-14, "{n}");
        any.add_identity();
        fixed.add_identity();
        let (x, y) = fixed.solve_both(&FixedMatrix::padded(&a), &other).unwrap();
        assert!((&any * x.first(n) - a).amax() < 1e-12, "{n}");
        assert!((&any * y.first(n) - b).amax() < 1e-12, "{n}");
    }

    #[test]
    fn a_small_matrix_is_the_same_in_registers() {
        agree::<2>(1);
        agree::<2>(2);
        agree::<4>(3);
        agree::<6>(5);
        agree::<6>(6);
        agree::<8>(8);
    }

    #[test]
    fn rows_are_exchanged_and_singular_ones_refused() {
        let one = FixedMatrix([[1.0, 0.0], [0.0, 1.0]]);
        let (inverse, _) = FixedMatrix([[0.0, 2.0], [4.0, 0.0]])
            .solve_both(&one, &one)
            .unwrap();
        assert_eq!(inverse.0, [[0.0, 0.25], [0.5, 0.0]]);
        assert!(
            FixedMatrix([[1.0, 2.0], [2.0, 4.0]])
                .solve_both(&one, &one)
                .is_none()
        );
    }
}
