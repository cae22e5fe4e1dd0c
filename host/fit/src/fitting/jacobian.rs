//! Derivatives of the residual by finite differences: one simulation per parameter and one per
//! unknown of the windows' start states, all in parallel.

use super::levenberg_marquardt::LevenbergMarquardt;
use super::motion_start::MotionStart;
use super::normal::WindowJacobian;
use super::residual::{motion_residuals, motion_residuals_beside};
use crate::model::ParameterPath;
use crate::sim::HiddenQuantity;
use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

/// What moves an unknown in every window: its steps in the windows of each motion, and their
/// residuals after them.
struct Differences {
    motions: usize,
    /// Per unknown: the place of its columns, if it was moved.
    places: Vec<Option<usize>>,
    columns: Vec<Column>,
}

/// Of one unknown and one motion: window by window the step and the residuals after it.
type Column = (Vec<f64>, Vec<Vec<f64>>);

impl LevenbergMarquardt<'_> {
    /// Derivatives at the present values, window by window.
    pub fn jacobian(&mut self) -> Vec<WindowJacobian> {
        let parameters = self.fit.free.len();
        let window_start = self.fit.window_starts.first();
        let unknowns = window_start.map_or(0, |window_start| window_start.unknowns.len());
        // Without a sensor that trails, a start's acceleration changes nothing.
        let orders = if self.fit.model.trails() { 3 } else { 2 };
        let joints = self.data.joints();
        let moved = (0..orders * joints).chain(3 * joints..unknowns);
        let moved = moved.map(|unknown| parameters + unknown);
        let differences = self.differences((0..parameters).chain(moved));
        let windows = self.places().map(|(w, motion, at)| {
            let base = &self.fit.residuals.windows[w];
            let of = |row: usize, column: usize| differences.of(base, motion, at, row, column);
            let of_node = |row: usize, column: usize| of(row, parameters + column);
            let parameters = DMatrix::from_fn(base.len(), parameters, of);
            self.window(
                w,
                parameters,
                DMatrix::from_fn(base.len(), unknowns, of_node),
            )
        });
        windows.collect()
    }

    /// Derivatives of a fit that had the first parameters, joined by those of the others at the
    /// present values.
    pub fn extended(&mut self, known: &[WindowJacobian]) -> Vec<WindowJacobian> {
        let parameters = self.fit.free.len();
        let had = known.first().map_or(0, |window| window.parameters.ncols());
        let differences = self.differences(had..parameters);
        let windows = self.places().map(|(w, motion, at)| {
            let (base, known) = (&self.fit.residuals.windows[w], &known[w]);
            let parameters = DMatrix::from_fn(base.len(), parameters, |row, column| {
                if column < had {
                    known.parameters[(row, column)]
                } else {
                    differences.of(base, motion, at, row, column)
                }
            });
            self.window(w, parameters, known.all_starts())
        });
        windows.collect()
    }

    /// Simulates with each of these unknowns moved: parameters come first, then those of the start
    /// states.
    fn differences(&mut self, unknowns: impl Iterator<Item = usize>) -> Differences {
        let motions = self.data.motions.len();
        let unknowns: Vec<usize> = unknowns.collect();
        let mut places = vec![None; unknowns.last().map_or(0, |last| last + 1)];
        for (place, unknown) in unknowns.iter().enumerate() {
            places[*unknown] = Some(place);
        }
        let tasks: Vec<(usize, usize)> = unknowns
            .iter()
            .flat_map(|unknown| (0..motions).map(move |motion| (*unknown, motion)))
            .collect();
        let columns: Vec<Column> = tasks
            .par_iter()
            .map(|&(unknown, motion)| {
                if unknown < self.fit.free.len() {
                    self.parameter_column(unknown, motion)
                } else {
                    self.node_column(unknown - self.fit.free.len(), motion)
                }
            })
            .collect();
        self.fit.simulations += unknowns.len();
        Differences {
            motions,
            places,
            columns,
        }
    }

    /// Every window, its motion, and its index among the windows of that motion.
    fn places(&self) -> impl Iterator<Item = (usize, usize, usize)> + use<'_> {
        let mut seen = vec![0; self.data.motions.len()];
        let windows = self.data.windows.iter().enumerate();
        windows.map(move |(w, window)| {
            seen[window.motion] += 1;
            (w, window.motion, seen[window.motion] - 1)
        })
    }

    /// Unknowns of a start that are those of a whole motion.
    fn of_motion(&self) -> Vec<usize> {
        let hidden = self.hidden.iter().zip(3 * self.data.joints()..);
        let of_motion = hidden.filter(|(hidden, _)| hidden.quantity.is_of_motion());
        of_motion.map(|(_, unknown)| unknown).collect()
    }

    fn window(
        &self,
        w: usize,
        parameters: DMatrix<f64>,
        mut window_start: DMatrix<f64>,
    ) -> WindowJacobian {
        let (guess, own) = (&self.guesses[w], &self.fit.window_starts[w]);
        let mut window = WindowJacobian {
            motion: self.data.windows[w].motion,
            residual: DVector::from_column_slice(&self.fit.residuals.windows[w]),
            parameters,
            motion_start: MotionStart::parted_from(&mut window_start, &self.of_motion()),
            start_precision: DVector::zeros(window_start.ncols()),
            start_pull: DVector::zeros(window_start.ncols()),
            start_edge: vec![0.0; window_start.ncols()],
            window_start,
        };
        window.know_start(guess.prior(own), guess.edges(own));
        window
    }

    /// Residuals of one motion with a parameter moved by a small amount.
    fn parameter_column(&self, parameter: usize, motion: usize) -> Column {
        let (fit, path) = (&self.fit, &self.fit.free[parameter]);
        let value = path.get(&fit.model).unwrap_or(0.0);
        let (_, high) = path.bounds(&fit.model);
        let size = difference(path, value);
        let delta = if value + size > high { -size } else { size };
        let mut model = fit.model.clone();
        let known = path.set(&mut model, value + delta);
        debug_assert!(known, "a free parameter is one of the model's");
        let shifted = motion_residuals(&model, self.data, &fit.window_starts, motion);
        (vec![delta; shifted.len()], shifted)
    }

    /// Residuals of one motion with an unknown of all its windows' start states moved by a small
    /// amount.
    fn node_column(&self, unknown: usize, motion: usize) -> Column {
        let (fit, joints) = (&self.fit, self.data.joints());
        let step = |order: usize, joint: usize| self.data.sigma[joint] * DIFFERENCES[order];
        let hidden = unknown.checked_sub(3 * joints).map(|i| self.hidden[i]);
        let delta = |value: f64| match hidden.map(|hidden| (hidden.quantity, hidden.joint)) {
            None => step(unknown / joints, unknown % joints),
            // Towards the middle: beyond a flank is nothing.
            Some((HiddenQuantity::Share { .. } | HiddenQuantity::Before { .. }, _)) => {
                -SHARE_DIFFERENCE.copysign(value)
            }
            Some((HiddenQuantity::Place { .. } | HiddenQuantity::Speed { .. }, _)) => {
                -BODY_DIFFERENCE.copysign(value)
            }
            Some((HiddenQuantity::Amount { .. }, _)) => {
                -SHARE_DIFFERENCE.copysign(value - SHARE_DIFFERENCE)
            }
            Some((HiddenQuantity::Rate, joint)) => step(1, joint),
        };
        let mut window_starts = fit.window_starts.clone();
        let mut deltas = Vec::new();
        for (index, _) in self.data.windows_of(motion) {
            let value = &mut window_starts[index].unknowns[unknown];
            deltas.push(delta(*value));
            *value += delta(*value);
        }
        let (model, known) = (&fit.model, &fit.residuals);
        let shifted = motion_residuals_beside(model, self.data, &window_starts, motion, known);
        (deltas, shifted)
    }
}

