//! The linear-quadratic regulator, continuous and sampled.

use super::eigen::{poles, slowest_first};
use super::error::DesignError;
use super::riccati::{Problem, TimeDomain};
use super::system::{Continuous, Discrete};
use super::unsolvable::RiccatiRole;
use super::weights::{self, Sign};
use nalgebra::{Complex, DMatrix};

/// A pole this near to the edge of stability is not told from one on it.
const STABLE: f64 = 1e-8;

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
pub fn lqr(plant: &Continuous, q: &DMatrix<f64>, r: &DMatrix<f64>) -> Result<Gains, DesignError> {
    weights::of("Q", q, plant.a.nrows(), "states", Sign::Semidefinite)?;
    weights::of("R", r, plant.b.ncols(), "inputs", Sign::Definite)?;
    Gains::of(&Problem {
        time: TimeDomain::Continuous,
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
pub fn dlqr(plant: &Discrete, q: &DMatrix<f64>, r: &DMatrix<f64>) -> Result<Gains, DesignError> {
    let q = plant.whole_state("Q", q)?;
    weights::of("R", r, plant.b.ncols(), "inputs", Sign::Definite)?;
    Gains::of(&Problem {
        time: TimeDomain::Discrete,
        a: &plant.a,
        b: &plant.b,
        q: &q,
        r,
    })
}

/// Sampling time, s, that stands for continuous time in a loop with these poles, 1/s: half the
/// fastest mode's time constant, but at least 0.1 ms, for shorter ones take too long to simulate,
/// and at most 1 ms.
pub fn continuous_period_s(poles: &[Complex<f64>]) -> f64 {
    let fastest_1_s = poles.iter().map(|pole| pole.norm()).fold(0.0, f64::max);
    (0.5 / fastest_1_s).clamp(1e-4, 1e-3)
}

impl Gains {
    fn of(problem: &Problem<'_>) -> Result<Gains, DesignError> {
        let refused = || problem.unsolvable(RiccatiRole::Regulator);
        let solution = problem.solve().ok_or_else(refused)?;
        let mut poles = poles(&(problem.a - problem.b * &solution.k))?;
        let stable = match problem.time {
            TimeDomain::Continuous => {
                let slack = STABLE * problem.a.norm();
                poles.iter().all(|pole| pole.re < -slack)
            }
            TimeDomain::Discrete => {
                slowest_first(&mut poles);
                poles.iter().all(|pole| pole.norm() < 1.0 - STABLE)
            }
        };
        if !stable {
            return Err(refused());
        }
        Ok(Gains {
            k: solution.k,
            riccati: solution.x,
            residual: solution.residual,
            poles,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::Model;
    use crate::synth::{linearise, upright, zoh};
    use std::path::Path;

    fn handstand() -> Continuous {
        let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../models/handstand.toml");
        let model = Model::load(&file).unwrap();
        linearise(&model, &upright(&model)).unwrap().plant
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

    /// An acrobot with its elbow driven: torques that cost next to nothing.
    #[test]
    fn cheap_inputs_have_gains() {
        let joint = |drive: &str| format!("\n[[joint]]\ndrive = \"{drive}\"\n");
        let link =
            "\n[[link]]\nlength_m = 0.3\ncom_m = 0.15\nmass_kg = 0.4\ninertia_kg_m2 = 0.003\n";
        let text = format!(
            "[rig]\nname = \"acrobot\"\nangle_zero = \"upright\"\nangles = \"relative\"\n\
             step_s = 0.001\n{link}{link}{}{}\n[log]\ntime = {{ column = \"t\", unit = \"s\" }}\n\n\
             [[log.joint]]\nposition = {{ column = \"q1\", unit = \"rad\" }}\n\n[[log.joint]]\n\
             position = {{ column = \"q2\", unit = \"rad\" }}\n\
             input = {{ column = \"u2\", unit = \"N m\" }}\n",
            joint("passive"),
            joint("torque")
        );
        let model = Model::parse(&text, Path::new("acrobot.toml")).unwrap();
        let plant = linearise(&model, &upright(&model)).unwrap().plant;
        let sampled = zoh(&plant, 0.01, 0.0).unwrap();
        let gains = |q: f64, r: f64| {
            let (q, r) = (DMatrix::identity(4, 4) * q, DMatrix::identity(1, 1) * r);
            dlqr(&sampled, &q, &r).map(|gains| gains.k)
        };
        let limit = gains(1.0, 1e-9).unwrap();
        for cost in [10f64.powf(-10.5), 1e-11, 1e-12, 1e-13] {
            let k = gains(1.0, cost).unwrap();
            let closed = &sampled.a - &sampled.b * &k;
            let radius = poles(&closed)
                .unwrap()
                .iter()
                .map(|pole| pole.norm())
                .fold(0.0, f64::max);
            assert!(radius < 1.0, "{cost}: {radius}");
            // They tend to a limit: that of inputs that cost nothing.
            assert!((&k - &limit).amax() < 1e-2 * limit.amax(), "{cost}: {k}");
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
        let poles: Vec<f64> = poles(&plant.a).unwrap().iter().map(|p| p.re).collect();
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

    fn sampled(a: &[f64], b: &[f64]) -> Discrete {
        let n = b.len();
        Discrete {
            a: DMatrix::from_row_slice(n, n, a),
            b: DMatrix::from_row_slice(n, 1, b),
            c: DMatrix::identity(n, n),
            ts_s: 0.01,
            delayed_inputs: 0,
        }
    }

    fn refusal(result: Result<Gains, DesignError>) -> String {
        let error = crate::error::Error::from(result.unwrap_err());
        assert_eq!(error.exit_code(), 3);
        assert!(error.remedy().is_some());
        error.to_string()
    }

    #[test]
    fn what_cannot_be_stabilised_is_named() {
        let (q, r) = (DMatrix::identity(2, 2), DMatrix::identity(1, 1));
        let lost = sampled(&[0.5, 0.0, 0.0, 1.07], &[1.0, 0.0]);
        let said = refusal(dlqr(&lost, &q, &r));
        assert!(
            said.contains("pole 1.070000, strongest in state 2: no input"),
            "{said}"
        );
        let drifts = sampled(&[0.5, 0.0, 0.0, 1.0], &[1.0, 0.0]);
        assert!(refusal(dlqr(&drifts, &q, &r)).contains("no input"));
        let plant = Continuous {
            a: lost.a.clone(),
            b: lost.b.clone(),
            c: lost.c.clone(),
        };
        assert!(refusal(lqr(&plant, &q, &r)).contains("1.070000 1/s"));
    }

    #[test]
    fn a_mode_on_the_circle_must_be_weighed() {
        let drifts = sampled(&[1.0, 0.0, 0.0, 0.5], &[1.0, 1.0]);
        let q = DMatrix::from_diagonal(&nalgebra::dvector![0.0, 1.0]);
        let said = refusal(dlqr(&drifts, &q, &DMatrix::identity(1, 1)));
        assert!(said.contains("Q does not weigh it"), "{said}");
    }

    /// The least gain that stabilises mirrors the growing pole at the circle.
    #[test]
    fn growing_modes_need_no_weight() {
        let grows = sampled(&[1.25, 0.0, 0.0, 0.5], &[1.0, 1.0]);
        let gains = dlqr(&grows, &DMatrix::zeros(2, 2), &DMatrix::identity(1, 1)).unwrap();
        assert!(
            (gains.poles[0].norm() - 0.8).abs() < 1e-12,
            "{:?}",
            gains.poles
        );
        let plant = Continuous {
            a: grows.a,
            b: grows.b,
            c: grows.c,
        };
        let gains = lqr(&plant, &DMatrix::zeros(2, 2), &DMatrix::identity(1, 1)).unwrap();
        let mut poles: Vec<f64> = gains.poles.iter().map(|pole| pole.re).collect();
        poles.sort_by(f64::total_cmp);
        assert!(
            (poles[0] + 1.25).abs() < 1e-9 && (poles[1] + 0.5).abs() < 1e-9,
            "{poles:?}"
        );
    }

    #[test]
    fn weights_that_are_none_are_refused() {
        let plant = sampled(&[0.5, 0.1, 0.0, 1.07], &[1.0, 1.0]);
        let (q, r) = (DMatrix::identity(2, 2), DMatrix::identity(1, 1));
        let matrix = |values: &[f64]| DMatrix::from_row_slice(2, 2, values);
        for (bad, words) in [
            (
                matrix(&[1.0, 0.1, 0.0, 1.0]),
                "Q is not symmetric: entry (2, 1) is 0, entry (1, 2) is 0.1",
            ),
            (
                matrix(&[1.0, 2.0, 2.0, 1.0]),
                "Q is not positive semidefinite: its least eigenvalue is -1",
            ),
            (matrix(&[1.0, 0.0, 0.0, f64::NAN]), "Q has an entry of NaN"),
            (
                DMatrix::identity(3, 3),
                "Q is 3 x 3, but there are 2 states",
            ),
        ] {
            let said = refusal(dlqr(&plant, &bad, &r));
            assert!(said.contains(words), "{said}");
        }
        for bad in [0.0, -1.0] {
            let said = refusal(dlqr(&plant, &q, &(&r * bad)));
            assert!(said.contains("R is not positive definite"), "{said}");
        }
    }
}
