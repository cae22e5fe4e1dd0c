//! The linear-quadratic regulator, continuous and sampled.

use super::riccati::{Kind, Problem};
use super::system::{Continuous, Discrete, poles};
use super::weights;
use crate::error::{Error, Result};
use nalgebra::{Complex, DMatrix};

/// u = -K x, the gains that minimise the sum (integral) of x'Qx + u'Ru.
#[derive(Debug, Clone)]
pub struct Gains {
    /// K, m x n.
    pub k: DMatrix<f64>,
    /// X, n x n, symmetric: x'Xx is the cost from x onwards.
    pub riccati: DMatrix<f64>,
    /// Largest entry of what X leaves in the Riccati equation, over the largest entry of X.
    pub residual: f64,
    /// Poles of A - B K, the slowest first: 1/s, or per sample.
    pub poles: Vec<Complex<f64>>,
}

/// The continuous regulator: minimises the integral of x'Qx + u'Ru.
///
/// # Errors
/// Weights of the wrong size or sign; plants that no gain stabilises.
pub fn lqr(plant: &Continuous, q: &DMatrix<f64>, r: &DMatrix<f64>) -> Result<Gains> {
    weights::check(q, r, plant.a.nrows(), plant.b.ncols())?;
    Gains::of(&Problem {
        kind: Kind::Continuous,
        a: &plant.a,
        b: &plant.b,
        q,
        r,
    })
}

/// The sampled regulator: minimises the sum of x'Qx + u'Ru.
///
/// `q` weighs the whole state, or the plant's own states: past inputs then cost nothing.
///
/// # Errors
/// As [`lqr`].
pub fn dlqr(plant: &Discrete, q: &DMatrix<f64>, r: &DMatrix<f64>) -> Result<Gains> {
    let (n, m) = (plant.a.nrows(), plant.b.ncols());
    let own = plant.plant_states();
    if q.shape() == (own, own) {
        weights::check(q, r, own, m)?;
    } else {
        weights::check(q, r, n, m)?;
    }
    let q = q.clone().resize(n, n, 0.0);
    Gains::of(&Problem {
        kind: Kind::Discrete,
        a: &plant.a,
        b: &plant.b,
        q: &q,
        r,
    })
}

impl Gains {
    fn of(problem: &Problem<'_>) -> Result<Gains> {
        let solution = problem.solve().ok_or_else(unstabilised)?;
        let mut poles = poles(&(problem.a - problem.b * &solution.k));
        let stable = match problem.kind {
            Kind::Continuous => poles.iter().all(|pole| pole.re < 0.0),
            Kind::Discrete => {
                poles.sort_by(|a, b| b.norm().total_cmp(&a.norm()));
                poles.iter().all(|pole| pole.norm() < 1.0)
            }
        };
        if !stable {
            return Err(unstabilised());
        }
        Ok(Gains {
            k: solution.k,
            riccati: solution.x,
            residual: solution.residual,
            poles,
        })
    }
}

fn unstabilised() -> Error {
    Error::design(
        "no gain stabilises the plant",
        "drive more joints, or weigh the states that are left free",
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Model;
    use crate::synth::{linearise, upright, zoh};
    use std::path::Path;

    fn handstand() -> Continuous {
        let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("models/handstand.toml");
        let model = Model::load(&file).unwrap();
        linearise(&model, &upright(&model)).unwrap()
    }

    /// Every digit printed must be met: half a unit of the last.
    fn printed(found: &DMatrix<f64>, rows: &[&[&str]]) {
        for (i, row) in rows.iter().enumerate() {
            for (j, text) in row.iter().enumerate() {
                let value: f64 = text.parse().unwrap();
                let decimals = text.split('.').nth(1).map_or(0, str::len) as i32;
                let off = (found[(i, j)] - value).abs();
                assert!(
                    off <= 0.5001 * 10f64.powi(-decimals),
                    "({i}, {j}): {} is not {text}",
                    found[(i, j)]
                );
            }
        }
    }

    #[test]
    fn the_handstand_is_the_paper_s() {
        let plant = handstand();
        let lower = plant.a.view((3, 0), (3, 3)).into_owned();
        printed(
            &lower,
            &[
                &["74.2389303", "-117.876386", "0.00277051808"],
                &["-81.5856717", "348.777745", "-76.0776043"],
                &["7.34705870", "-230.911331", "215.859143"],
            ],
        );
        printed(
            &plant.b.view((3, 0), (3, 2)).into_owned(),
            &[
                &["-176.206462", "97.5516654"],
                &["527.783095", "-467.263519"],
                &["-467.263519", "697.956578"],
            ],
        );
        let poles: Vec<f64> = poles(&plant.a).iter().map(|p| p.re).collect();
        for (pole, expected) in poles.iter().zip([21.2157, 12.5086, 5.6837]) {
            assert!((pole - expected).abs() < 5e-5, "{poles:?}");
        }
    }

    #[test]
    fn the_gains_are_the_paper_s() {
        let plant = handstand();
        let (q, r) = (DMatrix::identity(6, 6), DMatrix::identity(2, 2));
        printed(
            &lqr(&plant, &q, &r).unwrap().k,
            &[
                &[
                    "-146.72059",
                    "-63.33819",
                    "-23.20776",
                    "-25.28626",
                    "-11.85344",
                    "-5.06440",
                ],
                &[
                    "-92.63689",
                    "-41.06290",
                    "-13.32446",
                    "-15.86514",
                    "-8.12977",
                    "-2.20956",
                ],
            ],
        );
        let sampled = zoh(&plant, 0.01, 0.0).unwrap();
        printed(
            &dlqr(&sampled, &(100.0 * q), &r).unwrap().k,
            &[
                &[
                    "-75.758443",
                    "-32.187228",
                    "-11.454290",
                    "-13.004784",
                    "-6.2134254",
                    "-2.3441985",
                ],
                &[
                    "-62.056988",
                    "-26.928273",
                    "-9.0350845",
                    "-10.653945",
                    "-5.1619377",
                    "-1.8225471",
                ],
            ],
        );
    }
}
