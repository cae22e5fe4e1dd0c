//! One gain for many plants: the multi-model regulator.
//!
//! Minimises the mean, over plants, of trace(P_i), the cost x'Qx + u'Ru summed from every start of
//! unit size, by gradient. With S_i the sum of x x' over those runs,
//! dJ/dK = 2 sum_i [(R + B'P_i B) K - B'P_i A] S_i (Levine, Athans, IEEE Trans. Automatic Control
//! 15 (1970) 44, told for sampled plants and several of them: Makila, Toivonen, IEEE Trans.
//! Automatic Control 32 (1987) 658). A gain that one plant escapes has no cost, so the search never
//! leaves the gains that hold all of them; it has to start from one, which
//! [`multi_model_continuation`] finds by widening the spread of the plants in stages.

use super::descent;
use super::error::DesignError;
use super::gains::dlqr;
use super::riccati::stein;
use super::system::Discrete;
use nalgebra::{DMatrix, DVector};

/// Of the sums over all of a run.
const ACCURACY: f64 = 1e-14;

/// Largest modulus of the eigenvalues of a square matrix: below 1, A^k dies out.
///
/// By squaring: the growth of |A^N| for N = 2^24, exact to about ln(condition)/N. Never fails to
/// converge.
pub fn spectral_radius(a: &DMatrix<f64>) -> f64 {
    const SQUARINGS: i32 = 24;
    let (mut power, mut log_scale, mut share) = (a.clone(), 0.0, 1.0);
    for _ in 0..SQUARINGS {
        let size = power.norm();
        if size == 0.0 {
            return 0.0;
        }
        if !size.is_finite() {
            return f64::INFINITY;
        }
        power /= size;
        log_scale += share * size.ln();
        share /= 2.0;
        power = &power * &power;
    }
    let rest = power.norm();
    if rest == 0.0 {
        return 0.0;
    }
    (log_scale + share * rest.ln()).exp()
}

/// The gain of least mean cost over `plants`, searched from `start`, which must hold all of them.
///
/// # Errors
/// A start that lets one of the plants fall.
pub fn multi_model(
    plants: &[Discrete],
    q: &DMatrix<f64>,
    r: &DMatrix<f64>,
    start: &DMatrix<f64>,
) -> Result<DMatrix<f64>, DesignError> {
    let gain = |flat: &DVector<f64>| {
        DMatrix::from_column_slice(start.nrows(), start.ncols(), flat.as_slice())
    };
    let flat = |matrix: &DMatrix<f64>| DVector::from_column_slice(matrix.as_slice());
    let found = descent::least(flat(start), |k| {
        mean_cost(plants, q, r, &gain(k)).map(|(cost, gradient)| (cost, flat(&gradient)))
    });
    found.map(|k| gain(&k)).ok_or_else(|| {
        DesignError::model(
            "the gain to start from lets one of the plants fall",
            "start from plants that differ less",
        )
    })
}

/// The multi-model gain for the plants that `spread(share)` gives, `share` growing to 1 in `stages`
/// equal steps from the regulator of `spread(0)`'s first plant.
///
/// # Errors
/// Plants that part too far: no gain that holds all of them was found on the way.
pub fn multi_model_continuation<E: From<DesignError>>(
    spread: impl Fn(f64) -> Result<Vec<Discrete>, E>,
    stages: usize,
    q: &DMatrix<f64>,
    r: &DMatrix<f64>,
) -> Result<DMatrix<f64>, E> {
    let nominal = spread(0.0)?;
    let mut k = dlqr(&nominal[0], q, r)?.k;
    let q = &q
        .clone()
        .resize(nominal[0].a.nrows(), nominal[0].a.nrows(), 0.0);
    for stage in 1..=stages {
        let share = stage as f64 / stages as f64;
        k = multi_model(&spread(share)?, q, r, &k).map_err(|_| {
            DesignError::model(
                format!("no gain was found that holds all plants at {share:.2} of the spread"),
                "ask for less spread, or for more stages on the way",
            )
        })?;
    }
    Ok(k)
}

/// Logarithm of the mean cost, and its gradient; none if a plant falls.
fn mean_cost(
    plants: &[Discrete],
    q: &DMatrix<f64>,
    r: &DMatrix<f64>,
    k: &DMatrix<f64>,
) -> Option<(f64, DMatrix<f64>)> {
    let mut cost = 0.0;
    let mut gradient = DMatrix::zeros(k.nrows(), k.ncols());
    let weight = q + k.transpose() * r * k;
    let unit = DMatrix::identity(k.ncols(), k.ncols());
    for Discrete { a, b, .. } in plants {
        let closed = a - b * k;
        let s = stein(closed.transpose(), unit.clone(), ACCURACY)?;
        let p = stein(closed, weight.clone(), ACCURACY)?;
        let bp = b.transpose() * &p;
        cost += p.trace();
        gradient += 2.0 * ((r + &bp * b) * k - bp * a) * s;
    }
    (cost > 0.0 && cost.is_finite()).then(|| ((cost / plants.len() as f64).ln(), gradient / cost))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn plant(a: f64) -> Discrete {
        let unit = DMatrix::identity(1, 1);
        Discrete {
            a: unit.clone() * a,
            b: unit.clone(),
            c: unit,
            ts_s: 0.01,
            delayed_inputs: 0,
        }
    }

    #[test]
    fn a_radius_is_the_largest_eigenvalue() {
        let turn = DMatrix::from_row_slice(2, 2, &[0.6, -0.8, 0.8, 0.6]);
        assert!((spectral_radius(&(0.97 * turn)) - 0.97).abs() < 1e-6);
        let jordan = DMatrix::from_row_slice(2, 2, &[0.99, 100.0, 0.0, 0.99]);
        assert!((spectral_radius(&jordan) - 0.99).abs() < 1e-4);
        let nilpotent = DMatrix::from_row_slice(2, 2, &[0.0, 1.0, 0.0, 0.0]);
        assert_eq!(spectral_radius(&nilpotent), 0.0);
    }

    #[test]
    fn for_one_plant_it_is_the_regulator() {
        let (q, r) = (DMatrix::identity(1, 1), DMatrix::identity(1, 1));
        let plants = [plant(1.3)];
        let expected = dlqr(&plants[0], &q, &r).unwrap().k[0];
        let start = DMatrix::from_element(1, 1, 1.2);
        let k = multi_model(&plants, &q, &r, &start).unwrap()[0];
        assert!((k - expected).abs() < 1e-4, "{k} {expected}");
    }

    #[test]
    fn several_plants_share_the_gain_of_least_mean_cost() {
        let (q, r) = (DMatrix::identity(1, 1), DMatrix::identity(1, 1));
        let plants = [plant(0.9), plant(1.7)];
        let k = multi_model(&plants, &q, &r, &DMatrix::from_element(1, 1, 1.3)).unwrap()[0];
        // The scalar cost of a plant is (1 + k^2) / (1 - (a - k)^2): search it finely.
        let cost = |k: f64| -> f64 {
            let one = |a: f64| (1.0 + k * k) / (1.0 - (a - k).powi(2));
            one(0.9) + one(1.7)
        };
        let best = (701..1899)
            .map(|i| 1e-3 * f64::from(i))
            .min_by(|a, b| cost(*a).total_cmp(&cost(*b)));
        assert!((k - best.unwrap()).abs() < 1e-3, "{k} {best:?}");
        let fallen = multi_model(&plants, &q, &r, &DMatrix::from_element(1, 1, 0.1)).unwrap_err();
        assert_eq!(
            fallen.to_string(),
            "the gain to start from lets one of the plants fall"
        );
    }
}
