//! What could stand in for a part of an explanation, and how much of it by the derivatives.

use super::evaluator::Evaluator;
use super::hypothesis::Hypothesis;
use super::values::kinds_of_values;
use crate::fitting::{
    Candidate, Fit, FitOptions, ProjectedResidual, Sizes, changes, fit, residuals,
};
use crate::model::{Model, ParameterPath};
use rayon::prelude::*;

/// An effect or values can stand in for a part if they make at least this share of what it changes,
/// squared. From one start of an effect of several values less may be seen than it can do.
const LEAST_SHARE: f64 = 0.8;
/// A value's change for its derivative, as a share of it; the least that a value counts as.
const MOVED: f64 = 1e-3;
/// Share of a part that is taken out for its derivative.
const LITTLE: f64 = 0.01;

/// A part of an explanation that may be replaced.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum ReplaceablePart {
    Effect(Candidate),
    /// Values of the model file.
    Values(Vec<ParameterPath>),
}

/// An explanation with one part replaced, at the values that the derivatives promise.
pub(super) struct Substitute {
    /// The effects added to the base.
    pub set: Vec<Candidate>,
    /// The values of the model file that take part.
    pub values: Vec<ParameterPath>,
    pub model: Model,
    pub free: Vec<ParameterPath>,
    /// Share of what the part changes, squared, that it can make.
    share: f64,
}

impl ReplaceablePart {
    /// Values it brings.
    fn count(&self) -> usize {
        match self {
            ReplaceablePart::Effect(effect) => effect.parameters().len(),
            ReplaceablePart::Values(paths) => paths.len(),
        }
    }
}

impl Evaluator<'_> {
    /// What may stand in for a part, the best first; `rest` is the explanation without it, with its
    /// derivatives. Nothing that brings more values, unless one factor changes all of them.
    pub fn others(
        &self,
        chosen: &Hypothesis,
        part: &ReplaceablePart,
        rest: &Fit,
    ) -> Vec<Substitute> {
        let made = rest.residuals.less(&chosen.search.residuals);
        let target = ProjectedResidual::of(rest, &made);
        let local = self.small_step_response(chosen, part, rest);
        let little = ProjectedResidual::of(&local.fit, &local.made);
        // So many times a little of the part is all of it.
        let all = (target.size() / little.size()).sqrt();
        let mut set = chosen.set.clone();
        set.retain(|effect| ReplaceablePart::Effect(*effect) != *part);
        let fits = |candidate: &&Candidate| {
            ReplaceablePart::Effect(**candidate) != *part
                && candidate.parameters().len() <= part.count()
                && set
                    .iter()
                    .all(|kept| !kept.overlaps(**candidate, &self.start))
        };
        let by_effect = |&candidate: &Candidate| {
            // What it would change in the base model, which may be far off, says little of it.
            let in_place =
                target.promise(&changes(rest, candidate, Sizes::Whole, &self.search), 1.0)?;
            let on_top = || {
                let changes = changes(&local.fit, candidate, Sizes::Small, &self.search);
                little.promise(&changes, all)
            };
            let (values, share) = if in_place.1 < LEAST_SHARE {
                on_top()?
            } else {
                in_place
            };
            let mut model = rest.model.clone();
            model.effects.push(candidate.instance(&values));
            Some(Substitute {
                set: [&set[..], &[candidate]].concat(),
                values: Vec::new(),
                model,
                free: rest.free.iter().copied().chain(candidate.paths()).collect(),
                share,
            })
        };
        let candidates = self.candidates.par_iter().filter(fits);
        let by_effects = candidates.filter_map(by_effect);
        let values = self.replacing_values(part, rest);
        let by_values = values.into_par_iter().filter_map(|paths| {
            let (moves, share) = self.moves(&paths, &local.fit, &little)?;
            let mut model = rest.model.clone();
            for (path, step) in paths.iter().zip(moves) {
                let (low, high) = path.bounds(&model);
                let to = path.get(&model)? + all * step;
                path.set(&mut model, to.clamp(low, high)).then_some(())?;
            }
            let added = set
                .iter()
                .map(|effect| effect.parameters().len())
                .sum::<usize>();
            // Those of the effects come last.
            let (base, own) = rest.free.split_at(rest.free.len() - added);
            let mut base = base.to_vec();
            base.retain(|path| !paths.contains(path));
            model.forget(&paths);
            Some(Substitute {
                free: [&base[..], &paths[..], own].concat(),
                set: set.clone(),
                values: paths,
                model,
                share,
            })
        });
        let mut others: Vec<Substitute> = by_effects.chain(by_values).collect();
        others.retain(|other| other.share >= LEAST_SHARE);
        others.sort_by(|a, b| b.share.total_cmp(&a.share));
        others
    }

    /// Values, alone and as kinds, that may stand for a part: those that are not free already, or
    /// are known beforehand.
    fn replacing_values(&self, part: &ReplaceablePart, rest: &Fit) -> Vec<Vec<ParameterPath>> {
        let single = self.open_values().into_iter().map(|path| vec![path]);
        let mut values: Vec<Vec<ParameterPath>> = single.collect();
        values.extend(kinds_of_values(&self.start));
        values.retain(|paths| {
            let is_free = |path: &ParameterPath| {
                rest.free.contains(path) && rest.model.uncertain(*path).is_none()
            };
            !paths
                .iter()
                .any(|path| is_free(path) || self.known.contains(path))
                && ReplaceablePart::Values(paths.clone()) != *part
        });
        values
    }

    /// A small share of a part taken out where the explanation stands: there the derivatives of
    /// what is equal to the logs agree, however far the part has gone.
    fn small_step_response(
        &self,
        chosen: &Hypothesis,
        part: &ReplaceablePart,
        rest: &Fit,
    ) -> SmallStepResponse {
        let (model, window_starts) = (&chosen.search.model, Some(&chosen.search.window_starts[..]));
        let fit = fit(
            model,
            &rest.free,
            &self.search,
            window_starts,
            FitOptions::iterations(0),
        );
        let mut model = fit.model.clone();
        match part {
            ReplaceablePart::Effect(effect) => {
                for instance in model.effects.iter_mut().filter(|e| effect.is(e)) {
                    let values = instance.values.iter_mut().zip(effect.parameters());
                    for (value, parameter) in values {
                        match parameter.off {
                            Some(off) if off.is_finite() => *value += LITTLE * (off - *value),
                            Some(_) => *value *= 1.0 + LITTLE,
                            None => {}
                        }
                    }
                }
            }
            ReplaceablePart::Values(paths) => {
                for path in paths {
                    let (from, to) = (path.get(&model), path.get(&self.start));
                    let (from, to) = (from.unwrap_or(0.0), to.unwrap_or(0.0));
                    let known = path.set(&mut model, from + LITTLE * (to - from));
                    debug_assert!(known, "a wrong value is one of the model's");
                }
            }
        }
        let made = residuals(&model, &self.search, &fit.window_starts).less(&fit.residuals);
        SmallStepResponse { fit, made }
    }

    /// How far to move the values, several of them by one factor, to make most of the target, and
    /// the share they make.
    fn moves(
        &self,
        paths: &[ParameterPath],
        at: &Fit,
        target: &ProjectedResidual,
    ) -> Option<(Vec<f64>, f64)> {
        let mut model = at.model.clone();
        let mut steps = Vec::new();
        for path in paths {
            let value = path.get(&at.model)?;
            let step = if value.abs() < MOVED && paths.len() == 1 {
                MOVED * MOVED
            } else {
                MOVED * value
            };
            path.set(&mut model, value + step).then_some(())?;
            steps.push(step);
        }
        let moved = residuals(&model, &self.search, &at.window_starts);
        let (weights, share) = target.span(&[at.residuals.less(&moved)])?;
        let weight = weights[0];
        Some((steps.into_iter().map(|step| weight * step).collect(), share))
    }
}

