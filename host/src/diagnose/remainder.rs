//! How much a right term, still unknown, could gain after the best explanation.
//!
//! A sum of free-form probes (bumps of torque in speed, in angle, in drive torque; shifts in time; bumps of the
//! reading ...) is fitted to what is left of the training motions by ridge regression on the linearised
//! simulation, and judged on the held-out ones. What it gains there is structure, not noise.

use super::candidate::Candidate;
use super::findings::Remainder;
use super::score::{Score, resampled};
use super::trial::change;
use crate::effects::Along;
use crate::identify::{Data, Fit, Projector, settle};
use crate::model::{Drive, Model};
use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

/// Ridge on columns of unit length, against a residual of unit weight.
const RIDGE: f64 = 1e-3;

/// A probe with the amplitude at which its effect is measured.
#[derive(Debug, Clone, Copy)]
struct Term {
    along: Along,
    candidate: Candidate,
    values: [f64; 4],
}

/// What is left to explain, judged on held-out motions; `None` without any, or with nothing left above the noise.
pub(super) fn remainder(
    fit: &Fit,
    training: &Data,
    held_out: Option<&Data>,
    seed: u64,
) -> Option<Remainder> {
    let held_out = held_out?;
    let settled = settle(&fit.model, held_out);
    let before = Score::of(&settled, held_out);
    if before.mean() < 1.05 {
        return None;
    }
    let terms = terms(&fit.model, training);
    let (columns, lengths) = columns(fit, training, &terms, None);
    let weights = ridge(
        &columns,
        &flat(&Projector::new(fit).off(&fit.residuals.windows)),
    );
    let (unseen, _) = columns_like(&settled, held_out, &terms, &lengths);
    let mut left = flat(&Projector::new(&settled).off(&settled.residuals.windows));
    for (column, weight) in unseen.iter().zip(weights.iter()) {
        left.axpy(-weight, column, 1.0);
    }
    let after = Score::of_windows(&split_like(&left, &settled.residuals.windows), held_out);
    let samples = before.counts.iter().sum::<usize>() as f64;
    let share = |before: f64, after: f64| (before - after) / (before - samples).max(0.05 * samples);
    let (low, _) = resampled(&before, &after, seed, share);
    Some(Remainder {
        explainable_share: share(before.sums.iter().sum(), after.sums.iter().sum()),
        explainable_low: low,
        shape: shape(&terms, &columns, &weights),
    })
}

fn columns_like(
    fit: &Fit,
    data: &Data,
    terms: &[Term],
    lengths: &[f64],
) -> (Vec<DVector<f64>>, Vec<f64>) {
    columns(fit, data, terms, Some(lengths))
}

/// The change each probe makes, less what the fit could imitate, scaled to unit length (or by given lengths).
fn columns(
    fit: &Fit,
    data: &Data,
    terms: &[Term],
    lengths: Option<&[f64]>,
) -> (Vec<DVector<f64>>, Vec<f64>) {
    let off = Projector::new(fit);
    let made: Vec<(DVector<f64>, f64)> = terms
        .par_iter()
        .enumerate()
        .map(|(i, term)| {
            let before = &fit.residuals.windows;
            let moved = change(
                &fit.model,
                term.candidate,
                &term.values,
                data,
                &fit.nodes,
                before,
            );
            let column = flat(&off.off(&moved));
            let length = lengths.map_or_else(|| column.norm(), |l| l[i]);
            if length > 1e-9 {
                (column / length, length)
            } else {
                (column * 0.0, 1.0)
            }
        })
        .collect();
    made.into_iter().unzip()
}

