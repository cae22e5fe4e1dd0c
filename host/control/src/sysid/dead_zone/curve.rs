//! The curve of one side: nothing inside the zone, a line from its edge, saturation.

use super::LEAST;
use nalgebra::{Matrix3, Vector3};

/// Places tried for the zone's edge and for the onset of saturation.
const GRID: usize = 60;
/// Gauss-Newton steps.
const STEPS: usize = 60;
/// Slope, edge, limit; an infinite limit is none.
#[derive(Debug, Clone, Copy)]
pub struct DeadZoneCurve {
    pub slope: f64,
    pub edge: f64,
    pub limit: f64,
}

impl DeadZoneCurve {
    fn output(&self, input: f64) -> f64 {
        (self.slope * (input - self.edge).max(0.0)).min(self.limit)
    }

    pub fn cost(&self, points: &[(f64, f64)]) -> f64 {
        points
            .iter()
            .map(|(u, y)| (y - self.output(*u)).powi(2))
            .sum()
    }

    fn onset(&self) -> f64 {
        self.edge + self.limit / self.slope
    }

    /// Normal matrix and gradient; rows and columns of what the points do not touch stay
    /// zero.
    pub fn normal(&self, points: &[(f64, f64)]) -> (Matrix3<f64>, Vector3<f64>) {
        let (mut matrix, mut gradient) = (Matrix3::zeros(), Vector3::zeros());
        for (u, y) in points {
            let row = if *u >= self.onset() {
                Vector3::new(0.0, 0.0, 1.0)
            } else if *u > self.edge {
                Vector3::new(u - self.edge, -self.slope, 0.0)
            } else {
                continue;
            };
            matrix += row * row.transpose();
            gradient += row * (y - self.output(*u));
        }
        (matrix, gradient)
    }

    /// Gauss and Newton's steps, halved until the error falls.
    fn refined(mut self, points: &[(f64, f64)]) -> DeadZoneCurve {
        let mut cost = self.cost(points);
        for _ in 0..STEPS {
            let (mut matrix, gradient) = self.normal(points);
            for k in 0..3 {
                matrix[(k, k)] += if matrix[(k, k)] == 0.0 { 1.0 } else { 0.0 };
            }
            let Some(step) = matrix.lu().solve(&gradient) else {
                break;
            };
            let better = (0..12).map(|k| 0.5f64.powi(k)).find_map(|share| {
                let trial = DeadZoneCurve {
                    slope: self.slope + share * step[0],
                    edge: self.edge + share * step[1],
                    limit: self.limit + share * step[2],
                };
                let sound = trial.slope > 0.0 && trial.edge >= 0.0 && trial.limit > 0.0;
                (sound && trial.cost(points) < cost).then_some(trial)
            });
            let Some(better) = better else { break };
            self = better;
            let before = std::mem::replace(&mut cost, better.cost(points));
            if before - cost <= 1e-14 * before {
                break;
            }
        }
        self
    }
}

/// The best curve over a grid of edges and onsets, refined.
pub fn best(points: &[(f64, f64)], limited: bool) -> Option<DeadZoneCurve> {
    let mut inputs: Vec<f64> = points.iter().map(|(u, _)| *u).collect();
    inputs.sort_by(f64::total_cmp);
    let places: Vec<f64> = (0..GRID)
        .map(|k| inputs[k * (inputs.len() - 1) / (GRID - 1)])
        .collect();
    let beyond = |onset: f64| inputs.iter().filter(|u| **u >= onset).count();
    let mut curves: Vec<DeadZoneCurve> = Vec::new();
    for edge in std::iter::once(0.0).chain(places.iter().copied()) {
        let onsets: Vec<f64> = if limited {
            places
                .iter()
                .copied()
                .filter(|onset| *onset > edge && beyond(*onset) >= LEAST)
                .collect()
        } else {
            vec![f64::INFINITY]
        };
        for onset in onsets {
            let shape = |u: f64| (u - edge).clamp(0.0, onset - edge);
            let (mut product, mut square) = (0.0, 0.0);
            for (u, y) in points {
                product += shape(*u) * y;
                square += shape(*u).powi(2);
            }
            let slope = product / square;
            if slope > 0.0 && slope.is_finite() {
                let limit = slope * (onset - edge);
                curves.push(DeadZoneCurve { slope, edge, limit });
            }
        }
    }
    curves
        .into_iter()
        .min_by(|a, b| a.cost(points).total_cmp(&b.cost(points)))
        .map(|curve| curve.refined(points))
}
