//! Bounded least squares by Levenberg-Marquardt on the multiple-shooting residual.
//!
//! Levenberg (1944), Marquardt (1963); bounds by projection: a parameter on its bound whose descent points
//! outward takes no part in the step. Derivatives are finite differences, one simulation per parameter and one
//! per unknown of the windows' start states, all in parallel.

use super::data::Data;
use super::node::{Guess, Node};
use super::normal::{Normal, WindowJacobian};
use super::residual::{Residuals, motion_residuals, residuals};
use crate::model::{Model, ParameterPath};
use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

/// When to stop.
#[derive(Debug, Clone, Copy)]
pub struct FitOptions {
    /// Most iterations, each one linearisation.
    pub iterations: usize,
    /// Stop when the cost falls by less than this share.
    pub tolerance: f64,
}

impl Default for FitOptions {
    fn default() -> Self {
        FitOptions {
            iterations: 30,
            tolerance: 1e-5,
        }
    }
}

/// A fitted model.
#[derive(Debug, Clone)]
pub struct Fit {
    /// The model at the fitted values.
    pub model: Model,
    /// What was free.
    pub free: Vec<ParameterPath>,
    /// Start state of every window.
    pub nodes: Vec<Node>,
    /// Weighted residuals at the end.
    pub residuals: Residuals,
    /// Whether the tolerance was met before the iterations ran out.
    pub converged: bool,
    /// Simulations of the whole data that it took.
    pub simulations: usize,
    pub(super) jacobian: Vec<WindowJacobian>,
}

impl Fit {
    /// Fitted values in the order of `free`.
    pub fn values(&self) -> Vec<f64> {
        self.free
            .iter()
            .map(|path| path.get(&self.model).unwrap_or(f64::NAN))
            .collect()
    }

    /// Which values lie on a bound: a warning, not a result.
    pub fn on_bound(&self) -> Vec<bool> {
        self.free
            .iter()
            .zip(self.values())
            .map(|(path, value)| {
                let (low, high) = path.bounds(&self.model);
                let near = |bound: f64| (value - bound).abs() <= 1e-9 * bound.abs().max(1e-6);
                near(low) || near(high)
            })
            .collect()
    }
}

/// Fits the free parameters and every window's start state; nodes are guessed where none are given.
pub fn fit(
    model: &Model,
    free: &[ParameterPath],
    data: &Data,
    nodes: Option<&[Node]>,
    options: FitOptions,
) -> Fit {
    let guesses: Vec<Guess> = data.windows.iter().map(|w| Guess::of(data, w)).collect();
    let nodes = nodes.map_or_else(
        || guesses.iter().map(|g| g.node.clone()).collect(),
        <[Node]>::to_vec,
    );
    Search::new(model, free, data, guesses, nodes).run(options)
}

/// Fits only the windows' start states: how the model, as it is, does on these motions.
pub fn settle(model: &Model, data: &Data) -> Fit {
    fit(
        model,
        &[],
        data,
        None,
        FitOptions {
            iterations: 8,
            tolerance: 1e-5,
        },
    )
}

struct Search<'a> {
    free: &'a [ParameterPath],
    data: &'a Data,
    guesses: Vec<Guess>,
    model: Model,
    nodes: Vec<Node>,
    residuals: Residuals,
    simulations: usize,
}

impl<'a> Search<'a> {
    fn new(
        model: &Model,
        free: &'a [ParameterPath],
        data: &'a Data,
        guesses: Vec<Guess>,
        nodes: Vec<Node>,
    ) -> Self {
        let residuals = residuals(model, data, &nodes);
        Search {
            free,
            data,
            guesses,
            model: model.clone(),
            nodes,
            residuals,
            simulations: 1,
        }
    }

    fn run(mut self, options: FitOptions) -> Fit {
        let mut damping = 1e-3;
        let mut converged = false;
        let mut quiet = 0;
        let mut jacobian = self.jacobian();
        for _ in 0..options.iterations {
            let before = self.cost();
            let Some(fall) = self.step(&jacobian, &mut damping) else {
                converged = true;
                break;
            };
            jacobian = self.jacobian();
            quiet = if fall < options.tolerance * before {
                quiet + 1
            } else {
                0
            };
            if quiet >= 2 || before - fall <= 0.0 {
                converged = true;
                break;
            }
        }
        Fit {
            model: self.model,
            free: self.free.to_vec(),
            nodes: self.nodes,
            residuals: self.residuals,
            converged,
            simulations: self.simulations,
            jacobian,
        }
    }

    /// Squared residuals plus the nodes' weak priors.
    fn cost(&self) -> f64 {
        self.residuals.cost() + self.prior_cost(&self.nodes)
    }

    fn prior_cost(&self, nodes: &[Node]) -> f64 {
        let mut sum = 0.0;
        for (node, guess) in nodes.iter().zip(&self.guesses) {
            let (precision, pull) = self.prior(node, guess);
            sum += precision.component_mul(&pull).dot(&pull);
        }
        sum
    }

    /// Precision of each unknown of a node and its distance to the guess.
    fn prior(&self, node: &Node, guess: &Guess) -> (DVector<f64>, DVector<f64>) {
        let (mut node, mut middle) = (node.clone(), guess.node.clone());
        let unknowns = node.unknowns();
        let precision = DVector::from_fn(unknowns, |i, _| guess.deviation[i].powi(-2));
        let pull = DVector::from_fn(unknowns, |i, _| *middle.at(i) - *node.at(i));
        (precision, pull)
    }

