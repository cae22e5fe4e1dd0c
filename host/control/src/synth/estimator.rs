//! The stationary Kalman filter, and with gains the controller that needs no measured state (LQG).

use super::eigen::{poles, slowest_first};
use super::error::DesignError;
use super::gains::Gains;
use super::riccati::{Problem, TimeDomain};
use super::system::Discrete;
use super::unsolvable::RiccatiRole;
use super::weights::{self, Sign};
use nalgebra::{Complex, DMatrix, stack};

/// x(k|k) = x(k|k-1) + L (y - C x(k|k-1)), x(k+1|k) = A x(k|k) + B u.
#[derive(Debug, Clone)]
pub struct Estimator {
    /// L, N x p.
    pub gain: DMatrix<f64>,
    /// Covariance of x(k|k-1), N x N.
    pub covariance: DMatrix<f64>,
    /// What the covariance leaves in its equation, over its largest entry.
    pub residual: f64,
    /// Poles of A (I - L C), the slowest first.
    pub poles: Vec<Complex<f64>>,
}

/// The controller u = -K x(k|k): state z = x(k|k-1), z(k+1) = A z + B y, u = C z + D y.
#[derive(Debug, Clone)]
pub struct Compensator {
    /// N x N.
    pub a: DMatrix<f64>,
    /// N x p.
    pub b: DMatrix<f64>,
    /// m x N.
    pub c: DMatrix<f64>,
    /// m x p.
    pub d: DMatrix<f64>,
    /// Poles of plant and controller in a loop, the slowest first.
    pub loop_poles: Vec<Complex<f64>>,
}

/// Variance of a reading rounded to steps of `step`: step^2 / 12.
pub fn rounding_variance(step: f64) -> f64 {
    step * step / 12.0
}

/// The stationary Kalman filter of x(k+1) = A x + B u + w, y = C x + v, with covariances `process`
/// (N x N, or of the plant's own states) of w and `measurement` (p x p) of v.
///
/// # Errors
/// Covariances of the wrong size or sign; plants whose unstable modes the outputs do not show.
pub fn kalman(
    plant: &Discrete,
    process: &DMatrix<f64>,
    measurement: &DMatrix<f64>,
) -> Result<Estimator, DesignError> {
    let process = plant.whole_state("W", process)?;
    weights::of("V", measurement, plant.c.nrows(), "outputs", Sign::Definite)?;
    let (a, c) = (plant.a.transpose(), plant.c.transpose());
    let problem = Problem {
        time: TimeDomain::Discrete,
        a: &a,
        b: &c,
        q: &process,
        r: measurement,
    };
    let solution = problem
        .solve()
        .ok_or_else(|| problem.unsolvable(RiccatiRole::Estimator))?;
    let covariance = solution.x;
    let cp = &plant.c * &covariance;
    let innovation = (&cp * &c + measurement).cholesky().ok_or_else(|| {
        DesignError::model(
            "the innovation's covariance is not positive definite",
            "raise the measurement noise V",
        )
    })?;
    let gain = innovation.solve(&cp).transpose();
    let mut poles = poles(&(&plant.a - &plant.a * &gain * &plant.c))?;
    slowest_first(&mut poles);
    Ok(Estimator {
        gain,
        covariance,
        residual: solution.residual,
        poles,
    })
}

/// The estimator and the gains as one controller.
///
/// # Errors
/// Entries that are no numbers.
pub fn lqg(
    plant: &Discrete,
    gains: &Gains,
    estimator: &Estimator,
) -> Result<Compensator, DesignError> {
    let n = plant.a.nrows();
    let (k, l) = (&gains.k, &estimator.gain);
    let closed = &plant.a - &plant.b * k;
    let corrected = DMatrix::identity(n, n) - l * &plant.c;
    let (a, b) = (&closed * &corrected, &closed * l);
    let (c, d) = (-k * &corrected, -k * l);
    let driven = &plant.a + &plant.b * &d * &plant.c;
    let whole = stack![driven, &plant.b * &c; &b * &plant.c, a];
    let mut loop_poles = poles(&whole)?;
    slowest_first(&mut loop_poles);
    Ok(Compensator {
        a,
        b,
        c,
        d,
        loop_poles,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::synth::dlqr;

    fn plant() -> Discrete {
        Discrete {
            a: DMatrix::from_row_slice(2, 2, &[1.1, 0.1, 0.3, 0.9]),
            b: DMatrix::from_row_slice(2, 1, &[0.0, 0.1]),
            c: DMatrix::from_row_slice(1, 2, &[1.0, 0.0]),
            ts_s: 0.01,
            delayed_inputs: 0,
        }
    }

    fn one(value: f64) -> DMatrix<f64> {
        DMatrix::from_element(1, 1, value)
    }

    /// The Riccati recursion, run until it stands still.
    #[test]
    fn the_filter_is_where_the_recursion_ends() {
        let (plant, v) = (plant(), one(0.02));
        let w = DMatrix::from_diagonal_element(2, 2, 0.01);
        let estimator = kalman(&plant, &w, &v).unwrap();
        let mut p = DMatrix::identity(2, 2);
        for _ in 0..2000 {
            let s = &plant.c * &p * plant.c.transpose() + &v;
            let l = &p * plant.c.transpose() / s[0];
            let left = DMatrix::identity(2, 2) - &l * &plant.c;
            p = &plant.a * left * &p * plant.a.transpose() + &w;
        }
        assert!((&estimator.covariance - &p).amax() < 1e-12 * p.amax());
        assert!(estimator.poles.iter().all(|pole| pole.norm() < 1.0));
    }

    #[test]
    fn poles_of_the_loop_are_those_of_both() {
        let plant = plant();
        let gains = dlqr(&plant, &DMatrix::identity(2, 2), &one(1.0)).unwrap();
        let estimator = kalman(&plant, &DMatrix::identity(2, 2), &one(1.0)).unwrap();
        let controller = lqg(&plant, &gains, &estimator).unwrap();
        let mut apart = [gains.poles, estimator.poles].concat();
        apart.sort_by(|a, b| b.norm().total_cmp(&a.norm()));
        for (one, other) in apart.iter().zip(&controller.loop_poles) {
            assert!(
                (one.norm() - other.norm()).abs() < 1e-9,
                "{apart:?} {:?}",
                controller.loop_poles
            );
        }
    }

    #[test]
    fn what_no_output_shows_is_named() {
        let mut plant = plant();
        plant.a = DMatrix::from_row_slice(2, 2, &[0.5, 0.0, 0.0, 1.2]);
        let error = kalman(&plant, &DMatrix::identity(2, 2), &one(1.0)).unwrap_err();
        let text = error.to_string();
        assert!(
            text.contains("1.200000") && text.contains("state 2") && text.contains("no output"),
            "{text}"
        );
    }
}
