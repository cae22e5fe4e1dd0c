//! Where to start the fit of a candidate: the values that promise most, found by one simulation
//! each.

use super::candidate::Candidate;
use super::data::FitProblem;
use super::fit::Fit;
use super::projector::Projector;
use super::residual::residuals;
use super::window_start::WindowStart;
use crate::model::Model;
use nalgebra::{DMatrix, DVector};

/// Initial values for a candidate, and how much of the squared residual they could remove.
#[derive(Debug, Clone)]
pub struct InitialGuess {
    /// The candidate.
    pub candidate: Candidate,
    /// Its values.
    pub values: Vec<f64>,
    /// What they could remove.
    pub gain: f64,
}

/// What a start of a candidate changes in the prediction.
#[derive(Debug, Clone)]
pub struct PredictionChange {
    /// The candidate.
    pub candidate: Candidate,
    /// Its values.
    pub start: Vec<f64>,
    windows: Vec<Vec<f64>>,
}

/// In which sizes starts are tried.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Sizes {
    /// As they are.
    Whole,
    /// Small.
    Small,
    /// Both as they are and small.
    Both,
}

impl Sizes {
    /// The starts in these sizes.
    fn of(self, candidate: Candidate, starts: Vec<Vec<f64>>) -> Vec<Vec<f64>> {
        let sized = |start: Vec<f64>| {
            let small = (self != Sizes::Whole).then(|| small(candidate, &start));
            let whole = (self != Sizes::Small).then_some(start);
            [whole, small].into_iter().flatten()
        };
        starts.into_iter().flat_map(sized).collect()
    }
}

/// What each start of a candidate changes in the prediction of a fitted model: one simulation each.
pub fn changes(
    from: &Fit,
    candidate: Candidate,
    sizes: Sizes,
    data: &FitProblem,
) -> Vec<PredictionChange> {
    simulated(
        from,
        candidate,
        &sizes.of(candidate, starts(candidate)),
        data,
    )
}

/// The starts of a candidate. Where an effect comes in many shapes, as a ripple does, each is tried
/// at one amplitude.
fn starts(candidate: Candidate) -> Vec<Vec<f64>> {
    let starts = candidate.starts();
    let firsts = first_of_each(starts.clone(), |start| shape(candidate, start));
    if firsts.len() > FEW_SHAPES {
        firsts
    } else {
        starts
    }
}

/// Shapes an effect may have for each to be tried at every amplitude.
const FEW_SHAPES: usize = 4;

/// The changes of all starts of this shape, each as it is and small.
pub fn changes_like(
    from: &Fit,
    like: &PredictionChange,
    data: &FitProblem,
) -> Vec<PredictionChange> {
    let wanted = shape(like.candidate, &like.start);
    let mut starts = like.candidate.starts();
    starts.retain(|start| shape(like.candidate, start) == wanted);
    let starts = Sizes::Both.of(like.candidate, starts);
    simulated(from, like.candidate, &starts, data)
}

fn simulated(
    from: &Fit,
    candidate: Candidate,
    starts: &[Vec<f64>],
    data: &FitProblem,
) -> Vec<PredictionChange> {
    let before = &from.residuals.windows;
    let changes = starts.iter().map(|start| PredictionChange {
        windows: change(
            &from.model,
            candidate,
            start,
            data,
            &from.window_starts,
            before,
        ),
        candidate,
        start: start.clone(),
    });
    changes.collect()
}

/// Size of a small start.
const SMALL: f64 = 0.05;

/// A start of which only a twentieth departs from off, or one twenty times as large where off is
/// infinite: rigs far lighter than a servo arm have smaller effects.
fn small(candidate: Candidate, start: &[f64]) -> Vec<f64> {
    let parameters = candidate.parameters().iter().zip(start);
    let small = parameters.map(|(parameter, value)| match parameter.off {
        Some(off) if off.is_finite() => off + SMALL * (value - off),
        Some(_) => (value / SMALL).min(parameter.bounds.1),
        None => *value,
    });
    small.collect()
}

/// A fitted model's residual without what its own values can imitate: what candidates are to
/// explain.
pub struct ProjectedResidual<'a> {
    projector: Projector<'a>,
    residual: Vec<Vec<f64>>,
}

impl<'a> ProjectedResidual<'a> {
    /// Of a fit's own residual.
    pub fn new(fit: &'a Fit) -> Self {
        ProjectedResidual::of(fit, &fit.residuals.windows)
    }

    /// The same of another residual, window by window.
    pub fn of(fit: &'a Fit, residual: &[Vec<f64>]) -> Self {
        let projector = Projector::new(fit);
        ProjectedResidual {
            residual: projector.off(residual),
            projector,
        }
    }

    /// Sum of its squares.
    pub fn size(&self) -> f64 {
        let squares = self.residual.iter().flatten().map(|r| r * r);
        squares.sum::<f64>().max(1e-300)
    }

