//! One attempt: a set of effects added to the base model, everything refitted, judged on held-out motions.

use super::candidate::Candidate;
use super::score::Score;
use crate::identify::{Data, Fit, FitOptions, Node, Projector, fit, residuals, settle};
use crate::model::Model;

/// A fitted set of effects.
#[derive(Debug, Clone)]
pub(super) struct Trial {
    /// The effects added to the base, in the order they were added.
    pub set: Vec<Candidate>,
    pub fit: Fit,
    pub training: Score,
    /// On held-out motions, once it has come that far.
    pub held_out: Option<Score>,
}

impl Trial {
    /// The base model, fitted.
    pub fn base(fit: Fit, data: &Data) -> Trial {
        Trial {
            set: Vec::new(),
            training: Score::of(&fit, data),
            fit,
            held_out: None,
        }
    }

    /// Number of values the added effects bring.
    pub fn added_values(&self) -> usize {
        self.set
            .iter()
            .map(|c| c.effect.card().parameters.len())
            .sum()
    }

    /// Names of the set, joined.
    pub fn name(&self) -> String {
        self.set
            .iter()
            .map(ToString::to_string)
            .collect::<Vec<_>>()
            .join(" + ")
    }

    /// Whether this trial adds the same effects as that set.
    pub fn adds(&self, set: &[Candidate]) -> bool {
        self.set.len() == set.len() && set.iter().all(|c| self.set.contains(c))
    }

    /// Adds an effect at these values and refits everything, for at most `iterations`.
    pub fn with(
        &self,
        candidate: Candidate,
        values: &[f64],
        data: &Data,
        iterations: usize,
    ) -> Trial {
        let mut model = self.fit.model.clone();
        model.effects.push(candidate.instance(values));
        let mut free = self.fit.free.clone();
        free.extend(candidate.paths());
        let mut set = self.set.clone();
        set.push(candidate);
        let options = FitOptions {
            iterations,
            ..FitOptions::default()
        };
        let fit = fit(&model, &free, data, Some(&self.fit.nodes), options);
        Trial {
            set,
            training: Score::of(&fit, data),
            fit,
            held_out: None,
        }
    }

    /// Goes on fitting where an earlier, short fit stopped.
    pub fn finish(&mut self, data: &Data, iterations: usize) {
        if !self.fit.converged {
            let options = FitOptions {
                iterations,
                ..FitOptions::default()
            };
            self.fit = fit(
                &self.fit.model,
                &self.fit.free,
                data,
                Some(&self.fit.nodes),
                options,
            );
            self.training = Score::of(&self.fit, data);
        }
    }

    /// This trial less one of its effects, at the values it has; not refitted.
    pub fn without(&self, leaving: usize, base: &Trial) -> Trial {
        let out = self.set[leaving];
        let mut rest = self.clone();
        rest.set.remove(leaving);
        rest.held_out = None;
        rest.fit
            .model
            .effects
            .retain(|e| !(e.effect == out.effect && e.joint == out.joint));
        rest.fit.free = base.fit.free.clone();
        rest.fit
            .free
            .extend(rest.set.iter().flat_map(|c| c.paths().collect::<Vec<_>>()));
        rest
    }

    /// Fits again from the present values.
    pub fn refit(&mut self, data: &Data, iterations: usize) {
        self.fit.converged = false;
        self.finish(data, iterations);
    }

    /// Judges the fitted values on motions that took no part in the fit.
    pub fn judge(&mut self, held_out: Option<&Data>) {
        if self.held_out.is_none() {
            self.held_out = held_out.map(|data| Score::of(&settle(&self.fit.model, data), data));
        }
    }

    /// The blocks that decide: held-out ones where there are any.
    pub fn deciding(&self) -> &Score {
        self.held_out.as_ref().unwrap_or(&self.training)
    }

    /// All blocks.
    pub fn pooled(&self) -> Score {
        match &self.held_out {
            Some(held_out) => Score::joined(&[&self.training, held_out]),
            None => self.training.clone(),
        }
    }

    /// Whether an added effect has an amplitude where it vanishes, or any value at the edge of the possible.
    pub fn rests_on_bound(&self) -> bool {
        let on_bound = self.fit.on_bound();
        let added = self.fit.free.len() - self.added_values();
        let mut at = added;
        for candidate in &self.set {
            for parameter in candidate.effect.card().parameters {
                if on_bound[at] && parameter.off.is_some() {
                    return true;
                }
                at += 1;
            }
        }
        false
    }
}

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
    found
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
