//! Model selection: which hypothesis earns its place, and which ones the data do not tell apart.

use super::block_errors::{
    BlockErrors, bootstrap, gain, largest_reduction, paired, significantly_worse,
};
use super::evaluator::Evaluator;
use super::hypothesis::Hypothesis;
use super::strategy::Strategy;
use crate::fitting::{Fit, FitProblem};

/// A hypothesis that leaves up to this much more of the squared error may be as good.
const NEAR: f64 = 1.1;

/// What a larger explanation must bring to be preferred to a smaller one.
#[derive(Debug, Clone, Copy)]
struct Gate {
    /// Lower end of the interval of the log-likelihood gained where it counts.
    gain_low: f64,
    /// Largest reduction of the error among the motions.
    largest_reduction: f64,
    /// Whether no value lies on its bound, and none of several effects may be nothing.
    every_value_counts: bool,
    /// Change of the Bayesian information criterion on the training motions.
    bic_change: f64,
    /// Whether motions that took no part in the fit decide.
    held_out: bool,
}

impl Gate {
    fn is_passed(self) -> bool {
        let practical = if self.held_out { 0.03 } else { 0.10 };
        self.every_value_counts
            && self.gain_low > 0.0
            && self.largest_reduction > practical
            && self.bic_change < -10.0
    }
}

/// How far an explanation lies behind the best, in log-likelihood.
#[derive(Debug, Clone, Copy)]
struct LikelihoodDeficit {
    /// Whether chance does not account for it.
    significant: bool,
    /// Whether the best leaves nothing but noise.
    at_noise_floor: bool,
    /// What it leaves more.
    lost: f64,
    /// What the best gains over what both improve on.
    gained: f64,
    /// What the best leaves above the noise.
    unexplained: f64,
}

impl LikelihoodDeficit {
    fn is_clear(self) -> bool {
        let counts = self.at_noise_floor || self.lost > self.unexplained.min(0.1 * self.gained);
        self.significant && counts
    }
}

impl Evaluator<'_> {
    /// The best hypothesis that is significantly and usefully better than `reference` where it
    /// counts.
    ///
    /// Among hypotheses that nothing tells apart, the one with the fewest values, and of those that
    /// change one of the model's the one that its owner would wonder at least: what moves only a
    /// little of a motion must become many times what it is.
    pub fn accepted<'a>(
        &self,
        reference: &Hypothesis,
        hypotheses: &'a [Hypothesis],
    ) -> Option<&'a Hypothesis> {
        let improving = hypotheses.iter().filter(|h| self.improves(reference, h));
        let start = reference.pooled()?;
        let worthy: Vec<(&Hypothesis, f64)> = improving
            .filter_map(|h| Some((h, gain(&paired(&start, &h.pooled()?)))))
            .collect();
        let (best, most) = *worthy.iter().max_by(|a, b| a.1.total_cmp(&b.1))?;
        let near = 0.5 * start.count() as f64 * NEAR.ln();
        let as_good = worthy.iter().filter(|(hypothesis, gained)| {
            !self.clearly_worse(hypothesis, best, reference) && *gained >= most - near
        });
        let simplest = as_good.min_by(|a, b| {
            let values = a.0.added_values().cmp(&b.0.added_values());
            let [first, second] = [a.0, b.0].map(|h| h.deviation(&self.start));
            values
                .then(first.total_cmp(&second))
                .then(b.1.total_cmp(&a.1))
        });
        simplest.map(|(hypothesis, _)| *hypothesis)
    }

    /// The simplest part of a set that does as well as the whole, or the whole. What each further
    /// effect brings may pass for a gain where something else is missing, too.
    pub fn smallest_within(&self, whole: Hypothesis, sizes: &[Vec<Hypothesis>]) -> Hypothesis {
        let sizes = sizes.iter().filter(|_| self.does(Strategy::SmallestPart));
        let parts = sizes.flatten().filter(|part| {
            part.set.len() < whole.set.len()
                && whole.extends(part)
                && !self.clearly_worse(part, &whole, &self.base)
        });
        let simplest = parts
            .min_by(|a, b| Hypothesis::by_simplicity(a, b))
            .cloned();
        simplest.unwrap_or(whole)
    }

    /// Whether a larger set earns its place against a smaller one.
    pub fn improves(&self, reference: &Hypothesis, hypothesis: &Hypothesis) -> bool {
        let (Some(before), Some(evaluation)) = (reference.deciding(), &hypothesis.evaluation)
        else {
            return false;
        };
        let after = evaluation.deciding();
        let [low, _] = bootstrap(before, after, self.seed, gain);
        let gate = Gate {
            gain_low: low,
            largest_reduction: largest_reduction(&paired(before, after)),
            every_value_counts: evaluation.significant && !hypothesis.rests_on_bound(),
            bic_change: self.bic_change(reference, hypothesis),
            held_out: self.held_out.is_some(),
        };
        gate.is_passed()
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
        let behind = LikelihoodDeficit {
            significant: significantly_worse(&worse, &better, self.seed),
            at_noise_floor: self.at_noise_floor(best),
            lost: gain(&paired(&worse, &better)),
            gained: gain(&paired(&start, &better)),
            unexplained: 0.5 * better.count() as f64 * better.mean().ln(),
        };
        behind.is_clear()
    }

    /// Change of the Bayesian information criterion on the training motions; correlated residuals
    /// count fewer.
    pub fn bic_change(&self, reference: &Hypothesis, hypothesis: &Hypothesis) -> f64 {
        let values = hypothesis.search.free.len() as f64 - reference.search.free.len() as f64;
        let searched = |h: &Hypothesis| BlockErrors::of(&h.search.residuals, &self.search);
        let (before, after, fit) = match (&reference.evaluation, &hypothesis.evaluation) {
            (Some(before), Some(after)) => {
                (before.training.clone(), after.training.clone(), &after.fit)
            }
            _ => (
                searched(reference),
                searched(hypothesis),
                &hypothesis.search,
            ),
        };
        let n = effective_samples(&after, fit);
        let gained = gain(&paired(&before, &after)) * n / after.count().max(1) as f64;
        -2.0 * gained + values * n.max(2.0).ln()
    }
}

