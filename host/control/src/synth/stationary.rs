//! The stationary covariance of the loop of gains and filter, under process and measurement noise.
//!
//! With x(k+1) = A x + B u + w, y = C x + v and the controller z(k+1) = Ac z + Bc y, u = Cc z + Dc
//! y, the covariance X of [x, z] solves the discrete Lyapunov equation X = F X F' + N, F the loop
//! and N what w and v bring. (Astrom, Introduction to Stochastic Control Theory, 1970, chapter 4.)

use super::design::{Design, Estimation};
use super::estimator::Compensator;
use super::riccati::stein;
use super::signal::Signal;
use super::system::Discrete;
use nalgebra::{DMatrix, stack};

/// To which accuracy the covariance is summed.
const ACCURACY: f64 = 1e-14;

/// Root mean squares of a loop that noise keeps moving, in SI.
#[derive(Debug, Clone, PartialEq)]
pub struct Stationary {
    /// Of each of the plant's own states, about the pose.
    pub state_rms: Vec<f64>,
    /// Of each input, about that of the pose.
    pub input_rms: Vec<f64>,
}

/// A signal that is larger than the range in which the law is linear.
#[derive(Debug, Clone, PartialEq)]
pub struct Beyond<'a> {
    /// Which one.
    pub signal: &'a Signal,
    /// Its root mean square, SI.
    pub rms: f64,
    /// The range, SI.
    pub range: f64,
}

/// The stationary root mean squares; none of a loop that does not decay. `process` is the
/// covariance of w (N x N), `measurement` of v.
pub(super) fn stationary(
    plant: &Discrete,
    compensator: &Compensator,
    process: &DMatrix<f64>,
    measurement: &DMatrix<f64>,
) -> Option<Stationary> {
    let Compensator { a, b, c, d, .. } = compensator;
    let (n, own) = (plant.a.nrows(), plant.plant_states());
    let driven = &plant.a + &plant.b * d * &plant.c;
    let whole = stack![driven, &plant.b * c; b * &plant.c, a];
    // How v enters: through u into the plant, and into the controller.
    let enters = stack![&plant.b * d; b];
    let mut noise = &enters * measurement * enters.transpose();
    let mut own_noise = noise.view_mut((0, 0), (n, n));
    own_noise += process;
    let covariance = stein(whole.transpose(), noise, ACCURACY)?;
    let input = stack![d * &plant.c, c];
    let inputs = &input * &covariance * input.transpose() + d * measurement * d.transpose();
    let rms = |of: &DMatrix<f64>, count: usize| -> Vec<f64> {
        (0..count).map(|i| of[(i, i)].max(0.0).sqrt()).collect()
    };
    Some(Stationary {
        state_rms: rms(&covariance, own),
        input_rms: rms(&inputs, plant.b.ncols()),
    })
}

