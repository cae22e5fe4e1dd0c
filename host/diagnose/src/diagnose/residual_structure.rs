//! How much a right term, still unknown, could gain after the best explanation: the structure of
//! the residual.
//!
//! A sum of free-form probes (bumps of torque in speed, in angle, in drive torque; shifts in time;
//! bumps of the reading ...) is fitted to what is left of the training motions by ridge regression
//! on the linearised simulation, and judged on the held-out ones. What it gains there is structure,
//! not noise.

use super::block_errors::{BlockErrors, PairedSums, bootstrap, paired};
use super::findings::ResidualStructure;
use super::terms::{Term, terms};
use crate::effects::ProbeVariable;
use crate::fitting::{
    Fit, FitOptions, FitProblem, Projector, Residuals, change, fit as refit, fit_start_states,
};
use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

/// Least ridge on columns of unit length: the linearisation itself is no better.
const RIDGE: f64 = 1e-2;

/// A fit linearised: what start states could explain is taken out of residual and columns.
struct Linearised {
    residual: DVector<f64>,
    /// The change that each probe makes.
    probes: Vec<DVector<f64>>,
    /// The change that each free parameter makes.
    parameters: Vec<DVector<f64>>,
}

impl Linearised {
    fn new(fit: &Fit, data: &FitProblem, terms: &[Term]) -> Linearised {
        let projector = Projector::off_start_states(fit);
        let before = &fit.residuals.windows;
        let column = |term: &Term| {
            let (candidate, values) = (term.candidate, &term.values);
            let moved = change(
                &fit.model,
                candidate,
                values,
                data,
                &fit.window_starts,
                before,
            );
            flat(&projector.off(&moved))
        };
        Linearised {
            residual: flat(&projector.off(before)),
            probes: terms.par_iter().map(column).collect(),
            parameters: projector.parameter_columns(),
        }
    }
}

/// What is left to explain, judged on held-out motions; `None` with nothing left above the noise.
pub(super) fn residual_structure(
    fit: &Fit,
    training: &FitProblem,
    held_out: &FitProblem,
    seed: u64,
) -> Option<ResidualStructure> {
    let settled = fit_start_states(&fit.model, held_out);
    let before = BlockErrors::of(&settled.residuals, held_out);
    if before.is_noise() {
        return None;
    }
    // The fitted values on other motions, with the derivatives there.
    let (window_starts, options) = (Some(&settled.window_starts[..]), FitOptions::iterations(0));
    let elsewhere = refit(&fit.model, &fit.free, held_out, window_starts, options);
    let mut terms = terms(&fit.model, training);
    let mut seen = Linearised::new(fit, training, &terms);
    let mut unseen = Linearised::new(&elsewhere, held_out, &terms);
    let kept = comparable(&terms, &seen.probes, &unseen.probes);
    keep(&mut terms, &kept);
    keep(&mut seen.probes, &kept);
    keep(&mut unseen.probes, &kept);

    let weights = regress(&seen);
    let mut left = unseen.residual;
    let columns = unseen.probes.iter().chain(&unseen.parameters);
    for (column, weight) in columns.zip(weights.iter()) {
        left.axpy(-weight, column, 1.0);
    }
    let after = BlockErrors::of(&split_like(&left, &elsewhere.residuals), held_out);
    let samples = before.count() as f64;
    let share = |motions: &[PairedSums]| {
        let sum = |part: fn(&PairedSums) -> f64| motions.iter().map(part).sum::<f64>();
        let (before, after) = (sum(|m| m.before), sum(|m| m.after));
        (before - after) / (before - samples).max(0.05 * samples)
    };
    Some(ResidualStructure {
        explainable_share: share(&paired(&before, &after)),
        explainable_low: bootstrap(&before, &after, seed, share)[0],
        shape: shape(&terms, &seen.probes, &weights),
    })
}

fn keep<T>(items: &mut Vec<T>, kept: &[bool]) {
    let mut at = kept.iter();
    items.retain(|_| *at.next().unwrap_or(&false));
}

/// Which terms act on the training motions about as much as on the others of their kind and on the
/// held-out motions: what training hardly shows can't be carried over.
fn comparable(terms: &[Term], seen: &[DVector<f64>], unseen: &[DVector<f64>]) -> Vec<bool> {
    let strength = |column: &DVector<f64>| column.norm() / (column.len().max(1) as f64).sqrt();
    let is_comparable = |(i, term): (usize, &Term)| {
        let same_kind = terms.iter().zip(seen);
        let same_kind = same_kind.filter(|(other, _)| other.variable == term.variable);
        let most = same_kind
            .map(|(_, column)| strength(column))
            .fold(0.0, f64::max);
        let own = strength(&seen[i]);
        own > 0.1 * most && own > 1e-9 && strength(&unseen[i]) < 3.0 * own
    };
    terms.iter().enumerate().map(is_comparable).collect()
}

/// Weights of the probes, then of the parameters' shifts, by ridge regression.
///
/// A priori the probes share what is left above the noise; the parameters may shift freely.
fn regress(linearised: &Linearised) -> DVector<f64> {
    let (probes, target) = (linearised.probes.len(), &linearised.residual);
    let columns: Vec<&DVector<f64>> = linearised
        .probes
        .iter()
        .chain(&linearised.parameters)
        .collect();
    let count = columns.len();
    let lengths: Vec<f64> = columns.iter().map(|c| c.norm().max(1e-12)).collect();
    let excess = (target.norm_squared() - target.len() as f64).max(1.0);
    let mut normal = DMatrix::from_fn(count, count, |r, c| {
        columns[r].dot(columns[c]) / (lengths[r] * lengths[c])
    });
    for i in 0..count {
        normal[(i, i)] += if i < probes {
            (probes as f64 / excess).max(RIDGE)
        } else {
            1e-9
        };
    }
    let right = DVector::from_fn(count, |r, _| columns[r].dot(target) / lengths[r]);
    let scaled = normal.cholesky().map(|cholesky| cholesky.solve(&right));
    let scaled = scaled.unwrap_or_else(|| DVector::zeros(count));
    DVector::from_fn(count, |i, _| scaled[i] / lengths[i])
}

/// The two kinds of terms that carry most of the free form, in words.
fn shape(terms: &[Term], columns: &[DVector<f64>], weights: &DVector<f64>) -> String {
    let mut groups: Vec<(f64, &'static str)> = Vec::new();
    for variable in ProbeVariable::ALL {
        let mut sum = DVector::zeros(columns.first().map_or(0, DVector::len));
        let own = terms.iter().enumerate();
        for (i, _) in own.filter(|(_, term)| term.variable == variable) {
            sum.axpy(weights[i], &columns[i], 1.0);
        }
        groups.push((sum.norm_squared(), variable.words()));
    }
    groups.sort_by(|a, b| b.0.total_cmp(&a.0));
    groups.dedup_by_key(|g| g.1);
    let names: Vec<&str> = groups.iter().take(2).map(|g| g.1).collect();
    names.join("; ")
}

fn flat(windows: &[Vec<f64>]) -> DVector<f64> {
    let length = windows.iter().map(Vec::len).sum();
    DVector::from_iterator(length, windows.iter().flatten().copied())
}

fn split_like(values: &DVector<f64>, like: &Residuals) -> Residuals {
    let mut rest = values.as_slice();
    let windows = like.windows.iter().map(|window| {
        let (head, tail) = rest.split_at(window.len());
        rest = tail;
        head.to_vec()
    });
    Residuals {
        windows: windows.collect(),
        gaps: like.gaps,
    }
}

#[cfg(test)]
mod tests;
