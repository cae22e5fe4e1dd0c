//! Derivatives corrected by a step's residual, instead of differences that cost one simulation per
//! unknown.
//!
//! The least change that makes them explain the step (Broyden 1965, Mathematics of Computation 19,
//! 577), window by window: a window's residual depends on the shared values and on its own start
//! state alone (Schubert 1970).

use super::normal::WindowJacobian;
use nalgebra::{DMatrix, DVector};

impl WindowJacobian {
    /// The residual after a step, were it linear in the unknowns.
    pub fn linear_residual(
        &self,
        values: &DVector<f64>,
        window_start: &DVector<f64>,
    ) -> DVector<f64> {
        let mut residual = self.residual.clone();
        residual.gemv(-1.0, &self.parameters, values, 1.0);
        residual.gemv(-1.0, &self.window_start, window_start, 1.0);
        let of_motion = window_start.select_rows(&self.motion_start.places);
        residual.gemv(-1.0, &self.motion_start.columns, &of_motion, 1.0);
        residual
    }

    /// Corrects the derivatives by a step that led to `residual`. How much each unknown gets of the
    /// correction goes by how much of the step it was to make.
    pub fn correct(
        &mut self,
        values: &DVector<f64>,
        window_start: &DVector<f64>,
        residual: &[f64],
    ) {
        let missed =
            self.linear_residual(values, window_start) - DVector::from_column_slice(residual);
        let (of_values, of_node) = (
            weights(&self.parameters, values),
            weights(&self.window_start, window_start),
        );
        let motion_step = window_start.select_rows(&self.motion_start.places);
        let of_motion = weights(&self.motion_start.columns, &motion_step);
        let all = of_values.dot(values) + of_node.dot(window_start) + of_motion.dot(&motion_step);
        if all > 0.0 {
            (self.motion_start.columns).ger(1.0 / all, &missed, &of_motion, 1.0);
            self.parameters.ger(1.0 / all, &missed, &of_values, 1.0);
            self.window_start.ger(1.0 / all, &missed, &of_node, 1.0);
        }
        self.residual.copy_from_slice(residual);
    }
}

/// Steps times the squared lengths of their columns.
fn weights(columns: &DMatrix<f64>, step: &DVector<f64>) -> DVector<f64> {
    DVector::from_fn(step.len(), |i, _| {
        step[i] * columns.column(i).norm_squared()
    })
}

#[cfg(test)]
mod tests {
    use super::super::motion_start::MotionStart;
    use super::*;

    #[test]
    fn a_corrected_jacobian_explains_the_step() {
        let mut starts = DMatrix::from_row_slice(3, 2, &[0.5, 0.3, 0.5, -0.1, 0.0, 0.7]);
        let mut window = WindowJacobian {
            motion: 0,
            residual: DVector::from_column_slice(&[1.0, -2.0, 0.5]),
            parameters: DMatrix::from_row_slice(3, 2, &[1.0, 0.2, 0.3, -1.0, 2.0, 0.1]),
            motion_start: MotionStart::parted_from(&mut starts, &[1]),
            window_start: starts,
            start_precision: DVector::from_element(2, 1.0),
            start_pull: DVector::zeros(2),
            start_edge: vec![0.0; 2],
        };
        let before = window.clone();
        let (values, window_start) = (
            DVector::from_vec(vec![0.3, -0.1]),
            DVector::from_vec(vec![0.2, -0.4]),
        );
        let after = [0.4, -2.5, 0.1];
        window.correct(&values, &window_start, &after);
        assert_eq!(window.residual.as_slice(), after);
        window.residual.copy_from(&before.residual);
        for (linear, after) in window
            .linear_residual(&values, &window_start)
            .iter()
            .zip(after)
        {
            assert!((linear - after).abs() < 1e-12, "{linear} {after}");
        }
    }
}
