//! Where to start a candidate: the values that promise most, found by one simulation each.

use super::candidate::Candidate;
use crate::identify::{Data, Fit, Node, Projector, residuals};
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
    let parameters = candidate.effect.card().parameters;
    parameters
        .iter()
        .zip(start)
        .map(|(parameter, value)| match parameter.off {
            Some(off) if off.is_finite() => off + 0.05 * (value - off),
            _ => *value,
        })
        .collect()
}

/// The best starts of a candidate on top of a fitted model, best first.
///
/// Each start costs one simulation. What it changes in the prediction is projected off what the fitted values
/// could imitate; the rest is scaled to fit the residual, and the squared error it would remove is its gain.
pub(super) fn openings(
    from: &Fit,
    off: &Projector,
    candidate: Candidate,
    data: &Data,
) -> Vec<Opening> {
    let residual = off.off(&from.residuals.windows);
    let mut found: Vec<Opening> = candidate
        .starts()
        .into_iter()
        .flat_map(|start| [start.clone(), small(candidate, &start)])
        .map(|start| opening(from, off, &residual, candidate, start, data))
        .collect();
    found.sort_by(|a, b| b.gain.total_cmp(&a.gain));
    let mut shapes: Vec<Vec<f64>> = Vec::new();
    found.retain(|opening| {
        let shape = shape(candidate, &opening.values);
        let fresh = !shapes.contains(&shape);
        if fresh {
            shapes.push(shape);
        }
        fresh
    });
    found
}

/// The values that shape an effect without switching it on or off: openings are kept one for each.
fn shape(candidate: Candidate, values: &[f64]) -> Vec<f64> {
    let parameters = candidate.effect.card().parameters;
    let mut shape: Vec<f64> = parameters
        .iter()
        .zip(values)
        .filter(|(parameter, _)| !parameter.off.is_some_and(f64::is_finite))
        .map(|(_, value)| *value)
        .collect();
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

fn opening(
    from: &Fit,
    off: &Projector,
    residual: &[Vec<f64>],
    candidate: Candidate,
    start: Vec<f64>,
    data: &Data,
) -> Opening {
    let change = change(
        &from.model,
        candidate,
        &start,
        data,
        &from.nodes,
        &from.residuals.windows,
    );
    let change = off.off(&change);
    let (mut along, mut size) = (0.0, 1e-12);
    for (change, residual) in change.iter().flatten().zip(residual.iter().flatten()) {
        along += change * residual;
        size += change * change;
    }
    let scale = along / size;
    let values = candidate
        .effect
        .card()
        .parameters
        .iter()
        .zip(&start)
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
