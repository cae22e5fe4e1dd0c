//! What is known of the free values before any log, as a part of the squared error.
//!
//! Residuals that a wrong model leaves are no independent readings of its values, however many
//! there are: neighbours agree, and all are larger than the noise. So the prior counts as many
//! times as the residuals do: were it a reading at the scale of the noise, the first missing effect
//! would move a mass that was weighed.

use super::fit::Fit;
use super::normal::NormalEquations;
use super::residual::Residuals;
use crate::model::{Model, ParameterPath, Prior};
use nalgebra::DVector;

/// What is known beforehand of a fit's free values, in units of its residuals.
pub(super) struct ValuePrior {
    /// By value; 0 where nothing is known.
    pub precision: DVector<f64>,
    /// Where each is pulled.
    pub pull: DVector<f64>,
    /// What it adds to the squared error.
    pub cost: f64,
}

impl ValuePrior {
    /// Of these values of a model, counted so many times.
    pub fn of(model: &Model, free: &[ParameterPath], weight: f64) -> Self {
        let count = free.len();
        let mut prior = ValuePrior {
            precision: DVector::zeros(count),
            pull: DVector::zeros(count),
            cost: 0.0,
        };
        if model.uncertain.is_empty() {
            return prior;
        }
        for (i, path) in free.iter().enumerate() {
            if let Some(Prior {
                precision,
                pull,
                distance,
            }) = known(model, *path)
            {
                prior.precision[i] = weight * precision;
                prior.pull[i] = weight * pull;
                prior.cost += weight * distance * distance;
            }
        }
        prior
    }
}

fn known(model: &Model, path: ParameterPath) -> Option<Prior> {
    Some(model.uncertain(path)?.at(path.get(model)?))
}

impl Fit {
    /// What is known of the free values beforehand.
    pub(super) fn value_prior(&self) -> ValuePrior {
        ValuePrior::of(&self.model, &self.free, self.prior_weight)
    }

    /// Normal equations at the fit, with what is known of the values beforehand.
    pub(super) fn normal_equations(&self, damping: f64) -> NormalEquations {
        let mut normal = NormalEquations::assemble(self.free.len(), &self.jacobian, damping);
        normal.know(&self.value_prior());
        normal
    }

    /// The fit, the prior counting as often as in another.
    pub fn with_prior_as(self, other: &Fit) -> Fit {
        Fit {
            prior_weight: other.prior_weight,
            ..self
        }
    }

    /// Lets the prior count as the residuals do that the fit has now.
    pub(super) fn weigh_prior(&mut self) {
        if !self.model.uncertain.is_empty() {
            self.prior_weight = weight(&self.residuals);
        }
    }
}

impl NormalEquations {
    /// Adds what is known of the values beforehand.
    pub(super) fn know(&mut self, prior: &ValuePrior) {
        for i in 0..prior.precision.len() {
            self.matrix[(i, i)] += prior.precision[i];
        }
        self.gradient += &prior.pull;
    }
}

/// How many of its residuals tell as much as one independent reading at the scale of the noise.
fn weight(residuals: &Residuals) -> f64 {
    residuals.mean_square().max(1.0) / residuals.independent_share()
}

impl Residuals {
    /// Share of the residuals that counts as independent: fewer, the more neighbours agree (of a
    /// first-order autoregression).
    pub fn independent_share(&self) -> f64 {
        let (mut product, mut square) = (0.0, 1e-300);
        for window in &self.windows {
            for pair in window.windows(2) {
                product += pair[0] * pair[1];
                square += pair[0] * pair[0];
            }
        }
        let correlation: f64 = (product / square).clamp(0.0, 0.999);
        (1.0 - correlation) / (1.0 + correlation)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn residuals(of: impl Fn(usize) -> f64) -> Residuals {
        Residuals {
            windows: vec![(0..1000).map(of).collect()],
            gaps: 0,
        }
    }

    /// Readings off by noise of their own are as many as they are; those off by the same are one.
    #[test]
    fn a_prior_counts_as_the_residuals_do() {
        let alternating = residuals(|k| if k % 2 == 0 { 1.0 } else { -1.0 });
        assert_eq!(weight(&alternating), 1.0);
        let constant = weight(&residuals(|_| 1.0));
        assert!(constant > 900.0, "{constant}");
        let large = weight(&residuals(|k| if k % 2 == 0 { 5.0 } else { -5.0 }));
        assert!((large - 25.0).abs() < 1e-9, "{large}");
        // Less than the noise is no more than the noise.
        let small = weight(&residuals(|k| if k % 2 == 0 { 0.1 } else { -0.1 }));
        assert_eq!(small, 1.0);
    }
}
