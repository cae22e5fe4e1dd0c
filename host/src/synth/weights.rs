//! Whether weights are ones a quadratic cost can have.

use crate::error::{Error, Result};
use nalgebra::DMatrix;

/// Asymmetry and negative eigenvalues up to this share of the largest entry are rounding.
const ROUNDING: f64 = 1e-12;

/// Q, symmetric, n x n, x'Qx >= 0; R, symmetric, m x m, u'Ru > 0.
///
/// # Errors
/// Wrong sizes, not numbers, not symmetric, of the wrong sign: each with what was found.
pub(super) fn check(q: &DMatrix<f64>, r: &DMatrix<f64>, n: usize, m: usize) -> Result<()> {
    symmetric("Q", q, n, "states")?;
    symmetric("R", r, m, "inputs")?;
    semidefinite("Q", q)?;
    let least = least_eigenvalue(r);
    if least <= ROUNDING * r.amax() {
        return Err(Error::design(
            format!("R is not positive definite: its least eigenvalue is {least:.3e}"),
            "give every input a weight above 0: inputs that cost nothing would be used without bound",
        ));
    }
    Ok(())
}

/// A square, symmetric matrix of numbers.
pub(super) fn symmetric(name: &str, matrix: &DMatrix<f64>, size: usize, of: &str) -> Result<()> {
    if matrix.shape() != (size, size) {
        let (rows, columns) = matrix.shape();
        return Err(Error::design(
            format!("{name} is {rows} x {columns}, but there are {size} {of}"),
            format!("give {name} as {size} x {size}, or its diagonal, or one number"),
        ));
    }
    if let Some(value) = matrix.iter().find(|value| !value.is_finite()) {
        return Err(Error::design(
            format!("{name} has an entry of {value}"),
            "give numbers",
        ));
    }
    let most = matrix.amax();
    for i in 0..size {
        for j in 0..i {
            let (below, above) = (matrix[(i, j)], matrix[(j, i)]);
            if (below - above).abs() > ROUNDING * most {
                return Err(Error::design(
                    format!(
                        "{name} is not symmetric: entry ({}, {}) is {below}, entry ({}, {}) is {above}",
                        i + 1,
                        j + 1,
                        j + 1,
                        i + 1
                    ),
                    format!("give the symmetric part: half of {name} plus its transpose"),
                ));
            }
        }
    }
    Ok(())
}

/// A symmetric matrix without a negative eigenvalue.
pub(super) fn semidefinite(name: &str, matrix: &DMatrix<f64>) -> Result<()> {
    let least = least_eigenvalue(matrix);
    if least < -ROUNDING * matrix.nrows() as f64 * matrix.amax() {
        return Err(Error::design(
            format!("{name} is not positive semidefinite: its least eigenvalue is {least:.3e}"),
            "a negative weight rewards what it should cost: raise it to 0 or above",
        ));
    }
    Ok(())
}

fn least_eigenvalue(matrix: &DMatrix<f64>) -> f64 {
    let diagonal =
        (0..matrix.ncols()).all(|j| (0..matrix.nrows()).all(|i| i == j || matrix[(i, j)] == 0.0));
    if diagonal {
        return matrix.diagonal().min();
    }
    matrix.symmetric_eigenvalues().min()
}
