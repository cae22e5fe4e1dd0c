//! What of a change in the prediction the fitted parameters and start states can't imitate, as far
//! as what is known of the parameters beforehand lets them.

use super::fit::Fit;
use super::motion_start::{MotionStarts, reduced_parameters};
use super::normal::WindowJacobian;
use nalgebra::{Cholesky, DMatrix, DVector, Dyn};

/// Projection off the columns of a fit's Jacobian.
#[derive(Debug)]
pub struct Projector<'a> {
    windows: &'a [WindowJacobian],
    /// What was before the log of each motion.
    motions: MotionStarts,
    /// Parameter columns with the start states' part taken out.
    reduced: Vec<DMatrix<f64>>,
    normal: Option<Cholesky<f64, Dyn>>,
}

impl<'a> Projector<'a> {
    /// Projection off everything this fit has freed.
    pub fn new(fit: &'a Fit) -> Self {
        let reduced = reduced_parameters(&fit.jacobian);
        let count = fit.free.len();
        let mut normal = DMatrix::from_diagonal(&fit.value_prior().precision);
        for window in &reduced {
            normal += window.tr_mul(window);
        }
        for i in 0..count {
            normal[(i, i)] = normal[(i, i)] * (1.0 + 1e-10) + 1e-20;
        }
        Projector {
            windows: &fit.jacobian,
            motions: MotionStarts::of(&fit.jacobian),
            reduced,
            normal: normal.cholesky().filter(|_| count > 0),
        }
    }

    /// Projection off the start states alone.
    pub fn off_start_states(fit: &'a Fit) -> Self {
        Projector {
            normal: None,
            ..Projector::new(fit)
        }
    }

    /// How the prediction changes with each free parameter, less what start states could make of
    /// it: one column per parameter, windows joined.
    pub fn parameter_columns(&self) -> Vec<DVector<f64>> {
        let parameters = self.reduced.first().map_or(0, DMatrix::ncols);
        (0..parameters)
            .map(|p| {
                let rows = self.reduced.iter().map(DMatrix::nrows).sum();
                let values = self
                    .reduced
                    .iter()
                    .flat_map(|w| w.column(p).iter().copied().collect::<Vec<_>>());
                DVector::from_iterator(rows, values)
            })
            .collect()
    }

    /// A change of the weighted residual, window by window, less what the fit could make of it.
    pub fn off(&self, change: &[Vec<f64>]) -> Vec<Vec<f64>> {
        let column = |change: &Vec<f64>| DMatrix::from_column_slice(change.len(), 1, change);
        let mut left: Vec<DMatrix<f64>> = change
            .iter()
            .zip(self.windows)
            .map(|(change, window)| window.reduced(&column(change)))
            .collect();
        self.motions.take_out(&mut left);
        if let Some(normal) = &self.normal {
            let mut right = DMatrix::zeros(self.reduced[0].ncols(), 1);
            for (left, reduced) in left.iter().zip(&self.reduced) {
                right += reduced.tr_mul(left);
            }
            let step = normal.solve(&right);
            for (left, reduced) in left.iter_mut().zip(&self.reduced) {
                *left -= reduced * &step;
            }
        }
        left.into_iter().map(|v| v.as_slice().to_vec()).collect()
    }
}
