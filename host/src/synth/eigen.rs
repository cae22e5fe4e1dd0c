//! Eigenvalues of a general matrix, and the distance of its modes from uncontrollability.

use super::error::DesignError;
use super::qr::eigenvalues;
use nalgebra::linalg::balancing::balance_parlett_reinsch;
use nalgebra::{Complex, DMatrix, DVector, stack};

/// Eigenvalues, those with the largest real part first.
///
/// # Errors
/// Entries that are no numbers.
pub fn poles(a: &DMatrix<f64>) -> Result<Vec<Complex<f64>>, DesignError> {
    if a.iter().all(|value| value.is_finite()) {
        let mut balanced = a.clone();
        balance_parlett_reinsch(&mut balanced);
        if let Some(mut poles) = eigenvalues(balanced) {
            poles.sort_by(|a, b| b.re.total_cmp(&a.re).then(b.im.total_cmp(&a.im)));
            return Ok(poles);
        }
    }
    Err(DesignError::Eigenvalues)
}

/// Sorts poles per sample, those nearest to the unit circle first, or outside it.
pub(super) fn slowest_first(poles: &mut [Complex<f64>]) {
    poles.sort_by(|a, b| b.norm().total_cmp(&a.norm()));
}

/// Largest modulus of poles.
pub(super) fn largest(poles: &[Complex<f64>]) -> f64 {
    poles.iter().map(|pole| pole.norm()).fold(0.0, f64::max)
}

/// A mode and its controllability margin.
#[derive(Debug, Clone)]
pub struct Mode {
    /// Its eigenvalue, 1/s or per sample.
    pub pole: Complex<f64>,
    /// Least singular value of [A - pole I, B] (or of that over C), over the largest of A or B (or
    /// C): 0 where uncontrollable.
    pub margin: f64,
    /// The state in which it shows most, counted from 0.
    pub state: usize,
}

/// The modes of A with how far each is from being uncontrollable through B (Popov, Belevitch,
/// Hautus).
///
/// # Errors
/// As [`poles`].
pub fn modes(a: &DMatrix<f64>, b: &DMatrix<f64>) -> Result<Vec<Mode>, DesignError> {
    let poles = poles(a)?;
    let complex = |m: &DMatrix<f64>| m.map(|value| Complex::new(value, 0.0));
    let (n, size) = (a.nrows(), a.norm().max(b.norm()).max(f64::MIN_POSITIVE));
    let (a, b) = (complex(a), complex(b));
    let mode = |pole: Complex<f64>| {
        let shifted = &a - DMatrix::from_diagonal_element(n, n, pole);
        let svd = stack![shifted, b].svd(true, false);
        let least = svd.singular_values.imin();
        let left = svd
            .u
            .map(|u| DVector::from_column_slice(u.column(least).as_slice()));
        Mode {
            pole,
            margin: svd.singular_values[least] / size,
            state: left.map_or(0, |left| left.map(|z| z.norm()).imax()),
        }
    };
    Ok(poles.into_iter().map(mode).collect())
}
