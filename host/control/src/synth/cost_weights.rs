//! Weights of a regulator's cost: by the ranges of states and inputs, or as given.

use super::error::DesignError;
use super::weight::Weight;
use nalgebra::DMatrix;

/// Q and R of the cost sum(x'Qx + u'Ru).
#[derive(Debug, Clone, PartialEq)]
pub enum CostWeights {
    /// Bryson's rule (Bryson and Ho, Applied Optimal Control, 1969): each state and input weighs
    /// one over the square of its largest departure, which also makes their units agree.
    ByRange {
        /// All states weigh so many times that.
        states: f64,
        /// Speeds weigh so many times more than that.
        speeds: f64,
    },
    /// These.
    Given {
        /// Of the states.
        q: Weight,
        /// Of the inputs.
        r: Weight,
    },
}

impl CostWeights {
    /// Bryson's rule as it is.
    pub const BRYSON: CostWeights = CostWeights::ByRange {
        states: 1.0,
        speeds: 1.0,
    };

    /// The paper's, Q = 100 I and R = I: a rad/s weighs as much as a rad.
    pub const PAPER: CostWeights = CostWeights::equal(100.0);

    /// Q = q I and R = I.
    pub const fn equal(q: f64) -> CostWeights {
        CostWeights::Given {
            q: Weight::Scalar(q),
            r: Weight::Scalar(1.0),
        }
    }

    /// Q and R as two weights, of states and inputs with these largest departures. A list of states
    /// holds angles, then as many speeds.
    pub fn resolved(&self, state_range: &[f64], input_range: &[f64]) -> [Weight; 2] {
        match self {
            CostWeights::ByRange { states, speeds } => {
                let (angles, rates) = state_range.split_at(state_range.len() / 2);
                let q = [
                    per_square(angles, *states),
                    per_square(rates, states * speeds),
                ]
                .concat();
                [q, per_square(input_range, 1.0)].map(Weight::Diagonal)
            }
            CostWeights::Given { q, r } => [q.clone(), r.clone()],
        }
    }

    /// Q and R as matrices, for a plant of so many states, past inputs not counted: Q may cover
    /// these, too.
    ///
    /// # Errors
    /// Sizes that do not fit.
    pub(super) fn matrices(
        &self,
        state_range: &[f64],
        input_range: &[f64],
        with_past: usize,
    ) -> Result<[DMatrix<f64>; 2], DesignError> {
        let [q, r] = self.resolved(state_range, input_range);
        let covered = q.size().filter(|size| *size == with_past);
        let q = q.matrix("Q", covered.unwrap_or(state_range.len()), "states")?;
        Ok([q, r.matrix("R", input_range.len(), "inputs")?])
    }
}

fn per_square(ranges: &[f64], factor: f64) -> Vec<f64> {
    let weigh = |range: &f64| factor / range.powi(2);
    ranges.iter().map(weigh).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn departures_at_their_limits_cost_alike() {
        let weights = CostWeights::ByRange {
            states: 3.0,
            speeds: 0.5,
        };
        let [q, r] = weights
            .matrices(&[0.5, 0.2, 10.0, 4.0], &[2.0, 0.25], 4)
            .unwrap();
        let cost = |weight: &DMatrix<f64>, at: usize, value: f64| weight[(at, at)] * value * value;
        let states = [0.5, 0.2, 10.0, 4.0].into_iter().enumerate();
        let states: Vec<f64> = states.map(|(at, value)| cost(&q, at, value)).collect();
        let near = |found: &[f64], asked: &[f64]| {
            for (found, asked) in found.iter().zip(asked) {
                assert!((found - asked).abs() < 1e-12, "{found}, asked {asked}");
            }
        };
        near(&states, &[3.0, 3.0, 1.5, 1.5]);
        near(&[cost(&r, 0, 2.0), cost(&r, 1, 0.25)], &[1.0, 1.0]);
    }

    #[test]
    fn given_weights_may_cover_past_inputs() {
        let weights = |size: usize| CostWeights::Given {
            q: Weight::Diagonal(vec![1.0; size]),
            r: Weight::Scalar(1.0),
        };
        let size = |size: usize| {
            let made = weights(size).matrices(&[0.5, 10.0], &[2.0], 4);
            made.map(|[q, _]| q.nrows())
        };
        assert_eq!((size(2), size(4)), (Ok(2), Ok(4)));
        assert!(size(3).is_err());
    }
}
