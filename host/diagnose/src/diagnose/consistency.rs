//! Whether the values an explanation needs are the same in every motion.
//!
//! An effect that stands in for another often fits each motion by itself, and only with another
//! value each time: a wrong torque for a wrong mass, until a payload is bolted on. A law holds in
//! all motions at once (Chow 1960, Econometrica 28, 591; invariance across conditions: Peters,
//! Buehlmann & Meinshausen 2016, JRSS B 78, 947).

use super::hypothesis::Hypothesis;
use super::verdict::FAR_OFF;
use crate::fitting::{Fit, FitOptions, FitProblem, fit};
use rayon::prelude::*;

/// Iterations of a motion's own fit, from the values found for all.
const ITERATIONS: usize = 8;

/// A fit of each motion by itself, from the values found for all.
pub(super) struct OwnFits(Vec<Fit>);

impl OwnFits {
    /// Fits each of the training motions; `None` with fewer than two of them, and where nothing is
    /// left above the noise.
    pub fn of(hypothesis: &Hypothesis, training: &FitProblem) -> Option<OwnFits> {
        let evaluation = hypothesis.evaluation.as_ref()?;
        if training.motions.len() < 2 || evaluation.training.is_noise() {
            return None;
        }
        let joint = &evaluation.fit;
        let own = |motion: usize| {
            let own = training.only(motion);
            let windows = training.windows_of(motion);
            let window_starts: Vec<_> = windows
                .map(|(w, _)| joint.window_starts[w].clone())
                .collect();
            let options = FitOptions::iterations(ITERATIONS);
            fit(
                &joint.model,
                &joint.free,
                &own,
                Some(&window_starts),
                options,
            )
        };
        let motions = (0..training.motions.len()).into_par_iter();
        Some(OwnFits(motions.map(own).collect()))
    }

    /// Share of the squared error above the noise, on the training motions, that goes when every
    /// motion has values of its own; `None` where so little is left that a fit to one motion only
    /// follows its noise.
    pub fn reduction(&self, hypothesis: &Hypothesis) -> Option<f64> {
        let residuals = &hypothesis.evaluation.as_ref()?.fit.residuals;
        if residuals.mean_square() < FAR_OFF {
            return None;
        }
        let alone: f64 = self.0.iter().map(|fit| fit.residuals.cost()).sum();
        let together = residuals.cost();
        Some((together - alone) / (together - residuals.count() as f64))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::challenge::weakened_arm;
    use crate::diagnose::search::tests::{arm, evaluator, fitted, recorded};
    use crate::fitting::Horizon;

    const HIDDEN: [&str; 1] = ["viscous"];

    /// The arm's viscous friction, fitted with so many iterations from this value to its two
    /// motions, of which the first may be recorded with a share of that friction only.
    fn friction(share: f64, from: f64, iterations: usize) -> (Hypothesis, FitProblem) {
        let (model, mut training, _) = arm(1, &HIDDEN);
        training[0] = recorded(&weakened_arm(1, &HIDDEN, share)).1.swap_remove(0);
        let training = FitProblem::new(&model, training, Horizon::Whole);
        let search = fitted(&evaluator(1, &HIDDEN), &HIDDEN, [&[0.02]]).search;
        let mut start = search.model.clone();
        assert!(search.free.last().unwrap().set(&mut start, from));
        let options = FitOptions::iterations(iterations);
        let fitted = fit(&start, &search.free, &training, None, options);
        let mut friction = Hypothesis::new(Vec::new(), search);
        friction.judge(fitted, &training, None);
        (friction, training)
    }

    #[test]
    fn motions_are_told_apart_only_where_they_leave_more_than_noise() {
        let (friction, training) = friction(1.0, 0.02, 12);
        assert!(OwnFits::of(&friction, &training).is_none());
    }

    #[test]
    fn values_of_their_own_take_away_what_one_value_leaves() {
        let (friction, training) = friction(0.5, 0.02, 12);
        let own = OwnFits::of(&friction, &training).unwrap();
        let reduction = own.reduction(&friction).unwrap();
        assert!(reduction > 0.9, "{reduction}");
        // One motion by itself asks for no other value than itself.
        assert!(OwnFits::of(&friction, &training.only(0)).is_none());
    }
}
