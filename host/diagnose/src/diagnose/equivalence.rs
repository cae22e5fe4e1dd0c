//! Explanations whose predictions these motions cannot tell from those of the chosen one.
//!
//! No list says which they are. What one part of the explanation changes in the prediction is
//! compared with what every other candidate, every value of the file and every kind of value could
//! change, all less what free values and start states can imitate; the share they can make of it is
//! the squared cosine of the principal angle between them. The nearest are confirmed by simulation:
//! the explanation predicts the motions, the other is fitted to that prediction, and what it leaves
//! beyond what the explanation itself leaves, fitted to it likewise, is weighed against the noise:
//! the start states that the samples suggest keep either from it where windows are many.

use super::budget::{EVALUATE, FINISH};
use super::evaluator::Evaluator;
use super::explanation::Explanation;
use super::hypothesis::Hypothesis;
use super::replacement::{ReplaceablePart, Substitute};
use super::selection::effective_share;
use super::values::contradicted_paths;
use crate::fitting::{
    Candidate, FitOptions, FitProblem, WindowStart, descend_jumping_law, fit, fit_start_states,
    predicted,
};
use crate::model::{Model, ParameterPath};
use rayon::prelude::*;

/// Other explanations simulated for each part: those that can make most of what it changes.
const SIMULATED: usize = 4;
/// Two predictions differ where their difference is larger than so many standard errors.
const DISTINCT: f64 = 2.0;
/// Of a refit, so many wrong values at most are compared with other explanations.
const REFITTED: usize = 3;

/// All motions as an explanation predicts them, without noise.
struct Predicted {
    data: FitProblem,
    window_starts: Vec<WindowStart>,
    /// Samples that count as independent, as a share of all.
    effective_share: f64,
    /// Squared weighted residuals that the explanation leaves of its own prediction.
    own_cost: f64,
    /// The values of the effects in the explanation whose laws jump.
    jumping: Vec<ParameterPath>,
}

impl Evaluator<'_> {
    /// Explanations with no more values than the chosen one whose predictions these motions cannot
    /// tell from its own, the simplest first; none where the model as given explains them.
    pub fn equivalents(&self, explanation: Explanation, tried: &[Hypothesis]) -> Vec<Hypothesis> {
        let chosen = explanation.hypothesis();
        let parts = self.parts(explanation);
        let Some(predicted) = self.predicted(chosen).filter(|_| !parts.is_empty()) else {
            return Vec::new();
        };
        let of_part = |part: &ReplaceablePart| {
            let (model, free) = self.without(chosen, part);
            // The derivatives where the part is missing and all else is as it was.
            let (window_starts, options) = (
                Some(&chosen.search.window_starts[..]),
                FitOptions::iterations(0),
            );
            let rest = fit(&model, &free, &self.search, window_starts, options);
            let rest = rest.with_prior_as(&chosen.search);
            let mut others = self.others(chosen, part, &rest);
            others.truncate(SIMULATED);
            let same = others.into_par_iter().filter(|other| predicted.fits(other));
            same.map(|other| self.evaluated_other(other, tried))
                .collect::<Vec<_>>()
        };
        let found = parts.par_iter().flat_map_iter(of_part);
        let mut found: Vec<Hypothesis> = found.collect();
        found.retain(|other| !other.rests_on_bound());
        found.sort_by(Hypothesis::by_simplicity);
        found
    }

    /// What may be replaced: each effect, or each wrong value.
    fn parts(&self, explanation: Explanation) -> Vec<ReplaceablePart> {
        match explanation {
            Explanation::Given(_) => Vec::new(),
            Explanation::Effects(chosen) => chosen
                .set
                .iter()
                .map(|&effect| ReplaceablePart::Effect(effect))
                .collect(),
            Explanation::Value(chosen) | Explanation::ValueAndRefit(chosen) => {
                vec![ReplaceablePart::Values(chosen.values.clone())]
            }
            Explanation::Refit(base) => {
                let wrong = contradicted_paths(&self.start, base.fit(), &self.training);
                let wrong = wrong.into_iter().take(REFITTED);
                wrong
                    .map(|path| ReplaceablePart::Values(vec![path]))
                    .collect()
            }
        }
    }

    /// The model of the short windows and what is free of it, less a part of the explanation.
    pub(super) fn without(
        &self,
        chosen: &Hypothesis,
        part: &ReplaceablePart,
    ) -> (Model, Vec<ParameterPath>) {
        let (mut model, mut free) = (chosen.search.model.clone(), chosen.search.free.clone());
        match part {
            ReplaceablePart::Effect(effect) => {
                model.effects.retain(|instance| !effect.is(instance));
                free.retain(|path| effect.paths().all(|own| own != *path));
            }
            ReplaceablePart::Values(paths) => {
                for path in paths {
                    let given = path.get(&self.start);
                    let known = given.is_some_and(|given| path.set(&mut model, given));
                    debug_assert!(known, "a wrong value is one of the model's");
                }
                let known = |path: &ParameterPath| self.start.uncertain(*path).copied();
                free.retain(|path| !paths.contains(path) || known(path).is_some());
                model.uncertain.extend(paths.iter().filter_map(known));
            }
        }
        (model, free)
    }

    /// All motions as the explanation predicts them; `None` before it was evaluated.
    fn predicted(&self, chosen: &Hypothesis) -> Option<Predicted> {
        let evaluation = chosen.evaluation.as_ref()?;
        let found = &evaluation.fit;
        let (mut data, mut window_starts) = (self.training.clone(), found.window_starts.clone());
        if let Some(held_out) = &self.held_out {
            data = data.joined(held_out);
            window_starts.extend(fit_start_states(&found.model, held_out).window_starts);
        }
        let windows = (0..data.motions.len()).into_par_iter();
        let readings = windows.map(|motion| predicted(&found.model, &data, &window_starts, motion));
        let readings: Vec<Vec<Vec<f64>>> = readings.collect();
        let data = data.measuring(&readings);
        let jumping = (chosen.set.iter()).filter(|effect| effect.jumps(&found.model));
        Some(Predicted {
            own_cost: left(&data, &window_starts, &found.model, &found.free),
            effective_share: effective_share(&evaluation.training, found),
            jumping: jumping.flat_map(Candidate::paths).collect(),
            data,
            window_starts,
        })
    }

    /// An equivalent explanation fitted to the measurement and evaluated, as it was tried if it
    /// was.
    fn evaluated_other(&self, other: Substitute, tried: &[Hypothesis]) -> Hypothesis {
        let known = tried
            .iter()
            .find(|h| h.values == other.values && h.adds(&other.set));
        let mut hypothesis = match known {
            Some(known) => known.clone(),
            None => {
                let options = FitOptions::iterations(EVALUATE);
                let search = fit(&other.model, &other.free, &self.search, None, options);
                Hypothesis {
                    values: other.values,
                    ..Hypothesis::new(other.set, search)
                }
            }
        };
        self.evaluate(&mut hypothesis);
        hypothesis
    }
}

