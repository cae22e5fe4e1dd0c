//! Transmission zeros: where the Rosenbrock pencil [A - s I, B; C, D] loses rank.
//!
//! Emami-Naeini, Van Dooren, Automatica 18 (1982) 415: orthogonal steps strip the pencil of what is
//! infinite or singular until D is square and of full rank; what is left has the zeros as the
//! eigenvalues of A - B D^-1 C.

use super::eigen::poles;
use super::error::DesignError;
use nalgebra::{Complex, DMatrix, stack};

/// Singular values below this share of the system's size count as zero.
const ZERO: f64 = 1e-11;

/// A system on its way down.
struct Reduced {
    a: DMatrix<f64>,
    b: DMatrix<f64>,
    c: DMatrix<f64>,
    d: DMatrix<f64>,
}

/// The finite transmission zeros of x' = A x + B u, y = C x, those with the largest real part
/// first; inputs as many as outputs or not. A zero with a positive real part (sampled: beyond the
/// unit circle) makes it non-minimum phase.
///
/// # Errors
/// Entries that are no numbers.
pub fn transmission_zeros(
    a: &DMatrix<f64>,
    b: &DMatrix<f64>,
    c: &DMatrix<f64>,
) -> Result<Vec<Complex<f64>>, DesignError> {
    poles(a)?;
    // Equal size keeps one threshold fair to all three.
    let unit = |m: &DMatrix<f64>| match m.norm() {
        size if size > 0.0 => m / size,
        _ => m.clone(),
    };
    let size = if a.norm() > 0.0 { a.norm() } else { 1.0 };
    let system = Reduced {
        a: a / size,
        b: unit(b),
        c: unit(c),
        d: DMatrix::zeros(c.nrows(), b.ncols()),
    };
    let left = system.strip().transposed().strip();
    if left.a.is_empty() || left.d.is_empty() {
        return Ok(scaled(poles(&left.a)?, size));
    }
    let zeros = match left.d.clone().lu().solve(&left.c) {
        Some(dc) => poles(&(&left.a - &left.b * dc))?,
        None => Vec::new(),
    };
    Ok(scaled(zeros, size))
}

fn scaled(zeros: Vec<Complex<f64>>, size: f64) -> Vec<Complex<f64>> {
    zeros.into_iter().map(|zero| zero * size).collect()
}

impl Reduced {
    fn transposed(self) -> Reduced {
        Reduced {
            a: self.a.transpose(),
            b: self.c.transpose(),
            c: self.b.transpose(),
            d: self.d.transpose(),
        }
    }

    /// Takes states away until D has full row rank.
    fn strip(mut self) -> Reduced {
        loop {
            let n = self.a.nrows();
            let (turn, rank) = row_compression(&self.d);
            let d = &turn * &self.d;
            let c = &turn * &self.c;
            self.d = d.rows(0, rank).into_owned();
            let blind = c.rows(rank, c.nrows() - rank).into_owned();
            self.c = c.rows(0, rank).into_owned();
            // Columns of the states that outputs without inputs see come last.
            let (turn, seen) = row_compression(&blind.transpose());
            if seen == 0 {
                return self;
            }
            let order: Vec<usize> = (seen..n).chain(0..seen).collect();
            let turn = turn.select_rows(&order).transpose();
            let kept = n - seen;
            let a = turn.transpose() * &self.a * &turn;
            let b = turn.transpose() * &self.b;
            let c = &self.c * &turn;
            self = Reduced {
                a: a.view((0, 0), (kept, kept)).into_owned(),
                b: b.rows(0, kept).into_owned(),
                c: stack![c.columns(0, kept); a.view((kept, 0), (seen, kept))],
                d: stack![self.d; b.rows(kept, seen)],
            };
        }
    }
}

/// An orthogonal matrix that leaves in the first `rank` rows all there is of `m`, and the rank.
fn row_compression(m: &DMatrix<f64>) -> (DMatrix<f64>, usize) {
    let rows = m.nrows();
    if m.is_empty() {
        return (DMatrix::identity(rows, rows), 0);
    }
    // Columns of zeros make the left vectors complete.
    let square = m.clone().resize_horizontally(m.ncols().max(rows), 0.0);
    let svd = square.svd(true, false);
    let Some(left) = svd.u else {
        return (DMatrix::identity(rows, rows), 0);
    };
    let rank = svd.singular_values.iter().filter(|s| **s > ZERO).count();
    (left.transpose(), rank)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row(values: &[f64]) -> DMatrix<f64> {
        DMatrix::from_row_slice(1, values.len(), values)
    }

    /// (s - 2)(s + 3) / ((s + 1)(s - 4)(s + 5)) in companion form.
    #[test]
    fn zeros_of_a_transfer_function() {
        let a = DMatrix::from_row_slice(3, 3, &[-2.0, 19.0, 20.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0]);
        let b = row(&[1.0, 0.0, 0.0]).transpose();
        let zeros = transmission_zeros(&a, &b, &row(&[1.0, 1.0, -6.0])).unwrap();
        assert_eq!(zeros.len(), 2);
        assert!(
            (zeros[0] - 2.0).norm() < 1e-12 && (zeros[1] + 3.0).norm() < 1e-12,
            "{zeros:?}"
        );
        assert!(
            transmission_zeros(&a, &b, &row(&[0.0, 0.0, 1.0]))
                .unwrap()
                .is_empty()
        );
    }

    /// Two inputs, two outputs: a mode that no input reaches is a zero.
    #[test]
    fn a_mode_out_of_reach_is_a_zero() {
        let a = DMatrix::from_row_slice(3, 3, &[1.0, 2.0, 0.0, 0.0, 3.0, 0.0, 0.0, 0.0, -2.0]);
        let b = DMatrix::from_row_slice(3, 2, &[0.0, 1.0, 1.0, 0.0, 0.0, 0.0]);
        let c = DMatrix::from_row_slice(2, 3, &[1.0, 0.0, 1.0, 0.0, 1.0, 1.0]);
        let zeros = transmission_zeros(&a, &b, &c).unwrap();
        assert_eq!(zeros.len(), 1);
        assert!((zeros[0] + 2.0).norm() < 1e-12);
    }
}
