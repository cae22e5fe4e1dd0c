//! Controllability and observability, by rank and by mode.

use super::eigen::{Mode, modes};
use super::error::DesignError;
use nalgebra::DMatrix;

/// Singular values below this share of the largest count as zero.
const ZERO: f64 = 1e-10;

/// Controllability of a plant's modes by its inputs; of the transposed plant, observability by its
/// outputs.
#[derive(Debug, Clone)]
pub struct Controllability {
    /// Rank of [B, AB, A^2 B, ..], its blocks scaled to equal size.
    pub rank: usize,
    /// Its singular values, the largest first.
    pub singular_values: Vec<f64>,
    /// Every mode with its margin; the rank does not tell which mode is uncontrollable.
    pub modes: Vec<Mode>,
}

impl Controllability {
    /// Whether every mode is controllable.
    pub fn is_full(&self) -> bool {
        self.modes.iter().all(|mode| mode.margin > ZERO)
    }
}

/// Controllability of A's modes through B.
///
/// # Errors
/// Entries that are no numbers.
pub fn controllability(a: &DMatrix<f64>, b: &DMatrix<f64>) -> Result<Controllability, DesignError> {
    let modes = modes(a, b)?;
    let (n, m) = b.shape();
    let scale = a.norm() / (n as f64).sqrt();
    let scaled = a / if scale > 0.0 { scale } else { 1.0 };
    let mut matrix = DMatrix::zeros(n, n * m);
    let mut block = b.clone();
    for k in 0..n {
        matrix.view_mut((0, k * m), (n, m)).copy_from(&block);
        block = &scaled * block;
    }
    let singular_values = matrix.singular_values().as_slice().to_vec();
    let least = ZERO * singular_values.first().copied().unwrap_or(0.0);
    Ok(Controllability {
        rank: singular_values.iter().filter(|s| **s > least).count(),
        singular_values,
        modes,
    })
}

/// Observability of A's modes through C.
///
/// # Errors
/// Entries that are no numbers.
pub fn observability(a: &DMatrix<f64>, c: &DMatrix<f64>) -> Result<Controllability, DesignError> {
    controllability(&a.transpose(), &c.transpose())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_mode_out_of_reach_is_named() {
        let a = DMatrix::from_row_slice(3, 3, &[1.0, 2.0, 0.0, 0.0, 3.0, 0.0, 0.0, 0.0, -2.0]);
        let b = DMatrix::from_row_slice(3, 1, &[0.0, 1.0, 0.0]);
        let reach = controllability(&a, &b).unwrap();
        assert_eq!(reach.rank, 2);
        assert!(!reach.is_full());
        for mode in &reach.modes {
            assert_eq!(mode.margin < 1e-12, mode.pole.re == -2.0, "{mode:?}");
        }
        assert_eq!(reach.modes[2].state, 2);
        let shown = observability(&a, &DMatrix::from_row_slice(1, 3, &[1.0, 0.0, 1.0])).unwrap();
        assert_eq!(shown.rank, 3);
        assert!(shown.is_full());
    }
}
