//! Stretches of time within which residuals may be correlated as they like, while those of
//! different stretches are taken for independent.

use super::data::FitData;
use super::fit::Fit;
use nalgebra::{DMatrix, DVector};

/// Length of a cluster, s: longer than a servo arm rests between two movements.
const LENGTH_S: f64 = 2.0;
/// All motions together give about this many clusters at least, however short they are.
const LEAST: f64 = 10.0;

/// What one stretch says of the values.
#[derive(Debug, Clone)]
pub(super) struct Cluster {
    /// Parameter columns times residuals: where the stretch pulls the values.
    pub score: DVector<f64>,
    /// Parameter columns times themselves: how surely it tells them.
    pub information: DMatrix<f64>,
}

impl Cluster {
    /// What it says of the values at these places.
    pub fn of(&self, places: &[usize]) -> Cluster {
        Cluster {
            score: self.score.select_rows(places),
            information: self.information.select_rows(places).select_columns(places),
        }
    }
}

/// The clusters of a fit, in order of motions and time; windows shorter than a cluster share it.
pub(super) fn clusters(fit: &Fit, data: &FitData) -> Vec<Cluster> {
    let total_s: f64 = data.motions.iter().map(|m| m.duration_s()).sum();
    let length_s = LENGTH_S.min(total_s / LEAST).max(1e-9);
    let count = fit.free.len();
    let mut clusters: Vec<Cluster> = Vec::new();
    let mut at = None;
    for ((window, jacobian), residuals) in data
        .windows
        .iter()
        .zip(&fit.jacobian)
        .zip(&fit.residuals.windows)
    {
        let motion = &data.motions[window.motion];
        let columns = jacobian.reduced_parameters();
        let samples = window.samples.len();
        let place = |k: usize| {
            let pieces = (motion.duration_s() / length_s).round().max(1.0);
            let share = (motion.time_s[window.samples.start + k] - motion.time_s[0])
                / motion.duration_s().max(1e-9);
            (window.motion, (share * pieces).min(pieces - 1.0) as usize)
        };
        let mut begin = 0;
        while begin < samples {
            let here = place(begin);
            let end = (begin..samples)
                .find(|&k| place(k) != here)
                .unwrap_or(samples);
            if at != Some(here) {
                at = Some(here);
                clusters.push(Cluster {
                    score: DVector::zeros(count),
                    information: DMatrix::zeros(count, count),
                });
            }
            if let Some(cluster) = clusters.last_mut() {
                for signal in 0..data.signals.len() {
                    let first = signal * samples + begin;
                    let rows = columns.rows(first, end - begin);
                    let residuals = DVector::from_column_slice(&residuals[first..][..end - begin]);
                    cluster.score += rows.tr_mul(&residuals);
                    cluster.information += rows.tr_mul(&rows);
                }
            }
            begin = end;
        }
    }
    clusters
}
