//! Stretches of time within which residuals may be correlated as they like, while those of
//! different stretches are taken for independent.

use super::data::FitProblem;
use super::fit::Fit;
use super::motion_start::reduced_parameters;
use nalgebra::{DMatrix, DVector};

/// Length of a cluster, s: longer than a servo arm rests between two movements. Where a joint rests
/// for longer, as a pendulum does in the end, the cluster goes on.
const LENGTH_S: f64 = 2.0;
/// A rig whose readings do not change for so long before and behind a boundary rests there, s.
const STILL_S: f64 = 0.3;
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
pub(super) fn clusters(fit: &Fit, data: &FitProblem) -> Vec<Cluster> {
    let total_s: f64 = data.motions.iter().map(|m| m.duration_s()).sum();
    let length_s = LENGTH_S.min(total_s / LEAST).max(1e-9);
    let count = fit.free.len();
    let mut clusters: Vec<Cluster> = Vec::new();
    let mut at = None;
    let stretches: Vec<Stretches> = { 0..data.motions.len() }
        .map(|motion| Stretches::of(data, motion, length_s))
        .collect();
    let reduced = reduced_parameters(&fit.jacobian);
    for ((window, columns), residuals) in data
        .windows
        .iter()
        .zip(&reduced)
        .zip(&fit.residuals.windows)
    {
        let samples = window.samples.len();
        let place = |k: usize| {
            let stretches = &stretches[window.motion];
            (window.motion, stretches.holding(window.samples.start + k))
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

/// How far rests pull the values, as squares: an encoder that does not move on misreads by the same
/// amount all the while, by a rounding that no fit sees, for the values take it up. In units of the
/// noise, which is no less than the rounding.
pub(super) fn pull_of_rests(fit: &Fit, data: &FitProblem) -> DMatrix<f64> {
    let count = fit.free.len();
    let mut pull = DMatrix::zeros(count, count);
    let reduced = reduced_parameters(&fit.jacobian);
    for (window, columns) in data.windows.iter().zip(&reduced) {
        let samples = window.samples.len();
        let time_s = &data.motions[window.motion].time_s[window.samples.clone()];
        for signal in (0..data.signals.len()).filter(|signal| data.counts(*signal)) {
            let readings = &data.measured(window.motion, signal)[window.samples.clone()];
            for rest in rests(time_s, readings) {
                let rows = columns.rows(signal * samples + rest.start, rest.len());
                let together = rows.row_sum();
                pull += together.tr_mul(&together);
            }
        }
    }
    pull
}

/// Samples during which a reading does not change, where that lasts.
fn rests(time_s: &[f64], readings: &[f64]) -> Vec<std::ops::Range<usize>> {
    let mut begin = 0;
    let alike = readings.chunk_by(|a, b| a == b).map(|run| {
        begin += run.len();
        begin - run.len()..begin
    });
    let lasts =
        |run: &std::ops::Range<usize>| time_s[run.end - 1] - time_s[run.start] > 2.0 * STILL_S;
    alike.filter(lasts).collect()
}

/// The stretches of a motion: samples at which each but the first begins.
struct Stretches(Vec<usize>);

impl Stretches {
    /// Of about this length, s. None begins while the rig rests: an encoder then misreads by the
    /// same amount all the while, so that every stretch of a rest contradicts what the others tell,
    /// or none does.
    fn of(data: &FitProblem, motion: usize, length_s: f64) -> Stretches {
        let log = &data.motions[motion];
        let pieces = (log.duration_s() / length_s).round().max(1.0) as usize;
        let edge = |piece: usize| {
            let time_s = log.time_s[0] + piece as f64 / pieces as f64 * log.duration_s();
            log.time_s.partition_point(|t| *t < time_s)
        };
        let rests = |sample: usize| {
            let near = |t: &f64| (t - log.time_s[sample]).abs() <= STILL_S;
            let from = log
                .time_s
                .partition_point(|t| !near(t) && *t < log.time_s[sample]);
            let to = log
                .time_s
                .partition_point(|t| near(t) || *t < log.time_s[sample]);
            let counted = (0..data.signals.len()).filter(|signal| data.counts(*signal));
            let mut counted = counted.map(|signal| &data.measured(motion, signal)[from..to]);
            counted.all(|readings| readings.windows(2).all(|pair| pair[0] == pair[1]))
        };
        let edges = (1..pieces).map(edge).filter(|sample| *sample < log.len());
        Stretches(edges.filter(|sample| !rests(*sample)).collect())
    }

    /// Which of them holds a sample.
    fn holding(&self, sample: usize) -> usize {
        self.0.partition_point(|begin| *begin <= sample)
    }
}

#[cfg(test)]
mod tests {
    use super::super::log_tests::{ANGLE, even, pendulum, swing};
    use super::*;
    use crate::fitting::Horizon;

    #[test]
    fn readings_that_last_are_rests_and_others_none() {
        let time_s: Vec<f64> = (0..400).map(|k| 0.01 * f64::from(k)).collect();
        let reading = |k: usize| {
            if (100..300).contains(&k) {
                7.0
            } else {
                (k / 5) as f64
            }
        };
        let readings: Vec<f64> = (0..400).map(reading).collect();
        let found = rests(&time_s, &readings);
        assert_eq!(found.len(), 1);
        assert_eq!((found[0].start, found[0].end), (100, 300));
        assert!(rests(&time_s, &[f64::NAN; 400]).is_empty());
    }

    #[test]
    fn a_rest_is_one_stretch_and_a_swing_several() {
        let model = pendulum(ANGLE, 0.006);
        let mut motion = swing(&model, &[1.0], even(600, 100.0));
        let data = |motion| FitProblem::new(&model, vec![motion], Horizon::Whole);
        let begins = |motion| Stretches::of(&data(motion), 0, 1.0).0;
        assert_eq!(begins(motion.clone()), [100, 200, 300, 400, 500]);
        let angles = &mut motion.position_rad[0];
        let last = angles[250];
        angles[250..].fill(last);
        assert_eq!(begins(motion), [100, 200]);
    }
}