fn ridge(columns: &[DVector<f64>], target: &DVector<f64>) -> DVector<f64> {
    let count = columns.len();
    let mut normal = DMatrix::from_fn(count, count, |r, c| columns[r].dot(&columns[c]));
    for i in 0..count {
        normal[(i, i)] += RIDGE;
    }
    let right = DVector::from_fn(count, |r, _| columns[r].dot(target));
    normal
        .cholesky()
        .map_or_else(|| DVector::zeros(count), |c| c.solve(&right))
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

/// The probes of every joint, scaled to the range its motions cover.
fn terms(model: &Model, data: &Data) -> Vec<Term> {
    let mut terms = Vec::new();
    for joint in 0..model.link_count() {
        let range = Range::of(model, data, joint);
        let mut add = |along: Along, amplitude: f64, centre: f64, width: f64| {
            terms.push(Term {
                along,
                candidate: Candidate {
                    effect: along.probe(),
                    joint: Some(joint),
                },
                values: [amplitude, along.index(), centre, width],
            });
        };
        let torque = 0.01 * range.torque_nm;
        for share in [-1.0, -0.6, -0.3, -0.12, 0.0, 0.12, 0.3, 0.6, 1.0] {
            add(
                Along::Speed,
                torque,
                share * range.speed_rad_s,
                0.35 * range.speed_rad_s,
            );
        }
        let span = (range.high_rad - range.low_rad) / 6.0;
        for step in 0..7 {
            let centre = range.low_rad + f64::from(step) * span;
            add(Along::Angle, torque, centre, span);
            add(Along::SlideAtAngle, torque, centre, span);
            add(Along::Reading, 1e-3, centre, span);
        }
        for periods in [
            4.0, 6.0, 8.0, 10.0, 12.0, 14.0, 16.0, 18.0, 20.0, 22.0, 24.0,
        ] {
            add(Along::SineOfAngle, 0.3 * torque, periods, 1.0);
            add(Along::CosineOfAngle, 0.3 * torque, periods, 1.0);
        }
        let moment = model.links[joint].inertia_kg_m2
            + model.links[joint].mass_kg * model.links[joint].com_m.powi(2);
        add(Along::Inertia, 0.02 * moment, 0.0, 1.0);
        add(Along::Mass, 0.02 * model.links[joint].mass_kg, 0.0, 1.0);
        add(Along::Tilt, 3e-3, 0.0, 1.0);
        add(Along::ReadingLag, 1e-3, 0.0, 1.0);
        add(Along::ReadingPlay, 1e-3, 0.0, 1.0);
        if model.joints[joint].drive != Drive::Passive {
            for share in [-1.0, -0.5, -0.25, -0.1, 0.0, 0.1, 0.25, 0.5, 1.0] {
                add(
                    Along::DriveTorque,
                    torque,
                    share * range.drive_nm,
                    0.3 * range.drive_nm,
                );
            }
            add(Along::SlideUnderDrive, 0.02, 0.0, 1.0);
            add(Along::Supply, 0.02, 0.0, 1.0);
            add(Along::BackEmf, 0.01 / range.speed_rad_s, 0.0, 1.0);
            add(Along::Late, 1e-3, 0.0, 1.0);
        }
    }
    terms
}

/// What a joint's motions cover.
struct Range {
    low_rad: f64,
    high_rad: f64,
    speed_rad_s: f64,
    drive_nm: f64,
    torque_nm: f64,
}

impl Range {
    fn of(model: &Model, data: &Data, joint: usize) -> Range {
        let positions = || {
            data.motions
                .iter()
                .flat_map(|m| m.position_rad[joint].iter().copied())
        };
        let mut speeds: Vec<f64> = data
            .motions
            .iter()
            .flat_map(|m| {
                let (time, position) = (&m.time_s, &m.position_rad[joint]);
                (3..position.len().saturating_sub(3)).map(move |k| {
                    ((position[k + 3] - position[k - 3]) / (time[k + 3] - time[k - 3])).abs()
                })
            })
            .filter(|w| w.is_finite())
            .collect();
        speeds.sort_by(f64::total_cmp);
        let fast = speeds.get(speeds.len() * 97 / 100).copied().unwrap_or(1.0);
        let full = match &model.joints[joint].drive {
            Drive::Passive => 0.0,
            Drive::Torque => 1.0,
            drive => drive.motor().map_or(0.0, |m| m.stall_torque_nm),
        };
        let largest = data
            .motions
            .iter()
            .filter_map(|m| m.input[joint].as_ref())
            .flatten()
            .fold(0.0, |most: f64, u| most.max(u.abs()));
        let drive = match &model.joints[joint].drive {
            Drive::Torque | Drive::Duty(_) => full * largest,
            _ => full,
        };
        let outer: f64 = model.links[joint..]
            .iter()
            .map(|l| l.mass_kg * (l.com_m.abs() + 0.3 * l.length_m))
            .sum();
        Range {
            low_rad: positions().fold(f64::INFINITY, f64::min),
            high_rad: positions().fold(f64::NEG_INFINITY, f64::max),
            speed_rad_s: fast.max(1e-3),
            drive_nm: drive.max(1e-6),
            torque_nm: (outer * model.gravity_m_s2).max(1e-6),
        }
    }
}
