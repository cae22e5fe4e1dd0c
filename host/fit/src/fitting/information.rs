//! What data say of a fit's free values, and what of the misfit those values could still remove.

use super::fit::Fit;
use super::motion_start::MotionStarts;
use nalgebra::{DMatrix, DVector};

/// Normal equations of a fit's free values with the windows' start states eliminated, in units of
/// the noise.
#[derive(Debug, Clone)]
pub struct Information {
    /// Fisher information of the free values, value by value.
    pub matrix: DMatrix<f64>,
    /// Half of how fast the squared error falls with each value.
    pub gradient: DVector<f64>,
    /// Squared error that the start states cannot remove.
    pub cost: f64,
}

impl Fit {
    /// The information in the data at the fitted values; the fit must have its derivatives, which a
    /// [rough](super::FitOptions::rough) one lacks.
    pub fn information(&self) -> Information {
        let normal = self.normal_equations(0.0);
        Information {
            matrix: normal.matrix,
            gradient: normal.gradient,
            cost: self.jacobian.iter().map(|w| w.reduced_cost()).sum::<f64>()
                - MotionStarts::of(&self.jacobian).removable(&self.jacobian),
        }
    }

    /// Precision of each free value before any data, on the diagonal: its bounds, or ten times its
    /// size where they are wider, are one standard deviation.
    pub fn weak_prior(&self) -> DMatrix<f64> {
        let deviation = self.free.iter().zip(self.values()).map(|(path, value)| {
            let (low, high) = path.bounds(&self.model);
            let size = 10.0 * value.abs().max(1e-6);
            (high - low).min(size).max(1e-9)
        });
        DMatrix::from_diagonal(&DVector::from_iterator(
            self.free.len(),
            deviation.map(|d: f64| d.powi(-2)),
        ))
    }
}

impl Information {
    /// Squared error that neither start states nor the free values can remove, where `known` is the
    /// precision of the values from elsewhere: one Gauss-Newton step.
    pub fn cost_left(&self, known: &DMatrix<f64>) -> f64 {
        let normal = &self.matrix + known;
        let removed = match normal.cholesky() {
            Some(cholesky) => self.gradient.dot(&cholesky.solve(&self.gradient)),
            None => 0.0,
        };
        (self.cost - removed).max(0.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_known_of_a_value_limits_what_it_can_remove() {
        // One value, one residual of 3 with derivative 1.
        let information = Information {
            matrix: DMatrix::from_element(1, 1, 1.0),
            gradient: DVector::from_element(1, 3.0),
            cost: 9.0,
        };
        let left = |known| information.cost_left(&DMatrix::from_element(1, 1, known));
        assert!(left(0.0) < 1e-12);
        // Known as well from elsewhere, the value goes half the way: 9 - 9 / 2.
        assert!((left(1.0) - 4.5).abs() < 1e-12);
        assert!(left(1e9) > 8.999);
    }
}