impl Predicted {
    /// Whether another explanation, fitted to these predictions, leaves no more of them than the
    /// noise can show.
    fn fits(&self, other: &Substitute) -> bool {
        let leaves_nothing = |model: &Model| {
            let others = left(&self.data, &self.window_starts, model, &other.free);
            is_below_noise((others - self.own_cost).max(0.0), self.effective_share)
        };
        leaves_nothing(&other.model)
            || self
                .closer(other)
                .is_some_and(|model| leaves_nothing(&model))
    }

    /// The other explanation, fitted with the values of the laws held that both have and that jump:
    /// these should not leave their valley while all else finds its own. `None` where there is no
    /// such law.
    fn closer(&self, other: &Substitute) -> Option<Model> {
        let moves = |path: &&ParameterPath| !self.jumping.contains(path);
        let free: Vec<ParameterPath> = other.free.iter().filter(moves).copied().collect();
        let options = FitOptions::iterations(FINISH);
        let closer = || {
            fit(
                &other.model,
                &free,
                &self.data,
                Some(&self.window_starts),
                options,
            )
            .model
        };
        (free.len() < other.free.len()).then(closer)
    }
}

/// Squared weighted residuals that a model leaves of these data once it is fitted to them.
fn left(
    data: &FitProblem,
    window_starts: &[WindowStart],
    model: &Model,
    free: &[ParameterPath],
) -> f64 {
    // A first small step must not end it: what is left decides.
    let options = FitOptions::iterations(FINISH);
    let found = fit(model, free, data, Some(window_starts), options);
    descend_jumping_law(found, data, options).residuals.cost()
}

/// Whether a difference of two predictions, its squares weighted by the noise and summed over all
/// samples, is too small to be seen.
///
/// White noise shows a difference whose sum of squares is s at sqrt(s) standard errors; errors that
/// neighbours share show it as if there were fewer samples.
fn is_below_noise(sum_of_squares: f64, effective_share: f64) -> bool {
    (sum_of_squares * effective_share).sqrt() < DISTINCT
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_difference_counts_from_two_standard_errors() {
        // A hundredth of the noise, in 30,000 samples of which all or a third are independent.
        let sum = 3e4 * 1e-4;
        assert!(is_below_noise(sum, 1.0));
        assert!(!is_below_noise(2.0 * sum, 1.0));
        assert!(is_below_noise(2.0 * sum, 0.3));
    }
}
