//! Normal equations of a multiple-shooting fit, with every window's own unknowns eliminated.
//!
//! The Jacobian is an arrow: parameters shared by all windows, and a start state per window.
//! Eliminating the start states window by window (Schur complement) leaves a system of the
//! parameters' size, however many windows there are.

use nalgebra::{Cholesky, DMatrix, DVector, Dyn};

/// One window's part.
#[derive(Debug, Clone)]
struct StartBlock {
    /// Inverse of the start's own normal matrix.
    inverse: DMatrix<f64>,
    /// Rows of the gradient that belong to the start.
    gradient: DVector<f64>,
    /// Unknowns of the start by parameters.
    coupling: DMatrix<f64>,
}

/// Reduced normal equations and what is needed to recover the starts' steps.
#[derive(Debug, Clone)]
pub(super) struct NormalEquations {
    /// Parameter by parameter, window starts eliminated.
    pub matrix: DMatrix<f64>,
    /// Descent direction: J' r.
    pub gradient: DVector<f64>,
    blocks: Vec<StartBlock>,
}

/// Derivatives of one window's residual: rows are residuals.
#[derive(Debug, Clone)]
pub(super) struct WindowJacobian {
    pub residual: DVector<f64>,
    /// d(prediction) / d(parameter), weighted.
    pub parameters: DMatrix<f64>,
    /// d(prediction) / d(window_start), weighted.
    pub window_start: DMatrix<f64>,
    /// Prior on the start: precision of each unknown and its pull towards the guess.
    pub start_precision: DVector<f64>,
    pub start_pull: DVector<f64>,
    /// Side on which an unknown lies at the edge of what it may be; 0 inside.
    pub start_edge: Vec<f64>,
}

impl WindowJacobian {
    /// Unknowns of the start by themselves, the prior included.
    fn start_normal(&self) -> DMatrix<f64> {
        self.window_start.tr_mul(&self.window_start) + DMatrix::from_diagonal(&self.start_precision)
    }

    /// Rows of the descent direction that belong to the start, the prior included.
    fn start_gradient(&self) -> DVector<f64> {
        self.window_start.tr_mul(&self.residual)
            + self.start_precision.component_mul(&self.start_pull)
    }

    fn start_cholesky(&self) -> Option<Cholesky<f64, Dyn>> {
        self.start_normal().cholesky()
    }

    /// Parameter columns without what the window's own start state could explain.
    pub fn reduced_parameters(&self) -> DMatrix<f64> {
        let Some(cholesky) = self.start_cholesky() else {
            return self.parameters.clone();
        };
        let coupling = cholesky.solve(&self.window_start.tr_mul(&self.parameters));
        &self.parameters - &self.window_start * coupling
    }

    /// Squared residuals less what the window's own start state can remove.
    pub fn reduced_cost(&self) -> f64 {
        let prior = self.start_precision.component_mul(&self.start_pull);
        let cost = self.residual.norm_squared() + prior.dot(&self.start_pull);
        let gradient = self.start_gradient();
        match self.start_cholesky() {
            Some(cholesky) => cost - gradient.dot(&cholesky.solve(&gradient)),
            None => cost,
        }
    }

    /// A change of the residual without what the window's own start state could explain.
    pub fn reduced(&self, change: DVector<f64>) -> DVector<f64> {
        let Some(cholesky) = self.start_cholesky() else {
            return change;
        };
        let step = cholesky.solve(&self.window_start.tr_mul(&change));
        change - &self.window_start * step
    }

    /// Takes unknowns out of the step that lie on their edge and would leave by it.
    pub fn hold_edges(&mut self) {
        let gradient = self.start_gradient();
        for i in 0..self.start_edge.len() {
            if self.start_edge[i] * gradient[i] > 0.0 {
                self.window_start.column_mut(i).fill(0.0);
                self.start_pull[i] = 0.0;
            }
        }
    }
}

impl NormalEquations {
    /// Normal equations of these windows with damping of the starts' own part.
    pub fn assemble(parameters: usize, windows: &[WindowJacobian], damping: f64) -> Self {
        let mut normal = NormalEquations {
            matrix: DMatrix::zeros(parameters, parameters),
            gradient: DVector::zeros(parameters),
            blocks: Vec::with_capacity(windows.len()),
        };
        for window in windows {
            let mut own = window.start_normal();
            let size = own.nrows();
            for i in 0..size {
                own[(i, i)] *= 1.0 + damping;
                own[(i, i)] += 1e-12;
            }
            let inverse = own
                .try_inverse()
                .unwrap_or_else(|| DMatrix::zeros(size, size));
            let coupling = window.window_start.tr_mul(&window.parameters);
            let gradient = window.start_gradient();
            let spent = coupling.tr_mul(&inverse);
            normal.matrix += window.parameters.tr_mul(&window.parameters) - &spent * &coupling;
            normal.gradient += window.parameters.tr_mul(&window.residual) - &spent * &gradient;
            normal.blocks.push(StartBlock {
                inverse,
                gradient,
                coupling,
            });
        }
        normal
    }

    /// Step of window `window`'s start that goes with this parameter step.
    pub fn start_step(&self, window: usize, parameter_step: &DVector<f64>) -> DVector<f64> {
        let block = &self.blocks[window];
        &block.inverse * (&block.gradient - &block.coupling * parameter_step)
    }
}
