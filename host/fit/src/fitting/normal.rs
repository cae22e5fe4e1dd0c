//! Normal equations of a multiple-shooting fit, with every window's own unknowns eliminated.
//!
//! The Jacobian is an arrow: parameters shared by all windows, and a start state per window.
//! Eliminating the start states window by window (Schur complement), and then what is unknown of
//! each motion's beginning, leaves a system of the parameters' size, however many windows there
//! are.

use super::motion_start::{MotionBlock, MotionNormal, MotionStart};
use nalgebra::{Cholesky, DMatrix, DVector, Dyn};
use std::borrow::Cow;

/// One window's part.
#[derive(Debug, Clone)]
struct StartBlock {
    /// Place of its motion's block.
    motion: usize,
    /// Places of the motion's unknowns among those of the start.
    of_motion: Vec<usize>,
    /// Inverse of the start's own normal matrix.
    inverse: DMatrix<f64>,
    /// Rows of the gradient that belong to the start.
    gradient: DVector<f64>,
    /// Unknowns of the start by parameters and unknowns of the motion.
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
    motions: Vec<MotionBlock>,
}

/// Derivatives of one window's residual: rows are residuals.
#[derive(Debug, Clone)]
pub(super) struct WindowJacobian {
    /// The motion that it is of.
    pub motion: usize,
    pub residual: DVector<f64>,
    /// d(prediction) / d(parameter), weighted.
    pub parameters: DMatrix<f64>,
    /// d(prediction) / d(window_start), weighted; nothing by what is unknown of the motion.
    pub window_start: DMatrix<f64>,
    /// That.
    pub motion_start: MotionStart,
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

    /// Step of the start state where all else stays.
    pub fn start_step_alone(&self) -> DVector<f64> {
        let gradient = self.start_gradient();
        match self.start_cholesky() {
            Some(cholesky) => cholesky.solve(&gradient),
            None => gradient * 0.0,
        }
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

    /// Changes of the residual, a column each, without what the window's own start state could
    /// explain.
    pub fn reduced(&self, changes: &DMatrix<f64>) -> DMatrix<f64> {
        let Some(cholesky) = self.start_cholesky() else {
            return changes.clone();
        };
        let step = cholesky.solve(&self.window_start.tr_mul(changes));
        changes - &self.window_start * step
    }

    /// Adds its equations to those of its motion, its own start eliminated.
    fn eliminated(&self, sum: &mut MotionNormal, damping: f64) -> StartBlock {
        let mut own = self.start_normal();
        let size = own.nrows();
        for i in 0..size {
            own[(i, i)] *= 1.0 + damping;
            own[(i, i)] += 1e-12;
        }
        let inverse = own
            .try_inverse()
            .unwrap_or_else(|| DMatrix::zeros(size, size));
        let shared = self.shared();
        let coupling = self.window_start.tr_mul(&*shared);
        let gradient = self.start_gradient();
        let spent = coupling.tr_mul(&inverse);
        sum.matrix += shared.tr_mul(&*shared) - &spent * &coupling;
        sum.gradient += shared.tr_mul(&self.residual) - &spent * &gradient;
        StartBlock {
            motion: 0,
            of_motion: self.motion_start.places.clone(),
            inverse,
            gradient,
            coupling,
        }
    }

    /// Derivatives by what it shares with other windows: parameters, then unknowns of the motion.
    fn shared(&self) -> Cow<'_, DMatrix<f64>> {
        let of_motion = &self.motion_start.columns;
        if of_motion.ncols() == 0 {
            return Cow::Borrowed(&self.parameters);
        }
        let count = self.parameters.ncols();
        let mut shared =
            (self.parameters.clone()).resize_horizontally(count + of_motion.ncols(), 0.0);
        shared
            .columns_mut(count, of_motion.ncols())
            .copy_from(of_motion);
        Cow::Owned(shared)
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
            motions: Vec::new(),
        };
        for windows in windows.chunk_by(|a, b| a.motion == b.motion) {
            let of_motion = windows[0].motion_start.places.len();
            let mut sum = MotionNormal::zeros(parameters + of_motion);
            for window in windows {
                let block = window.eliminated(&mut sum, damping);
                normal.blocks.push(StartBlock {
                    motion: normal.motions.len(),
                    ..block
                });
            }
            normal
                .motions
                .push(sum.eliminate(parameters, windows, damping));
            normal.matrix += sum.matrix;
            normal.gradient += sum.gradient;
        }
        normal
    }

    /// Step of window `window`'s start that goes with this parameter step.
    pub fn start_step(&self, window: usize, parameter_step: &DVector<f64>) -> DVector<f64> {
        let block = &self.blocks[window];
        let of_motion = self.motions[block.motion].step(parameter_step);
        let (values, unknowns) = (parameter_step.len(), of_motion.len());
        let mut shared = parameter_step
            .clone()
            .resize_vertically(values + unknowns, 0.0);
        shared.rows_mut(values, unknowns).copy_from(&of_motion);
        let mut step = &block.inverse * (&block.gradient - &block.coupling * shared);
        for (&place, own) in block.of_motion.iter().zip(of_motion.iter()) {
            step[place] = *own;
        }
        step
    }
}
