//! Which trial earns its place, and which ones the data do not tell apart.

use super::bench::Bench;
use super::score::{Score, fall, surely_worse};
use super::trial::Trial;
use crate::fitting::Fit;

impl Bench<'_> {
    /// The best trial that is surely and usefully better than `reference` where it counts.
    ///
    /// Among trials that nothing tells apart, the one with the fewest values.
    pub fn accepted<'a>(&self, reference: &Trial, trials: &'a [Trial]) -> Option<&'a Trial> {
        let worthy: Vec<(&Trial, f64)> = trials
            .iter()
            .filter(|trial| self.pays(reference, trial))
            .filter_map(|trial| Some((trial, trial.pooled()?.mean())))
            .collect();
        let (best, least) = *worthy.iter().min_by(|a, b| a.1.total_cmp(&b.1))?;
        worthy
            .iter()
            .filter(|(trial, mean)| {
                !self.clearly_worse(trial, best, reference) && *mean <= 1.1 * least
            })
            .min_by(|a, b| {
                a.0.added_values()
                    .cmp(&b.0.added_values())
                    .then(a.1.total_cmp(&b.1))
            })
            .map(|(trial, _)| *trial)
    }

    /// Whether a larger set earns its place against a smaller one.
    pub fn pays(&self, reference: &Trial, trial: &Trial) -> bool {
        let (Some(before), Some(after)) = (reference.deciding(), trial.deciding()) else {
            return false;
        };
        let (low, _) = fall(before, after, self.seed);
        let practical = if self.held_out.is_some() { 0.03 } else { 0.10 };
        let significant = trial
            .judged
            .as_ref()
            .is_some_and(|judged| judged.significant);
        significant
            && !trial.rests_on_bound()
            && low > practical
            && self.bic_change(reference, trial) < -10.0
    }

    /// Whether the data tell that `trial` is worse than `best`; `reference` is what both improve on.
    ///
    /// At the noise floor a sure difference counts however small. Above it, something else is missing too and
    /// bends every candidate, so a difference decides nothing that is smaller than what remains unexplained and
    /// than a tenth of what was gained.
    pub fn clearly_worse(&self, trial: &Trial, best: &Trial, reference: &Trial) -> bool {
        let (Some(worse), Some(better), Some(start)) =
            (trial.pooled(), best.pooled(), reference.pooled())
        else {
            return true;
        };
        let sure = surely_worse(&worse, &better, self.seed);
        if self.at_floor(best) {
            return sure;
        }
        let gained = (start.mean() - better.mean()).max(0.0);
        let unexplained = better.mean() - 1.0;
        sure && worse.mean() - better.mean() > unexplained.min(0.1 * gained)
    }

    /// Change of the Bayesian information criterion on the training motions; correlated residuals count fewer.
    pub fn bic_change(&self, reference: &Trial, trial: &Trial) -> f64 {
        let values = trial.search.free.len() as f64 - reference.search.free.len() as f64;
        let (n, ratio) = match (&reference.judged, &trial.judged) {
            (Some(before), Some(after)) => (
                effective_samples(&after.training, &after.fit),
                after.training.mean() / before.training.mean(),
            ),
            _ => {
                let score = Score::of(&trial.search, &self.search);
                (
                    effective_samples(&score, &trial.search),
                    trial.search_mean / reference.search_mean,
                )
            }
        };
        n * ratio.ln() + values * n.max(2.0).ln()
    }
}

/// Samples that count as independent: fewer, the more neighbouring residuals agree.
fn effective_samples(score: &Score, fit: &Fit) -> f64 {
    let (mut product, mut square) = (0.0, 1e-300);
    for window in &fit.residuals.windows {
        for pair in window.windows(2) {
            product += pair[0] * pair[1];
            square += pair[0] * pair[0];
        }
    }
    let correlation = (product / square).clamp(0.0, 0.999);
    let n = score.counts.iter().sum::<usize>() as f64;
    (n * (1.0 - correlation) / (1.0 + correlation))
        .max(2.0 * score.sums.len() as f64)
        .min(n)
}
