//! One step of a fit, kept inside the bounds: a parameter on its bound whose descent points outward
//! takes no part, and one that hits its bound stops there while the others are solved again.

use super::levenberg_marquardt::LevenbergMarquardt;
use super::normal::NormalEquations;
use crate::model::{Model, ParameterPath};
use nalgebra::{DMatrix, DVector};

impl LevenbergMarquardt<'_> {
    /// The model after a damped, bounded step, and the step really taken.
    pub fn moved(&self, normal: &NormalEquations, damping: f64) -> (Model, DVector<f64>) {
        let (free, model) = (&self.fit.free, &self.fit.model);
        let count = free.len();
        let value = |path: &ParameterPath| path.get(model).unwrap_or(0.0);
        let values: Vec<f64> = free.iter().map(value).collect();
        let bounds: Vec<(f64, f64)> = free.iter().map(|path| path.bounds(model)).collect();
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
        let mut model = model.clone();
        for i in 0..count {
            let known = free[i].set(&mut model, values[i] + moved[i]);
            debug_assert!(known, "a free parameter is one of the model's");
        }
        (model, moved)
    }
}

/// Solves (H + damping diag H) step = gradient over the unfixed parameters, given the fixed ones'
/// steps.
fn solve_damped(
    normal: &NormalEquations,
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

/// A quantity that is always positive is not moved by more than a factor of 4 at once.
fn limited(value: f64, bounds: (f64, f64), step: f64) -> f64 {
    if bounds.0 > 0.0 {
        (value + step).clamp(value / 4.0, value * 4.0) - value
    } else {
        step
    }
}
