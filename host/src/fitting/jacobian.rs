//! Derivatives of the residual by finite differences: one simulation per parameter and one per unknown of the
//! windows' start states, all in parallel.

use super::node::Node;
use super::normal::WindowJacobian;
use super::residual::motion_residuals;
use super::search::Search;
use crate::model::ParameterPath;
use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

impl Search<'_> {
    /// Derivatives at the present values, window by window.
    pub fn jacobian(&mut self) -> Vec<WindowJacobian> {
        let parameters = self.free.len();
        let unknowns = self.nodes.first().map_or(0, Node::unknowns);
        // Without a sensor that trails, a start's acceleration changes nothing.
        let joints = self.data.sigma_rad.len();
        let moving = match self.model.trails() {
            true => 3 * joints,
            false => 2 * joints,
        };
        let tasks: Vec<(usize, usize)> = (0..parameters + moving)
            .flat_map(|column| (0..self.data.motions.len()).map(move |motion| (column, motion)))
            .collect();
        let columns: Vec<(f64, Vec<Vec<f64>>)> = tasks
            .par_iter()
            .map(|&(column, motion)| self.column(column, motion))
            .collect();
        self.simulations += parameters + moving;
        let motions = self.data.motions.len();
        let mut index_in_motion = vec![0; motions];
        self.data
            .windows
            .iter()
            .enumerate()
            .map(|(w, window)| {
                let at = index_in_motion[window.motion];
                index_in_motion[window.motion] += 1;
                let base = &self.residuals.windows[w];
                let derivative = |row: usize, column: usize| {
                    let Some((delta, shifted)) = columns.get(column * motions + window.motion)
                    else {
                        return 0.0;
                    };
                    // Residual is measured minus predicted, so the prediction's derivative has the other sign.
                    (base[row] - shifted[at][row]) / delta
                };
                let (node_precision, node_pull) = self.prior(&self.nodes[w], &self.guesses[w]);
                let mut window = WindowJacobian {
                    residual: DVector::from_column_slice(base),
                    parameters: DMatrix::from_fn(base.len(), parameters, derivative),
                    node: DMatrix::from_fn(base.len(), unknowns, |r, c| {
                        derivative(r, parameters + c)
                    }),
                    node_precision,
                    node_pull,
                    node_edge: self.guesses[w].edges(&self.nodes[w]),
                };
                window.hold_edges();
                window
            })
            .collect()
    }

    /// Residuals of one motion with one unknown moved by a small amount.
    fn column(&self, column: usize, motion: usize) -> (f64, Vec<Vec<f64>>) {
        if let Some(path) = self.free.get(column) {
            let value = path.get(&self.model).unwrap_or(0.0);
            let (_, high) = path.bounds(&self.model);
            let size = difference(path) * value.abs().max(scale(path));
            let delta = if value + size > high { -size } else { size };
            let mut model = self.model.clone();
            let known = path.set(&mut model, value + delta);
            debug_assert!(known, "a free parameter is one of the model's");
            return (
                delta,
                motion_residuals(&model, self.data, &self.nodes, motion),
            );
        }
        let unknown = column - self.free.len();
        let joints = self.data.sigma_rad.len();
        let sigma = self.data.sigma_rad[unknown % joints];
        let delta = sigma * DIFFERENCES[unknown / joints];
        let mut nodes = self.nodes.clone();
        for node in &mut nodes {
            *node.at(unknown) += delta;
        }
        (
            delta,
            motion_residuals(&self.model, self.data, &nodes, motion),
        )
    }
}

/// Steps of the differences in a start's angle, speed and acceleration, in standard deviations of a reading (per
/// second, per second squared).
const DIFFERENCES: [f64; 3] = [0.1, 1.0, 20.0];

/// A value's natural size, for the step of a finite difference where the value itself is zero.
fn scale(path: &ParameterPath) -> f64 {
    match path {
        ParameterPath::Effect { id, parameter, .. } => crate::effects::named(id)
            .and_then(|effect| effect.info().parameters.get(*parameter))
            .and_then(|parameter| parameter.starts.first())
            .map_or(1e-3, |start| start.abs().max(1e-6)),
        _ => 1e-9,
    }
}

/// Step of a finite difference, in shares of the value.
fn difference(path: &ParameterPath) -> f64 {
    match path {
        ParameterPath::Effect { id, .. } => {
            crate::effects::named(id).map_or(2e-4, |effect| effect.difference())
        }
        _ => 2e-4,
    }
}
