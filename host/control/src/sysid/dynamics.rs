//! What a fitted model says of the servo: static gain, poles, settling, each with its 95 %
//! interval.

use super::estimate::Estimate;
use super::polynomial::{at_one, roots};
use nalgebra::{Complex, DVector};
use serde::Serialize;

/// Half a 95 % interval in standard errors.
const HALF_95: f64 = 1.96;

/// A value with its 95 % interval.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct IntervalEstimate {
    /// The value.
    pub value: f64,
    /// Lower end.
    pub low: f64,
    /// Upper end.
    pub high: f64,
}

impl IntervalEstimate {
    /// `value` give or take `half`.
    pub fn around(value: f64, half: f64) -> Self {
        IntervalEstimate {
            value,
            low: value - half,
            high: value + half,
        }
    }

    /// Whether the interval holds `truth`.
    pub fn holds(&self, truth: f64) -> bool {
        (self.low..=self.high).contains(&truth)
    }
}

/// A pole in the z-plane, and where it lies in continuous time.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Pole {
    /// Real part.
    pub re: IntervalEstimate,
    /// Imaginary part; 0 for a real pole.
    pub im: IntervalEstimate,
    /// Distance from the origin: below 1 where stable.
    pub radius: IntervalEstimate,
    /// Real part of `ln(z) / Ts`, 1/s: how fast it dies.
    pub decay_rad_s: f64,
    /// Imaginary part of `ln(z) / Ts`, rad/s: how fast it turns.
    pub turn_rad_s: f64,
}

/// From input to output.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Dynamics {
    /// OutputQuantity over a constant input, once at rest.
    pub gain: IntervalEstimate,
    /// Poles, largest first; of a pair both.
    pub poles: Vec<Pole>,
    /// Time after a step from which the output stays within 2 % of its end, s; none if it never
    /// does in 10 000 samples.
    pub settling_s: Option<f64>,
}

/// Of a fitted model, sampled every `ts_s`. Intervals are by the delta method: the covariance of
/// the coefficients through the derivatives of gain and poles.
pub fn dynamics(estimate: &Estimate, ts_s: f64) -> Dynamics {
    Dynamics {
        gain: gain(estimate),
        poles: poles(estimate, ts_s),
        settling_s: settling_samples(&estimate.model.b, &estimate.model.denominator())
            .map(|samples| samples as f64 * ts_s),
    }
}

/// Samples after a step from which the output of `b/denominator` stays within 2 % of its end.
pub fn settling_samples(b: &[f64], denominator: &[f64]) -> Option<usize> {
    let end = at_one(b) / at_one(denominator);
    let response = super::polynomial::filter(b, denominator, &vec![1.0; 10_000]);
    let outside = |y: &f64| (y - end).abs() > 0.02 * end.abs() || !y.is_finite();
    match response.iter().rposition(outside) {
        None => Some(0),
        Some(last) if last + 1 < response.len() => Some(last + 1),
        Some(_) => None,
    }
}

fn deviation(estimate: &Estimate, gradient: &DVector<f64>) -> f64 {
    (gradient.dot(&(&estimate.covariance * gradient)))
        .max(0.0)
        .sqrt()
}

/// B(1) / (A(1) F(1)).
fn gain(estimate: &Estimate) -> IntervalEstimate {
    let (structure, model) = (&estimate.structure, &estimate.model);
    let (a, b, f) = (at_one(&model.a), at_one(&model.b), at_one(&model.f));
    let value = b / (a * f);
    let mut gradient = DVector::zeros(structure.count());
    let b_at = structure.na;
    let f_at = structure.count() - structure.nf;
    gradient.rows_mut(0, structure.na).fill(-value / a);
    gradient.rows_mut(b_at, structure.nb).fill(1.0 / (a * f));
    gradient.rows_mut(f_at, structure.nf).fill(-value / f);
    IntervalEstimate::around(value, HALF_95 * deviation(estimate, &gradient))
}

fn poles(estimate: &Estimate, ts_s: f64) -> Vec<Pole> {
    let (structure, model) = (&estimate.structure, &estimate.model);
    // Each family has A or F, never both.
    let (polynomial, first) = match structure.na {
        0 => (&model.f, structure.count() - structure.nf),
        _ => (&model.a, 0),
    };
    let roots = roots(polynomial).unwrap_or_default();
    roots
        .iter()
        .map(|root| pole(estimate, polynomial, first, *root, ts_s))
        .collect()
}

/// d root / d coefficient k = -root^(n - k) / P'(root).
fn pole(
    estimate: &Estimate,
    polynomial: &[f64],
    first: usize,
    root: Complex<f64>,
    ts_s: f64,
) -> Pole {
    let order = polynomial.len() - 1;
    let slope: Complex<f64> = (0..order)
        .map(|k| root.powu((order - k - 1) as u32) * ((order - k) as f64 * polynomial[k]))
        .sum();
    let mut gradient = [(); 3].map(|()| DVector::zeros(estimate.structure.count()));
    for k in 1..=order {
        let moved = -root.powu((order - k) as u32) / slope;
        gradient[0][first + k - 1] = moved.re;
        gradient[1][first + k - 1] = moved.im;
        gradient[2][first + k - 1] = (root.conj() * moved).re / root.norm();
    }
    let known = |value: f64, gradient: &DVector<f64>| {
        IntervalEstimate::around(value, HALF_95 * deviation(estimate, gradient))
    };
    let continuous = root.ln() / ts_s;
    Pole {
        re: known(root.re, &gradient[0]),
        im: known(root.im, &gradient[1]),
        radius: known(root.norm(), &gradient[2]),
        decay_rad_s: continuous.re,
        turn_rad_s: continuous.im,
    }
}