    /// Tries steps with growing damping until one lowers the cost; `None` when none does.
    fn step(&mut self, jacobian: &[WindowJacobian], damping: &mut f64) -> Option<f64> {
        let before = self.cost();
        for _ in 0..9 {
            let normal = Normal::assemble(self.free.len(), jacobian, *damping);
            let (model, moved) = self.moved(&normal, *damping);
            let mut nodes = self.nodes.clone();
            for (window, node) in nodes.iter_mut().enumerate() {
                let step = normal.node_step(window, &moved);
                for i in 0..node.unknowns() {
                    *node.at(i) += step[i];
                }
                self.guesses[window].clamp(node);
            }
            let residuals = residuals(&model, self.data, &nodes);
            self.simulations += 1;
            let after = residuals.cost() + self.prior_cost(&nodes);
            if after < before {
                self.model = model;
                self.nodes = nodes;
                self.residuals = residuals;
                *damping = (*damping / 8.0).max(1e-9);
                return Some(before - after);
            }
            *damping = (*damping * 6.0).max(1e-6);
        }
        None
    }

    /// The model after a damped, bounded step, and the step really taken.
    fn moved(&self, normal: &Normal, damping: f64) -> (Model, DVector<f64>) {
        let count = self.free.len();
        let values: Vec<f64> = self
            .free
            .iter()
            .map(|p| p.get(&self.model).unwrap_or(0.0))
            .collect();
        let bounds: Vec<(f64, f64)> = self.free.iter().map(|p| p.bounds(&self.model)).collect();
        let mut fixed: Vec<bool> = (0..count)
            .map(|i| {
                let outward = normal.gradient[i];
                (values[i] <= bounds[i].0 && outward < 0.0)
                    || (values[i] >= bounds[i].1 && outward > 0.0)
            })
            .collect();
        let mut moved = DVector::zeros(count);
        // A step that hits a bound stops there; the others are solved again without it.
        for _ in 0..=count {
            let step = solve_damped(normal, &fixed, &moved, damping);
            let hit = (0..count).find(|&i| {
                !fixed[i]
                    && (values[i] + step[i] < bounds[i].0 || values[i] + step[i] > bounds[i].1)
            });
            match hit {
                Some(i) => {
                    fixed[i] = true;
                    moved[i] = (values[i] + step[i]).clamp(bounds[i].0, bounds[i].1) - values[i];
                }
                None => {
                    for i in (0..count).filter(|&i| !fixed[i]) {
                        moved[i] = limited(values[i], bounds[i], step[i]);
                    }
                    break;
                }
            }
        }
        let mut model = self.model.clone();
        for i in 0..count {
            let known = self.free[i].set(&mut model, values[i] + moved[i]);
            debug_assert!(known, "a free parameter is one of the model's");
        }
        (model, moved)
    }

    fn jacobian(&mut self) -> Vec<WindowJacobian> {
        let parameters = self.free.len();
        let unknowns = self.nodes.first().map_or(0, Node::unknowns);
        let tasks: Vec<(usize, usize)> = (0..parameters + unknowns)
            .flat_map(|column| (0..self.data.motions.len()).map(move |motion| (column, motion)))
            .collect();
        let columns: Vec<(f64, Vec<Vec<f64>>)> = tasks
            .par_iter()
            .map(|&(column, motion)| self.column(column, motion))
            .collect();
        self.simulations += parameters + unknowns;
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
                    let (delta, shifted) = &columns[column * motions + window.motion];
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
        let delta = if unknown < joints { 0.1 * sigma } else { sigma };
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

/// Solves (H + damping diag H) step = gradient over the unfixed parameters, given the fixed ones' steps.
fn solve_damped(
    normal: &Normal,
    fixed: &[bool],
    moved: &DVector<f64>,
    damping: f64,
) -> DVector<f64> {
    let open: Vec<usize> = (0..fixed.len()).filter(|&i| !fixed[i]).collect();
    let mut step = moved.clone();
    if open.is_empty() {
        return step;
    }
    let scale: Vec<f64> = open
        .iter()
        .map(|&i| normal.matrix[(i, i)].max(1e-30).sqrt())
        .collect();
    let matrix = DMatrix::from_fn(open.len(), open.len(), |r, c| {
        let value = normal.matrix[(open[r], open[c])] / (scale[r] * scale[c]);
        if r == c {
            value * (1.0 + damping) + 1e-12
        } else {
            value
        }
    });
    let right = DVector::from_fn(open.len(), |r, _| {
        let known: f64 = (0..fixed.len())
            .filter(|&j| fixed[j])
            .map(|j| normal.matrix[(open[r], j)] * moved[j])
            .sum();
        (normal.gradient[open[r]] - known) / scale[r]
    });
    let solution = matrix
        .clone()
        .cholesky()
        .map(|c| c.solve(&right))
        .or_else(|| matrix.lu().solve(&right))
        .unwrap_or_else(|| DVector::zeros(open.len()));
    for (k, &i) in open.iter().enumerate() {
        step[i] = solution[k] / scale[k];
    }
    step
}

/// A value's natural size, for the step of a finite difference where the value itself is zero.
fn scale(path: &ParameterPath) -> f64 {
    match path {
        ParameterPath::Effect { id, parameter, .. } => crate::effects::named(id)
            .and_then(|effect| effect.card().parameters.get(*parameter))
            .and_then(|parameter| parameter.starts.first())
            .map_or(1e-3, |start| start.abs().max(1e-6)),
        _ => 1e-9,
    }
}

/// A quantity that is always positive is not moved by more than a factor of 4 at once.
fn limited(value: f64, bounds: (f64, f64), step: f64) -> f64 {
    if bounds.0 > 0.0 {
        (value + step).clamp(value / 4.0, value * 4.0) - value
    } else {
        step
    }
}

fn difference(path: &ParameterPath) -> f64 {
    match path {
        ParameterPath::Effect { id, .. } => {
            crate::effects::named(id).map_or(2e-4, |effect| effect.difference())
        }
        _ => 2e-4,
    }
}