impl Differences {
    /// Derivative of a row of a window, the `at`th of its motion; zero of unknowns not moved.
    fn of(&self, base: &[f64], motion: usize, at: usize, row: usize, column: usize) -> f64 {
        let Some(place) = self.places.get(column).copied().flatten() else {
            return 0.0;
        };
        let (deltas, shifted) = &self.columns[place * self.motions + motion];
        // Residual is measured minus predicted, so the prediction's derivative has the other sign.
        (base[row] - shifted[at][row]) / deltas[at]
    }
}

/// Steps of the differences in a start's angle, speed and acceleration, in standard deviations of a
/// reading (per second, per second squared).
const DIFFERENCES: [f64; 3] = [0.1, 1.0, 20.0];

/// Step of the difference in a share of what something hidden can be displaced by.
const SHARE_DIFFERENCE: f64 = 0.02;

/// The same of where a body may be, and how fast it may move: both are far more than they mostly
/// are.
const BODY_DIFFERENCE: f64 = 0.002;

/// Step of the finite difference of a value.
pub(super) fn difference(path: &ParameterPath, value: f64) -> f64 {
    let share = match path {
        ParameterPath::Effect { id, .. } => {
            crate::effects::named(id).map_or(2e-4, |effect| effect.difference())
        }
        _ => 2e-4,
    };
    share * value.abs().max(scale(path))
}

/// A value's natural size, where the value itself is zero.
fn scale(path: &ParameterPath) -> f64 {
    match path {
        ParameterPath::Effect { .. } => path
            .parameter()
            .and_then(|parameter| parameter.starts.first())
            .map_or(1e-3, |start| start.abs().max(1e-6)),
        _ => 1e-9,
    }
}