/// A small share of a part taken out of an explanation.
struct SmallStepResponse {
    /// The explanation where it stands, with the derivatives of the rest.
    fit: Fit,
    /// What the share changes in the prediction.
    made: Vec<Vec<f64>>,
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::search::tests::{evaluator, fitted};

    /// What may stand in for the effect that this arm lacks.
    fn stand_ins(kind: &'static str, values: &[f64]) -> Vec<String> {
        let evaluator = evaluator(1, &[kind]);
        let chosen = fitted(&evaluator, &[kind], [values]);
        let part = ReplaceablePart::Effect(chosen.set[0]);
        let (model, free) = evaluator.without(&chosen, &part);
        let (window_starts, options) = (
            Some(&chosen.search.window_starts[..]),
            FitOptions::iterations(0),
        );
        let rest = fit(&model, &free, &evaluator.search, window_starts, options);
        let others = evaluator.others(&chosen, &part, &rest);
        assert!(others.iter().all(|other| other.share >= LEAST_SHARE));
        let named = |other: &Substitute| match other.values.as_slice() {
            [] => other.set[0].to_string(),
            values => values[0].to_string(),
        };
        others.iter().map(named).collect()
    }

    /// The stall torque says the same; friction of another law says something else.
    #[test]
    fn what_makes_most_of_the_change_may_stand_in_and_nothing_else() {
        let of_scale = stand_ins("torque_scale", &[1.1]);
        let scaled = |name: &String| name == "joint1.stall_torque_nm";
        assert!(of_scale.iter().any(scaled), "{of_scale:?}");
        let friction = |name: &String| name.starts_with("viscous") || name.starts_with("coulomb");
        assert!(!of_scale.iter().any(friction), "{of_scale:?}");
    }

    /// A spring about some angle does what a constant torque does, with one value more.
    #[test]
    fn nothing_stands_in_that_brings_more_values() {
        let of_offset = stand_ins("torque_offset", &[0.05]);
        assert!(of_offset.iter().any(|name| name.starts_with("com_angle")));
        let richer = |name: &String| name.starts_with("cable_spring");
        assert!(!of_offset.iter().any(richer), "{of_offset:?}");
    }
}
