//! Polynomials in the delay operator, `c[0] + c[1] q^-1 + ...`, and filters made of two of them.

use crate::synth::poles;
use nalgebra::{Complex, DMatrix};

/// `numerator(q) / denominator(q)` applied to a signal that was zero before its first sample.
///
/// `denominator[0]` is 1. An unstable filter grows without bound; it does not fail.
pub fn filter(numerator: &[f64], denominator: &[f64], signal: &[f64]) -> Vec<f64> {
    let mut out = vec![0.0; signal.len()];
    for t in 0..signal.len() {
        let mut sum = 0.0;
        for (lag, weight) in numerator.iter().enumerate().take(t + 1) {
            sum += weight * signal[t - lag];
        }
        for (lag, weight) in denominator.iter().enumerate().take(t + 1).skip(1) {
            sum -= weight * out[t - lag];
        }
        out[t] = sum;
    }
    out
}

/// The product of two polynomials.
pub fn multiply(left: &[f64], right: &[f64]) -> Vec<f64> {
    let mut product = vec![0.0; (left.len() + right.len()).saturating_sub(1)];
    for (i, a) in left.iter().enumerate() {
        for (j, b) in right.iter().enumerate() {
            product[i + j] += a * b;
        }
    }
    product
}

/// The value at `q = 1`: what a constant is multiplied by.
pub fn at_one(polynomial: &[f64]) -> f64 {
    polynomial.iter().sum()
}

/// Whether every root, as a polynomial in `q`, lies inside the unit circle: the Schur-Cohn test.
///
/// `monic[0]` is 1. Steps the order down by its reflection coefficients, which must all be below 1
/// in size (Jury, Theory and Application of the z-Transform Method, 1964).
pub fn is_stable(monic: &[f64]) -> bool {
    let mut row = monic.to_vec();
    while row.len() > 1 {
        let order = row.len() - 1;
        let reflection = row[order];
        if reflection.is_nan() || reflection.abs() >= 1.0 {
            return false;
        }
        let scale = 1.0 - reflection * reflection;
        row = (0..order)
            .map(|k| (row[k] - reflection * row[order - k]) / scale)
            .collect();
    }
    true
}

/// Roots in `q` of `c[0] q^n + c[1] q^(n-1) + ... + c[n]`, largest first; `c[0]` is not 0.
///
/// Eigenvalues of the companion matrix. `None` where they are not found, as with coefficients that
/// are no numbers.
pub fn roots(polynomial: &[f64]) -> Option<Vec<Complex<f64>>> {
    let order = polynomial.len().saturating_sub(1);
    if order == 0 {
        return Some(Vec::new());
    }
    if !polynomial.iter().all(|c| c.is_finite()) || polynomial[0] == 0.0 {
        return None;
    }
    let companion = DMatrix::from_fn(order, order, |row, column| match (row, column) {
        (0, column) => -polynomial[column + 1] / polynomial[0],
        (row, column) if row == column + 1 => 1.0,
        _ => 0.0,
    });
    let mut roots = poles(&companion).ok()?;
    roots.sort_by(|a, b| b.norm().total_cmp(&a.norm()).then(b.im.total_cmp(&a.im)));
    Some(roots)
}

/// The monic polynomial with these roots in `q`; complex ones come in conjugate pairs.
pub fn with_roots(roots: &[Complex<f64>]) -> Vec<f64> {
    let mut product = vec![Complex::new(1.0, 0.0)];
    for root in roots {
        product.push(Complex::new(0.0, 0.0));
        for k in (1..product.len()).rev() {
            let before = product[k - 1];
            product[k] -= root * before;
        }
    }
    product.into_iter().map(|c| c.re).collect()
}

/// The polynomial with every root outside the circle `|q| = most` brought inside: mirrored at the
/// unit circle, which leaves the shape of its spectrum, and held at `most` if still outside.
pub fn stabilised(monic: &[f64], most: f64) -> Vec<f64> {
    if is_stable(monic) {
        return monic.to_vec();
    }
    let Some(mut roots) = roots(monic) else {
        let mut one = vec![0.0; monic.len()];
        one[0] = 1.0;
        return one;
    };
    for root in &mut roots {
        if root.norm() > 1.0 {
            *root = root.conj().inv();
        }
        if root.norm() > most {
            *root *= most / root.norm();
        }
    }
    with_roots(&roots)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_filter_is_its_difference_equation() {
        // y(t) = 0.5 y(t-1) + 2 u(t-1) to a step.
        let y = filter(&[0.0, 2.0], &[1.0, -0.5], &[1.0; 4]);
        assert_eq!(y, [0.0, 2.0, 3.0, 3.5]);
    }

    #[test]
    fn roots_come_back_from_their_polynomial() {
        let wanted = [
            Complex::new(0.9, 0.3),
            Complex::new(0.9, -0.3),
            Complex::new(-0.5, 0.0),
        ];
        let polynomial = with_roots(&wanted);
        for (found, wanted) in roots(&polynomial).unwrap().iter().zip(wanted) {
            assert!((found - wanted).norm() < 1e-12, "{found} {wanted}");
        }
        assert!(roots(&[1.0, f64::NAN]).is_none());
    }

    #[test]
    fn stability_is_roots_inside_the_circle() {
        for (radius, stable) in [(0.99, true), (1.01, false)] {
            let root = Complex::from_polar(radius, 0.7);
            let polynomial = with_roots(&[root, root.conj(), Complex::new(0.2, 0.0)]);
            assert_eq!(is_stable(&polynomial), stable);
            assert!(is_stable(&stabilised(&polynomial, 0.999)));
        }
        assert!(!is_stable(&[1.0, f64::NAN]));
    }

    #[test]
    fn mirroring_keeps_the_shape_of_the_spectrum() {
        let outside = [1.0, -2.0];
        let inside = stabilised(&outside, 0.999);
        assert!((inside[1] + 0.5).abs() < 1e-12);
        let power =
            |c: &[f64], w: f64| (Complex::new(c[0], 0.0) + Complex::from_polar(c[1], -w)).norm();
        let ratio = |w: f64| power(&outside, w) / power(&inside, w);
        assert!((ratio(0.3) - ratio(2.5)).abs() < 1e-12);
    }
}