/// Samples that count as independent, as a share of all.
pub(super) fn effective_share(errors: &BlockErrors, fit: &Fit) -> f64 {
    effective_samples(errors, fit) / errors.count().max(1) as f64
}

/// The same share for a fit to these data.
pub fn independent_share(fit: &Fit, data: &FitProblem) -> f64 {
    effective_share(&BlockErrors::of(&fit.residuals, data), fit)
}

/// Samples that count as independent: fewer, the more neighbouring residuals agree.
fn effective_samples(errors: &BlockErrors, fit: &Fit) -> f64 {
    let n = errors.count() as f64;
    (n * fit.residuals.independent_share())
        .max(2.0 * errors.len() as f64)
        .min(n)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::search::tests::{evaluator, fitted};

    /// The set evaluated, with so many times the squares that it leaves.
    fn leaving(evaluator: &Evaluator, mut set: Hypothesis, times: f64) -> Hypothesis {
        evaluator.evaluate(&mut set);
        let evaluation = set.evaluation.as_mut().unwrap();
        evaluation.significant = true;
        evaluation.training = evaluation.training.times(times);
        let held_out = evaluation.held_out.take().unwrap();
        evaluation.held_out = Some(held_out.times(times));
        set
    }

    /// What an arm lacks, and the same with an idle effect.
    fn part_and_whole(evaluator: &Evaluator) -> [Hypothesis; 2] {
        let both = [&[0.02][..], &[0.001, 10.0, 0.0]];
        [
            fitted(evaluator, &["viscous"], [both[0]]),
            fitted(evaluator, &["viscous", "cogging"], both),
        ]
    }

    /// Above the noise something else bends every candidate: a simpler set is taken if it leaves
    /// hardly more, and not if it leaves a quarter more.
    #[test]
    fn the_simpler_of_sets_that_leave_nearly_the_same_is_taken() {
        let evaluator = evaluator(1, &["viscous"]);
        let [viscous, both] = part_and_whole(&evaluator);
        let names = |times: f64| {
            let sets = [
                leaving(&evaluator, viscous.clone(), times),
                leaving(&evaluator, both.clone(), 4.0),
            ];
            assert!(!evaluator.clearly_worse(&sets[0], &sets[1], &evaluator.base));
            evaluator.accepted(&evaluator.base, &sets).unwrap().names()
        };
        assert_eq!(names(4.1), ["viscous@1"]);
        assert_eq!(names(5.0), ["viscous@1", "cogging@1"]);
    }

    /// A set is not said to be needed whole beside a part of it that does as well.
    #[test]
    fn of_a_set_the_part_that_does_as_well_is_taken() {
        let evaluator = evaluator(1, &["viscous"]);
        let [viscous, both] = part_and_whole(&evaluator);
        let names = |times: f64| {
            let part = leaving(&evaluator, viscous.clone(), times);
            let whole = leaving(&evaluator, both.clone(), 4.0);
            evaluator.smallest_within(whole, &[vec![part]]).names()
        };
        assert_eq!(names(4.1), ["viscous@1"]);
        assert_eq!(names(400.0), ["viscous@1", "cogging@1"]);
    }

    #[test]
    fn a_difference_counts_by_what_is_left_and_what_was_gained() {
        let behind = LikelihoodDeficit {
            significant: true,
            at_noise_floor: true,
            lost: 1.0,
            gained: 1000.0,
            unexplained: 2000.0,
        };
        assert!(behind.is_clear());
        let chance = LikelihoodDeficit {
            significant: false,
            ..behind
        };
        assert!(!chance.is_clear());
        // Something else is missing, too: a tenth of what was gained is the least that counts ...
        let above = |lost, unexplained| LikelihoodDeficit {
            at_noise_floor: false,
            lost,
            unexplained,
            ..behind
        };
        assert!(!above(99.0, 2000.0).is_clear());
        assert!(above(101.0, 2000.0).is_clear());
        // ... but for a difference larger than all that is left.
        assert!(above(21.0, 20.0).is_clear());
        assert!(!above(19.0, 20.0).is_clear());
    }

    #[test]
    fn each_condition_of_the_gate_counts() {
        let gate = Gate {
            gain_low: 1.0,
            largest_reduction: 0.05,
            every_value_counts: true,
            bic_change: -11.0,
            held_out: true,
        };
        assert!(gate.is_passed());
        let refused = [
            Gate {
                gain_low: -0.1,
                ..gate
            },
            Gate {
                largest_reduction: 0.02,
                ..gate
            },
            Gate {
                every_value_counts: false,
                ..gate
            },
            Gate {
                bic_change: -9.0,
                ..gate
            },
            // The motions of the fit flatter it.
            Gate {
                held_out: false,
                ..gate
            },
        ];
        for gate in refused {
            assert!(!gate.is_passed(), "{gate:?}");
        }
    }
}
