//! Linear plants in state space.

use super::error::DesignError;
use super::weights::{self, Sign};
use nalgebra::{DMatrix, Scalar};

/// x' = A x + B u, y = C x, in SI.
///
/// From [`linearise`](super::linearise) the state is [q - q0, dq] in the model's own convention of
/// angles, the inputs are those of the driven joints, from the base outwards, as departures from
/// what holds the pose.
#[derive(Debug, Clone, PartialEq)]
pub struct Continuous {
    /// n x n, 1/s.
    pub a: DMatrix<f64>,
    /// n x m.
    pub b: DMatrix<f64>,
    /// p x n.
    pub c: DMatrix<f64>,
}

/// x(k+1) = A x(k) + B u(k), y = C x, sampled every `ts_s`.
///
/// With an input delay the state ends in past inputs: [x; u(k-1); u(k-2); ..].
#[derive(Debug, Clone, PartialEq)]
pub struct Discrete {
    /// N x N with N = n + m `delayed_inputs`.
    pub a: DMatrix<f64>,
    /// N x m.
    pub b: DMatrix<f64>,
    /// p x N.
    pub c: DMatrix<f64>,
    /// Sampling time, s.
    pub ts_s: f64,
    /// How many past input vectors the state ends in.
    pub delayed_inputs: usize,
}

impl Discrete {
    /// Number of states of the plant itself, without past inputs.
    pub fn plant_states(&self) -> usize {
        self.a.nrows() - self.delayed_inputs * self.b.ncols()
    }

    /// A weight or covariance of the whole state: itself, or one of the plant's own states, past
    /// inputs being 0.
    ///
    /// # Errors
    /// As [`weights::of`].
    pub(super) fn whole_state(
        &self,
        name: &'static str,
        matrix: &DMatrix<f64>,
    ) -> Result<DMatrix<f64>, DesignError> {
        let (n, own) = (self.a.nrows(), self.plant_states());
        let size = if matrix.nrows() == own { own } else { n };
        weights::of(name, matrix, size, "states", Sign::Semidefinite)?;
        Ok(matrix.clone().resize(n, n, 0.0))
    }
}

/// The rows of a matrix.
pub fn rows<T: Scalar>(matrix: &DMatrix<T>) -> Vec<Vec<T>> {
    let row = |row| matrix.row(row).iter().cloned().collect();
    (0..matrix.nrows()).map(row).collect()
}
