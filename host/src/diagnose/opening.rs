//! Where to start a candidate: the values that promise most, found by one simulation each.

use super::candidate::Candidate;
use crate::fitting::{Data, Fit, Node, Projector, residuals};
use crate::model::Model;

/// A promising start for a candidate: values, and how much of the squared residual they could remove.
#[derive(Debug, Clone)]
pub(super) struct Opening {
    pub candidate: Candidate,
    pub values: Vec<f64>,
    pub gain: f64,
}

/// A start of which only a twentieth departs from off: rigs far lighter than a servo arm have smaller effects.
fn small(candidate: Candidate, start: &[f64]) -> Vec<f64> {
    let parameters = candidate.effect.info().parameters;
    parameters
        .iter()
        .zip(start)
        .map(|(parameter, value)| match parameter.off {
            Some(off) if off.is_finite() => off + 0.05 * (value - off),
            _ => *value,
        })
        .collect()
}

/// What a start of a candidate changes in the prediction.
#[derive(Debug, Clone)]
pub(super) struct Change {
    pub candidate: Candidate,
    pub start: Vec<f64>,
    windows: Vec<Vec<f64>>,
}

/// What each start of a candidate changes in the prediction of a fitted model: one simulation each.
///
/// Where an effect comes in many shapes, as a ripple does, each is tried at one amplitude.
pub(super) fn changes(from: &Fit, candidate: Candidate, data: &Data) -> Vec<Change> {
    let mut starts = candidate.starts();
    let mut firsts: Vec<Vec<f64>> = Vec::new();
    for start in &starts {
        let shape = own_shape(candidate, start);
        if !firsts
            .iter()
            .any(|first| own_shape(candidate, first) == shape)
        {
            firsts.push(start.clone());
        }
    }
    if firsts.len() > FEW_SHAPES {
        starts = firsts;
    }
    simulated(from, candidate, starts, data)
}

/// Shapes an effect may have for each to be tried at every amplitude.
const FEW_SHAPES: usize = 4;

/// The changes of all starts of this shape, each as it is and small.
pub(super) fn changes_like(from: &Fit, like: &Change, data: &Data) -> Vec<Change> {
    let candidate = like.candidate;
    let shape = own_shape(candidate, &like.start);
    let mut starts = candidate.starts();
    starts.retain(|start| own_shape(candidate, start) == shape);
    simulated(from, candidate, starts, data)
}

fn simulated(from: &Fit, candidate: Candidate, starts: Vec<Vec<f64>>, data: &Data) -> Vec<Change> {
    starts
        .into_iter()
        .flat_map(|start| [start.clone(), small(candidate, &start)])
        .map(|start| Change {
            windows: change(
                &from.model,
                candidate,
                &start,
                data,
                &from.nodes,
                &from.residuals.windows,
            ),
            candidate,
            start,
        })
        .collect()
}

/// A fitted model that candidates are added to: its residual, and what its own values can imitate.
pub(super) struct Lead<'a> {
    off: Projector<'a>,
    residual: Vec<Vec<f64>>,
}

impl<'a> Lead<'a> {
    pub fn new(fit: &'a Fit) -> Lead<'a> {
        let off = Projector::new(fit);
        Lead {
            residual: off.off(&fit.residuals.windows),
            off,
        }
    }

    /// The best starts of a candidate, best first.
    ///
    /// What each changes in the prediction is projected off what the fitted values could imitate; the rest is scaled
    /// to fit the residual, and the squared error it would remove is its gain.
    pub fn openings<'c>(&self, changes: impl IntoIterator<Item = &'c Change>) -> Vec<Opening> {
        let mut found: Vec<Opening> = changes.into_iter().map(|c| self.opening(c)).collect();
        found.sort_by(|a, b| b.gain.total_cmp(&a.gain));
        let mut shapes: Vec<Vec<f64>> = Vec::new();
        found.retain(|opening| {
            let shape = shape(opening.candidate, &opening.values);
            let fresh = !shapes.contains(&shape);
            if fresh {
                shapes.push(shape);
            }
            fresh
        });
        found
    }

    /// A start scaled to fit the residual.
    pub fn opening(&self, change: &Change) -> Opening {
        let (candidate, start) = (change.candidate, &change.start);
        let moved = self.off.off(&change.windows);
        let (mut along, mut size) = (0.0, 1e-12);
        for (moved, residual) in moved.iter().flatten().zip(self.residual.iter().flatten()) {
            along += moved * residual;
            size += moved * moved;
        }
        let scale = along / size;
        let values = candidate
            .effect
            .info()
            .parameters
            .iter()
            .zip(start)
            .map(|(parameter, value)| match parameter.off {
                Some(off) if off.is_finite() => {
                    let moved = off + (value - off) * scale.clamp(0.02, 20.0);
                    moved.clamp(parameter.bounds.0, parameter.bounds.1)
                }
                _ => *value,
            })
            .collect();
        Opening {
            candidate,
            values,
            gain: if scale > 0.0 {
                along * along / size
            } else {
                0.0
            },
        }
    }
}

/// The values that shape an effect without switching it on or off.
fn own_shape(candidate: Candidate, values: &[f64]) -> Vec<f64> {
    let parameters = candidate.effect.info().parameters;
    parameters
        .iter()
        .zip(values)
        .filter(|(parameter, _)| !parameter.off.is_some_and(f64::is_finite))
        .map(|(_, value)| *value)
        .collect()
}

/// What tells openings apart: one is kept for each.
fn shape(candidate: Candidate, values: &[f64]) -> Vec<f64> {
    let parameters = candidate.effect.info().parameters;
    let mut shape = own_shape(candidate, values);
    // The side of off counts as a shape too: a mass may be missing or be too much.
    shape.extend(
        parameters
            .iter()
            .zip(values)
            .filter_map(|(parameter, value)| {
                Some((value - parameter.off.filter(|o| o.is_finite())?).signum())
            }),
    );
    shape
}

/// How the prediction changes, weighted, when an effect is added: residual before minus residual after.
pub(super) fn change(
    model: &Model,
    candidate: Candidate,
    values: &[f64],
    data: &Data,
    nodes: &[Node],
    before: &[Vec<f64>],
) -> Vec<Vec<f64>> {
    let mut model = model.clone();
    model.effects.push(candidate.instance(values));
    let after = residuals(&model, data, nodes);
    before
        .iter()
        .zip(&after.windows)
        .map(|(before, after)| before.iter().zip(after).map(|(b, a)| b - a).collect())
        .collect()
}
