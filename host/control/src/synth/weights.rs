//! Whether weights and covariances are ones that a quadratic cost, or noise, can have.

use super::error::DesignError;
use nalgebra::DMatrix;

/// Asymmetry and negative eigenvalues up to this share of the largest entry are rounding.
const ROUNDING: f64 = 1e-12;

/// What a symmetric matrix must be.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Sign {
    /// x'Mx >= 0.
    Semidefinite,
    /// x'Mx > 0 but for x = 0.
    Definite,
}

/// A symmetric matrix for so many states (inputs, outputs), of a sign.
///
/// # Errors
/// Another size, entries that are no numbers, not symmetric, of another sign: each with what was
/// found.
pub(super) fn of(
    name: &'static str,
    m: &DMatrix<f64>,
    size: usize,
    of: &'static str,
    sign: Sign,
) -> Result<(), DesignError> {
    symmetric(name, m, size, of)?;
    let least = least_eigenvalue(m);
    let slack = ROUNDING * size as f64 * m.amax();
    match sign {
        Sign::Semidefinite if least < -slack => Err(DesignError::request(
            format!("{name} is not positive semidefinite: its least eigenvalue is {least:.3e}"),
            format!(
                "no weight or variance is negative: raise the eigenvalues of {name} to 0 or above"
            ),
        )),
        Sign::Definite if least.is_nan() || least <= slack => Err(DesignError::request(
            format!("{name} is not positive definite: its least eigenvalue is {least:.3e}"),
            format!("give every one of the {of} a weight or variance above 0 in {name}"),
        )),
        _ => Ok(()),
    }
}

fn symmetric(
    name: &'static str,
    matrix: &DMatrix<f64>,
    size: usize,
    of: &'static str,
) -> Result<(), DesignError> {
    if matrix.shape() != (size, size) {
        return Err(other_size(name, matrix, size, of));
    }
    if let Some(value) = matrix.iter().find(|value| !value.is_finite()) {
        return Err(DesignError::request(
            format!("{name} has an entry of {value}"),
            "give numbers",
        ));
    }
    let slack = ROUNDING * matrix.amax();
    for i in 0..size {
        for j in 0..i {
            let (below, above) = (matrix[(i, j)], matrix[(j, i)]);
            if (below - above).abs() > slack {
                return Err(DesignError::model(
                    format!(
                        "{name} is not symmetric: entry ({}, {}) is {below}, entry ({}, {}) is \
                         {above}",
                        i + 1,
                        j + 1,
                        j + 1,
                        i + 1
                    ),
                    format!("give its symmetric part, half of {name} plus its transpose"),
                ));
            }
        }
    }
    Ok(())
}

/// A matrix that is not `size` x `size`.
pub(super) fn other_size(name: &str, matrix: &DMatrix<f64>, size: usize, of: &str) -> DesignError {
    let (rows, columns) = matrix.shape();
    DesignError::model(
        format!("{name} is {rows} x {columns}, but there are {size} {of}"),
        format!("give {name} as {size} x {size}, as its diagonal, or as one number"),
    )
}

fn least_eigenvalue(matrix: &DMatrix<f64>) -> f64 {
    let n = matrix.nrows();
    let diagonal = (0..n).all(|j| (0..n).all(|i| i == j || matrix[(i, j)] == 0.0));
    if diagonal {
        matrix.diagonal().min()
    } else {
        matrix.symmetric_eigenvalues().min()
    }
}
