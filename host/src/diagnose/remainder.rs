//! How much a right term, still unknown, could gain after the best explanation.
//!
//! A sum of free-form probes (bumps of torque in speed, in angle, in drive torque; shifts in time; bumps of the
//! reading ...) is fitted to what is left of the training motions by ridge regression on the linearised
//! simulation, and judged on the held-out ones. What it gains there is structure, not noise.

use super::findings::Remainder;
use super::opening::change;
use super::score::{AT_FLOOR, Score, resampled};
use super::terms::{Term, terms};
use crate::effects::Along;
use crate::fitting::{self, Data, Fit, FitOptions, Projector, settle};
use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

/// Least ridge on columns of unit length: the linearisation itself is no better.
const RIDGE: f64 = 1e-2;

/// What is left to explain, judged on held-out motions; `None` with nothing left above the noise.
pub(super) fn remainder(
    fit: &Fit,
    training: &Data,
    held_out: &Data,
    seed: u64,
) -> Option<Remainder> {
    let settled = settle(&fit.model, held_out);
    let before = Score::of(&settled, held_out);
    if before.rms() < AT_FLOOR {
        return None;
    }
    let unseen = linearised(fit, held_out, &settled);
    let mut terms = terms(&fit.model, training);
    let seen_columns = columns(fit, training, &terms);
    let unseen_columns = columns(&unseen, held_out, &terms);
    let kept = comparable(&terms, &seen_columns, &unseen_columns);
    let pick = |columns: Vec<DVector<f64>>| -> Vec<DVector<f64>> {
        columns
            .into_iter()
            .zip(&kept)
            .filter_map(|(c, keep)| keep.then_some(c))
            .collect()
    };
    let (seen_columns, unseen_columns) = (pick(seen_columns), pick(unseen_columns));
    let mut at = kept.iter();
    terms.retain(|_| *at.next().unwrap_or(&false));

    let target = target(fit);
    let weights = regress(&seen_columns, &parameter_columns(fit), &target);
    let mut left = self::target(&unseen);
    let all = unseen_columns
        .iter()
        .chain(&parameter_columns(&unseen))
        .cloned()
        .collect::<Vec<_>>();
    for (column, weight) in all.iter().zip(weights.iter()) {
        left.axpy(-weight, column, 1.0);
    }
    let after = Score::of_windows(&split_like(&left, &unseen.residuals.windows), held_out);
    let samples = before.counts.iter().sum::<usize>() as f64;
    let share = |before: f64, after: f64| (before - after) / (before - samples).max(0.05 * samples);
    let (low, _) = resampled(&before, &after, seed, share);
    Some(Remainder {
        explainable_share: share(before.sums.iter().sum(), after.sums.iter().sum()),
        explainable_low: low,
        shape: shape(&terms, &seen_columns, &weights),
    })
}

/// The fitted values on other motions, with the derivatives there.
fn linearised(fit: &Fit, data: &Data, settled: &Fit) -> Fit {
    let options = FitOptions {
        iterations: 0,
        ..FitOptions::default()
    };
    fitting::fit(&fit.model, &fit.free, data, Some(&settled.nodes), options)
}

/// The residual, less what start states could make of it.
fn target(fit: &Fit) -> DVector<f64> {
    flat(&Projector::off_start_states(fit).off(&fit.residuals.windows))
}

fn parameter_columns(fit: &Fit) -> Vec<DVector<f64>> {
    Projector::off_start_states(fit).parameter_columns()
}

/// The change each probe makes, less what start states could make of it.
fn columns(fit: &Fit, data: &Data, terms: &[Term]) -> Vec<DVector<f64>> {
    let off = Projector::off_start_states(fit);
    terms
        .par_iter()
        .map(|term| {
            let before = &fit.residuals.windows;
            let moved = change(
                &fit.model,
                term.candidate,
                &term.values,
                data,
                &fit.nodes,
                before,
            );
            flat(&off.off(&moved))
        })
        .collect()
}

/// Which terms act on the training motions about as much as on the others of their kind and on the held-out
/// motions: what training hardly shows can't be carried over.
fn comparable(terms: &[Term], seen: &[DVector<f64>], unseen: &[DVector<f64>]) -> Vec<bool> {
    let strength = |column: &DVector<f64>| column.norm() / (column.len().max(1) as f64).sqrt();
    terms
        .iter()
        .enumerate()
        .map(|(i, term)| {
            let most = terms
                .iter()
                .zip(seen)
                .filter(|(other, _)| other.along == term.along)
                .map(|(_, column)| strength(column))
                .fold(0.0, f64::max);
            let own = strength(&seen[i]);
            own > 0.1 * most && own > 1e-9 && strength(&unseen[i]) < 3.0 * own
        })
        .collect()
}

/// Weights of the probes, then of the parameters' shifts, by ridge regression.
///
/// A priori the probes share what is left above the noise; the parameters may shift freely.
fn regress(
    probes: &[DVector<f64>],
    parameters: &[DVector<f64>],
    target: &DVector<f64>,
) -> DVector<f64> {
    let columns: Vec<&DVector<f64>> = probes.iter().chain(parameters).collect();
    let count = columns.len();
    let lengths: Vec<f64> = columns.iter().map(|c| c.norm().max(1e-12)).collect();
    let excess = (target.norm_squared() - target.len() as f64).max(1.0);
    let mut normal = DMatrix::from_fn(count, count, |r, c| {
        columns[r].dot(columns[c]) / (lengths[r] * lengths[c])
    });
    for i in 0..count {
        normal[(i, i)] += if i < probes.len() {
            (probes.len() as f64 / excess).max(RIDGE)
        } else {
            1e-9
        };
    }
    let right = DVector::from_fn(count, |r, _| columns[r].dot(target) / lengths[r]);
    let scaled = normal
        .cholesky()
        .map_or_else(|| DVector::zeros(count), |c| c.solve(&right));
    DVector::from_fn(count, |i, _| scaled[i] / lengths[i])
}

/// The two kinds of terms that carry most of the free form, in words.
fn shape(terms: &[Term], columns: &[DVector<f64>], weights: &DVector<f64>) -> String {
    let mut groups: Vec<(f64, &'static str)> = Vec::new();
    for along in Along::ALL {
        let mut sum = DVector::zeros(columns.first().map_or(0, DVector::len));
        for (i, _) in terms.iter().enumerate().filter(|(_, t)| t.along == along) {
            sum.axpy(weights[i], &columns[i], 1.0);
        }
        groups.push((sum.norm_squared(), along.words()));
    }
    groups.sort_by(|a, b| b.0.total_cmp(&a.0));
    groups.dedup_by_key(|g| g.1);
    groups
        .iter()
        .take(2)
        .map(|g| g.1)
        .collect::<Vec<_>>()
        .join("; ")
}

fn flat(windows: &[Vec<f64>]) -> DVector<f64> {
    DVector::from_iterator(
        windows.iter().map(Vec::len).sum(),
        windows.iter().flatten().copied(),
    )
}

fn split_like(values: &DVector<f64>, windows: &[Vec<f64>]) -> Vec<Vec<f64>> {
    let mut rest = values.as_slice();
    windows
        .iter()
        .map(|window| {
            let (head, tail) = rest.split_at(window.len());
            rest = tail;
            head.to_vec()
        })
        .collect()
}