    /// How much of each change of the prediction makes most of the residual, and the share of its
    /// squares that they make together; `None` where they change nothing that the fit cannot.
    pub fn span(&self, changes: &[Vec<Vec<f64>>]) -> Option<(Vec<f64>, f64)> {
        let flat = |windows: Vec<Vec<f64>>| DVector::from_vec(windows.concat());
        let columns = changes
            .iter()
            .map(|change| flat(self.projector.off(change)));
        let columns: Vec<DVector<f64>> = columns.collect();
        let target = flat(self.residual.clone());
        let count = columns.len();
        let lengths: Vec<f64> = columns.iter().map(|c| c.norm().max(1e-300)).collect();
        // Columns of unit length; the ridge keeps those apart that are nearly one.
        let normal = DMatrix::from_fn(count, count, |r, c| {
            let cosine = columns[r].dot(&columns[c]) / (lengths[r] * lengths[c]);
            if r == c { cosine + 1e-9 } else { cosine }
        });
        let right = DVector::from_fn(count, |r, _| columns[r].dot(&target) / lengths[r]);
        let scaled = normal.cholesky()?.solve(&right);
        let made = scaled.dot(&right) / self.size();
        let weights = scaled
            .iter()
            .zip(&lengths)
            .map(|(weight, length)| weight / length);
        Some((weights.collect(), made))
    }

    /// The best starts of a candidate, best first, one for each shape.
    ///
    /// What each changes in the prediction is projected off what the fitted values could imitate;
    /// the rest is scaled to fit the residual, and the squared error it would remove is its gain.
    pub fn guesses<'c>(
        &self,
        changes: impl IntoIterator<Item = &'c PredictionChange>,
    ) -> Vec<InitialGuess> {
        let mut found: Vec<InitialGuess> = changes.into_iter().map(|c| self.guess(c)).collect();
        found.sort_by(|a, b| b.gain.total_cmp(&a.gain));
        first_of_each(found, |guess| signed_shape(guess.candidate, &guess.values))
    }

    /// A start scaled to fit the residual.
    pub fn guess(&self, change: &PredictionChange) -> InitialGuess {
        let candidate = change.candidate;
        let moved = self.projector.off(&change.windows);
        let (mut along, mut size) = (0.0, 1e-12);
        for (moved, residual) in moved.iter().flatten().zip(self.residual.iter().flatten()) {
            along += moved * residual;
            size += moved * moved;
        }
        let scale = along / size;
        let parameters = candidate.parameters().iter().zip(&change.start);
        let values = parameters.map(|(parameter, value)| match parameter.off {
            Some(off) if off.is_finite() => {
                let moved = off + (value - off) * scale.clamp(0.02, 20.0);
                moved.clamp(parameter.bounds.0, parameter.bounds.1)
            }
            _ => *value,
        });
        InitialGuess {
            candidate,
            values: values.collect(),
            gain: if scale > 0.0 {
                along * along / size
            } else {
                0.0
            },
        }
    }

    /// The values with which a candidate, of whose starts these are the changes, makes most of so
    /// many times this, and the share of it that it makes, squared.
    pub fn promise(&self, changes: &[PredictionChange], times: f64) -> Option<(Vec<f64>, f64)> {
        let guess = self.guesses(changes).into_iter().next()?;
        let values = guess.values.iter().zip(guess.candidate.parameters());
        let values = values.map(|(value, parameter)| match parameter.off {
            Some(off) if off.is_finite() => {
                let (low, high) = parameter.bounds;
                (off + times * (value - off)).clamp(low, high)
            }
            _ => *value,
        });
        Some((values.collect(), guess.gain / self.size()))
    }
}

/// The first item of each key, in order.
fn first_of_each<T>(mut items: Vec<T>, key: impl Fn(&T) -> Vec<f64>) -> Vec<T> {
    let mut known: Vec<Vec<f64>> = Vec::new();
    items.retain(|item| {
        let key = key(item);
        let is_new = !known.contains(&key);
        known.push(key);
        is_new
    });
    items
}

/// The values that shape an effect without switching it on or off.
fn shape(candidate: Candidate, values: &[f64]) -> Vec<f64> {
    let parameters = candidate.parameters().iter().zip(values);
    let shaping = parameters.filter(|(parameter, _)| !parameter.off.is_some_and(f64::is_finite));
    shaping.map(|(_, value)| *value).collect()
}

/// The shape, and the side of off: a mass may be missing or be too much.
fn signed_shape(candidate: Candidate, values: &[f64]) -> Vec<f64> {
    let parameters = candidate.parameters().iter().zip(values);
    let sides = parameters.filter_map(|(parameter, value)| {
        Some((value - parameter.off.filter(|off| off.is_finite())?).signum())
    });
    shape(candidate, values).into_iter().chain(sides).collect()
}

/// How the prediction changes, weighted, when an effect is added: residual before minus residual
/// after.
pub fn change(
    model: &Model,
    candidate: Candidate,
    values: &[f64],
    data: &FitProblem,
    window_starts: &[WindowStart],
    before: &[Vec<f64>],
) -> Vec<Vec<f64>> {
    let mut model = model.clone();
    model.effects.push(candidate.instance(values));
    let after = residuals(&model, data, window_starts).windows;
    let difference = |(before, after): (&Vec<f64>, &Vec<f64>)| {
        before.iter().zip(after).map(|(b, a)| b - a).collect()
    };
    before.iter().zip(&after).map(difference).collect()
}
