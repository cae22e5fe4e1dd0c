//! A discrete-time model of a servo, its prediction errors and their gradients.

use super::polynomial::{filter, multiply};
use super::record::Record;
use super::structure::Structure;

use nalgebra::DMatrix;
use serde::Serialize;

/// `A(q) y = B(q)/F(q) u + C(q)/D(q) e` with polynomials in the delay operator.
///
/// `a c d f` begin with 1; `b` begins with as many zeros as there are samples of delay.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct TransferModel {
    /// Left of the output.
    pub a: Vec<f64>,
    /// From the input, delay included.
    pub b: Vec<f64>,
    /// Noise, numerator.
    pub c: Vec<f64>,
    /// Noise, denominator.
    pub d: Vec<f64>,
    /// From the input, denominator.
    pub f: Vec<f64>,
}

impl TransferModel {
    /// With the coefficients `values`, in the order of [`Structure::names`].
    pub fn of(structure: &Structure, values: &[f64]) -> Self {
        let mut rest = values;
        let mut take = |count: usize, head: &[f64]| {
            let (own, left) = rest.split_at(count);
            rest = left;
            [head, own].concat()
        };
        TransferModel {
            a: take(structure.na, &[1.0]),
            b: take(structure.nb, &vec![0.0; structure.nk]),
            c: take(structure.nc, &[1.0]),
            d: take(structure.nd, &[1.0]),
            f: take(structure.nf, &[1.0]),
        }
    }

    /// The coefficients, in the order of [`Structure::names`].
    pub fn values(&self, structure: &Structure) -> Vec<f64> {
        let parts = [
            &self.a[1..],
            &self.b[structure.nk..],
            &self.c[1..],
            &self.d[1..],
            &self.f[1..],
        ];
        parts.concat()
    }

    /// Denominator from input to output: A F.
    pub fn denominator(&self) -> Vec<f64> {
        multiply(&self.a, &self.f)
    }

    /// What the model alone makes of the input, without a look at the output: B/(A F) u.
    pub fn simulated(&self, input: &[f64]) -> Vec<f64> {
        filter(&self.b, &self.denominator(), input)
    }

    /// One-step prediction errors: `e = D/C (A y - B/F u)`, Ljung (1999), eq. 4.39.
    pub fn errors(&self, record: &Record) -> Vec<f64> {
        filter(&self.d, &self.c, &self.left_over(record).1)
    }

    /// `w = B/F u`, and `v = A y - w`.
    fn left_over(&self, record: &Record) -> (Vec<f64>, Vec<f64>) {
        let w = filter(&self.b, &self.f, &record.input);
        let mut v = filter(&self.a, &[1.0], &record.output);
        for (v, w) in v.iter_mut().zip(&w) {
            *v -= w;
        }
        (w, v)
    }

    /// Errors, and their derivatives by every coefficient as one column each (Ljung 1999, eq.
    /// 10.53).
    ///
    /// A coefficient's derivative is its polynomial's own filtered signal, delayed.
    pub fn gradient(&self, structure: &Structure, record: &Record) -> (Vec<f64>, DMatrix<f64>) {
        let (w, v) = self.left_over(record);
        let errors = filter(&self.d, &self.c, &v);
        let cf = multiply(&self.c, &self.f);
        let negated = |signal: Vec<f64>| signal.into_iter().map(|x| -x).collect::<Vec<f64>>();
        let signals = [
            (structure.na, 1, filter(&self.d, &self.c, &record.output)),
            (
                structure.nb,
                structure.nk,
                negated(filter(&self.d, &cf, &record.input)),
            ),
            (structure.nc, 1, negated(filter(&[1.0], &self.c, &errors))),
            (structure.nd, 1, filter(&[1.0], &self.c, &v)),
            (structure.nf, 1, filter(&self.d, &cf, &w)),
        ];
        let samples = errors.len();
        let mut jacobian = DMatrix::zeros(samples, structure.count());
        let mut column = 0;
        for (count, first, signal) in &signals {
            for k in 0..*count {
                let delay = (first + k).min(samples);
                jacobian.column_mut(column).as_mut_slice()[delay..]
                    .copy_from_slice(&signal[..samples - delay]);
                column += 1;
            }
        }
        (errors, jacobian)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sysid::generate::{paper_noise_model, pseudo_random};
    use crate::sysid::structure::structures;

    /// Derivatives by filtering against differences of errors computed again, for every family.
    #[test]
    fn the_gradient_is_that_of_finite_differences() {
        let input = pseudo_random(300, 7, 3);
        let record = Record::new(
            "r",
            input.clone(),
            paper_noise_model().respond(&input, 0.3, 5),
        );
        for text in ["arx:2,2,1", "armax:2,1,2,2", "oe:2,3,1", "bj:2,2,1,2,1"] {
            let structure = structures(text).unwrap()[0];
            let values: Vec<f64> = (0..structure.count())
                .map(|k| 0.3 * (1.7 * k as f64 + 1.0).sin())
                .collect();
            let (errors, jacobian) =
                TransferModel::of(&structure, &values).gradient(&structure, &record);
            assert_eq!(
                errors,
                TransferModel::of(&structure, &values).errors(&record)
            );
            for k in 0..values.len() {
                let moved = |by: f64| {
                    let mut values = values.clone();
                    values[k] += by;
                    TransferModel::of(&structure, &values).errors(&record)
                };
                let (up, down) = (moved(1e-5), moved(-1e-5));
                for t in 0..errors.len() {
                    let difference = (up[t] - down[t]) / 2e-5;
                    let found = jacobian[(t, k)];
                    assert!(
                        (difference - found).abs() < 1e-6 * (1.0 + found.abs()),
                        "{text} {k} {t}: {difference} {found}"
                    );
                }
            }
        }
    }

    #[test]
    fn the_true_model_leaves_the_noise_that_was_put_in() {
        let input = pseudo_random(500, 7, 3);
        let truth = paper_noise_model();
        let output = truth.respond(&input, 0.1, 9);
        let errors = truth.errors(&Record::new("r", input, output));
        for (found, put) in errors
            .iter()
            .zip(crate::sysid::generate::noise(500, 0.1, 9))
        {
            assert!((found - put).abs() < 1e-12);
        }
    }
}