impl Estimation {
    /// The angle, speed or input that noise alone drives furthest out of the ranges of `design`:
    /// the law is not linear there, and what is said of the linear loop does not hold.
    pub fn beyond<'a>(&self, design: &'a Design) -> Option<Beyond<'a>> {
        let (stationary, fixed) = (self.stationary.as_ref()?, design.fixed.as_ref()?);
        let states = design.states.iter().zip(&stationary.state_rms);
        let inputs = design.inputs.iter().zip(&stationary.input_rms);
        let ranges = &fixed.ranges;
        let all = states.zip(&ranges.state).chain(inputs.zip(&ranges.input));
        let beyond = all.filter(|((_, rms), range)| rms > range);
        let worst = beyond.max_by(|((_, a), ra), ((_, b), rb)| (*a / *ra).total_cmp(&(*b / *rb)));
        worst.map(|((signal, rms), range)| Beyond {
            signal,
            rms: *rms,
            range: *range,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::Model;
    use crate::sim::closed_loop::{normal, stream};
    use crate::synth::{CostWeights, Request, Sensors, rounding_variance};
    use nalgebra::DVector;
    use std::path::Path;

    fn designed(sensors: Sensors) -> Design {
        let text = include_str!("../../../models/handstand.toml");
        let model = Model::parse(text, Path::new("handstand.toml")).unwrap();
        let request = Request {
            sensors: Some(sensors),
            weights: CostWeights::PAPER,
            ..Request::standard(&model)
        };
        Design::of(&model, &request).unwrap()
    }

    fn sensors(position_step_deg: f64, gyro_step_deg_s: f64) -> Sensors {
        Sensors {
            position_step_rad: position_step_deg.to_radians(),
            gyro_step_rad_s: gyro_step_deg_s.to_radians(),
            process: None,
            recovery: 0.0,
        }
    }

    /// The figures of an independent computation, deg: sensors of the paper, and coarse ones.
    #[test]
    fn root_mean_squares_are_those_of_an_independent_computation() {
        let paper = designed(sensors(300.0 / 1024.0, 10.0));
        let coarse = Sensors {
            position_step_rad: 0.5,
            gyro_step_rad_s: 100.0,
            ..sensors(1.0, 1.0)
        };
        let coarse = designed(coarse);
        for (design, expected, within) in [
            (&paper, [1.6, 3.0, 2.4], 0.05),
            (&coarse, [154.0, 281.0, 197.0], 0.5),
        ] {
            let estimation = design.estimator.as_ref().unwrap();
            let rms = &estimation.stationary.as_ref().unwrap().state_rms;
            for (rms, expected) in rms.iter().zip(expected) {
                let found = rms.to_degrees();
                assert!((found - expected).abs() <= within, "{found} {expected}");
            }
        }
        assert_eq!(paper.estimator.as_ref().unwrap().beyond(&paper), None);
        let beyond = coarse.estimator.as_ref().unwrap().beyond(&coarse).unwrap();
        assert!(beyond.rms > beyond.range, "{beyond:?}");
    }

    /// Filter and gains as they run, x(k|k) and u = -K x(k|k), on drawn noise: not the
    /// compensator's matrices.
    #[test]
    fn a_simulation_with_drawn_noise_moves_as_much() {
        let design = designed(sensors(300.0 / 1024.0, 10.0));
        let estimation = design.estimator.as_ref().unwrap();
        let (plant, l) = (&estimation.plant, &estimation.estimator.gain);
        let held = crate::synth::zoh(&design.plant, 0.01, 0.0).unwrap().b;
        let limit = &design.fixed.as_ref().unwrap().ranges.input;
        let sd = [300.0 / 1024.0, 300.0 / 1024.0, 300.0 / 1024.0, 10.0_f64];
        let sd = sd.map(|step| rounding_variance(step.to_radians()).sqrt());
        let mut random = stream(3, 0);
        let (mut x, mut predicted) = (DVector::zeros(6), DVector::<f64>::zeros(6));
        let (mut angles, mut torques) = ([0.0; 3], [0.0; 2]);
        const STEPS: u32 = 400_000;
        for _ in 0..STEPS {
            let noise = DVector::from_fn(4, |i, _| sd[i] * normal(&mut random));
            let y = &plant.c * &x + noise;
            let estimate = &predicted + l * (y - &plant.c * &predicted);
            let u = -&design.gains.k * &estimate;
            predicted = &plant.a * estimate + &plant.b * &u;
            let pushed = DVector::from_fn(2, |i, _| 0.01 * limit[i] * normal(&mut random));
            for (sum, angle) in angles.iter_mut().zip(x.iter()) {
                *sum += angle * angle;
            }
            for (sum, torque) in torques.iter_mut().zip(u.iter()) {
                *sum += torque * torque;
            }
            x = &plant.a * x + &plant.b * u + &held * pushed;
        }
        let stationary = estimation.stationary.as_ref().unwrap();
        let found = angles.iter().chain(&torques);
        let expected = stationary.state_rms[..3]
            .iter()
            .chain(&stationary.input_rms);
        for (sum, expected) in found.zip(expected) {
            let found = (sum / f64::from(STEPS)).sqrt();
            assert!((found / expected - 1.0).abs() < 0.05, "{found} {expected}");
        }
    }

    /// The more the filter recovers, the larger the disk margin at the inputs, and the more the
    /// noise moves it.
    #[test]
    fn recovery_buys_margin_with_noise() {
        let text = include_str!("../../../models/handstand.toml");
        let model = Model::parse(text, Path::new("handstand.toml")).unwrap();
        let at = |recovery| {
            let design = designed(Sensors {
                recovery,
                ..sensors(300.0 / 1024.0, 10.0)
            });
            let margins = crate::synth::design_margins(&model, &design)
                .unwrap()
                .unwrap();
            let stationary = design.estimator.unwrap().stationary.unwrap();
            (margins.inputs.disk.alpha, stationary.input_rms[0])
        };
        let (none, some, much) = (at(0.0), at(0.1), at(1.0));
        assert!(
            none.0 < some.0 && some.0 < much.0,
            "{none:?} {some:?} {much:?}"
        );
        assert!(
            none.1 < some.1 && some.1 < much.1,
            "{none:?} {some:?} {much:?}"
        );
    }
}
