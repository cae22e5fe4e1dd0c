//! Model selection: which hypothesis earns its place, and which ones the data do not tell apart.

use super::block_errors::{BlockErrors, reduction, significantly_worse};
use super::evaluator::Evaluator;
use super::hypothesis::Hypothesis;
use crate::fitting::Fit;

impl Evaluator<'_> {
    /// The best hypothesis that is significantly and usefully better than `reference` where it
    /// counts.
    ///
    /// Among hypotheses that nothing tells apart, the one with the fewest values.
    pub fn accepted<'a>(
        &self,
        reference: &Hypothesis,
        hypotheses: &'a [Hypothesis],
    ) -> Option<&'a Hypothesis> {
        let improving = hypotheses.iter().filter(|h| self.improves(reference, h));
        let worthy: Vec<(&Hypothesis, f64)> = improving
            .filter_map(|h| Some((h, h.pooled()?.mean())))
            .collect();
        let (best, least) = *worthy.iter().min_by(|a, b| a.1.total_cmp(&b.1))?;
        let as_good = worthy.iter().filter(|(hypothesis, mean)| {
            !self.clearly_worse(hypothesis, best, reference) && *mean <= 1.1 * least
        });
        let simplest = as_good.min_by(|a, b| {
            let values = a.0.added_values().cmp(&b.0.added_values());
            values.then(a.1.total_cmp(&b.1))
        });
        simplest.map(|(hypothesis, _)| *hypothesis)
    }

    /// Whether a larger set earns its place against a smaller one.
    pub fn improves(&self, reference: &Hypothesis, hypothesis: &Hypothesis) -> bool {
        let (Some(before), Some(evaluation)) = (reference.deciding(), &hypothesis.evaluation)
        else {
            return false;
        };
        let [low, _] = reduction(before, evaluation.deciding(), self.seed);
        let practical = if self.held_out.is_some() { 0.03 } else { 0.10 };
        evaluation.significant
            && !hypothesis.rests_on_bound()
            && low > practical
            && self.bic_change(reference, hypothesis) < -10.0
    }

    /// Whether the data tell that `hypothesis` is worse than `best`; `reference` is what both
    /// improve on.
    ///
    /// At the noise floor a significant difference counts however small. Above it, something else
    /// is missing too and bends every candidate, so a difference decides nothing that is smaller
    /// than what remains unexplained and than a tenth of what was gained.
    pub fn clearly_worse(
        &self,
        hypothesis: &Hypothesis,
        best: &Hypothesis,
        reference: &Hypothesis,
    ) -> bool {
        let (Some(worse), Some(better), Some(start)) =
            (hypothesis.pooled(), best.pooled(), reference.pooled())
        else {
            return true;
        };
        let significant = significantly_worse(&worse, &better, self.seed);
        if self.at_noise_floor(best) {
            return significant;
        }
        let gained = (start.mean() - better.mean()).max(0.0);
        let unexplained = better.mean() - 1.0;
        significant && worse.mean() - better.mean() > unexplained.min(0.1 * gained)
    }

    /// Change of the Bayesian information criterion on the training motions; correlated residuals
    /// count fewer.
    pub fn bic_change(&self, reference: &Hypothesis, hypothesis: &Hypothesis) -> f64 {
        let values = hypothesis.search.free.len() as f64 - reference.search.free.len() as f64;
        let (n, ratio) = match (&reference.evaluation, &hypothesis.evaluation) {
            (Some(before), Some(after)) => (
                effective_samples(&after.training, &after.fit),
                after.training.mean() / before.training.mean(),
            ),
            _ => {
                let search = &hypothesis.search;
                let errors = BlockErrors::of(&search.residuals, &self.search);
                let ratio = hypothesis.search_mean / reference.search_mean;
                (effective_samples(&errors, search), ratio)
            }
        };
        n * ratio.ln() + values * n.max(2.0).ln()
    }
}

/// Samples that count as independent: fewer, the more neighbouring residuals agree.
fn effective_samples(errors: &BlockErrors, fit: &Fit) -> f64 {
    let (mut product, mut square) = (0.0, 1e-300);
    for window in &fit.residuals.windows {
        for pair in window.windows(2) {
            product += pair[0] * pair[1];
            square += pair[0] * pair[0];
        }
    }
    let correlation = (product / square).clamp(0.0, 0.999);
    let n = errors.count() as f64;
    (n * (1.0 - correlation) / (1.0 + correlation))
        .max(2.0 * errors.sums.len() as f64)
        .min(n)
}
