//! How far the closed loop leans under a lasting torque, in closed form.
//!
//! At rest the sampled loop and the continuous one are alike: 0 = A x + B u + B_d d, u = -K x. A
//! dead zone that starts at zero takes its width from every input, with the sign of the input: the
//! robot comes to rest where that is a lasting torque of its own making.

use super::design::Design;
use super::eigen::no_eigenvalues;
use super::error::DesignError;
use super::integral::Integral;
use super::linearise::no_inertia;
use super::operating_point::OperatingPoint;
use crate::model::{Angles, Model};
use nalgebra::{DMatrix, DVector};

/// More inputs than these have too many combinations of signs.
const MOST_INPUTS: usize = 10;

/// Lasting departures of a closed loop.
#[derive(Debug, Clone, PartialEq)]
pub struct Stiffness {
    /// Departure of each joint (rows) per torque at each joint (columns), rad/N m; of slides m, N.
    pub lean_per_torque: DMatrix<f64>,
    /// Departure of each joint per dead zone that starts at zero and is as wide as the whole limit
    /// of its input, for the signs of the inputs that bring the largest lean and keep themselves
    /// up; none if no signs do, of more than ten inputs, in continuous time, or with integral
    /// action, which hunts in a dead zone.
    pub lean_per_dead_zone: Option<DVector<f64>>,
}

/// The stiffness of `design` for `model`.
///
/// # Errors
/// A pose that is no equilibrium, a loop with a pole on the edge of stability.
pub fn stiffness(model: &Model, design: &Design) -> Result<Stiffness, DesignError> {
    let n = model.link_count();
    let torque = torque_inputs(model, &design.x0[..n])?;
    let (states, inputs) = design.plant.b.shape();
    if let Some(integral) = &design.integral {
        return Ok(Stiffness {
            lean_per_torque: with_sums(design, integral, &torque)?,
            lean_per_dead_zone: None,
        });
    }
    // At rest every past input is the present one.
    let k = &design.gains.k;
    let mut one = DMatrix::identity(inputs, inputs);
    for past in 0..(k.ncols() - states) / inputs {
        one += k.columns(states + past * inputs, inputs);
    }
    let (Some(k), Some(closed)) = ({
        let k = one.lu().solve(&k.columns(0, states).into_owned());
        let closed = k.as_ref().map(|k| &design.plant.a - &design.plant.b * k);
        (k, closed.and_then(DMatrix::try_inverse))
    }) else {
        return Err(no_eigenvalues());
    };
    let lean_per_torque = (-&closed * torque).rows(0, n).into_owned();
    let per_input = -&closed * &design.plant.b;
    let lean_per_dead_zone = design.fixed.as_ref().and_then(|fixed| {
        let limits = DVector::from_column_slice(&fixed.ranges.input);
        dead_zone(&per_input, &k, &limits)
    });
    Ok(Stiffness {
        lean_per_torque,
        lean_per_dead_zone: lean_per_dead_zone.map(|lean| lean.rows(0, n).into_owned()),
    })
}

/// How a torque at each joint (columns) accelerates the states [angles, speeds] in a pose: 2 n x n.
///
/// # Errors
/// A pose that is no equilibrium.
pub fn torque_inputs(model: &Model, pose_rad: &[f64]) -> Result<DMatrix<f64>, DesignError> {
    let n = model.link_count();
    let point = OperatingPoint::of(model, pose_rad)?;
    let mass = point.rigid.mass.cholesky();
    let mass = mass.ok_or_else(|| no_inertia(model))?;
    let convention = match model.angles {
        Angles::Relative => DMatrix::identity(n, n),
        Angles::Absolute => DMatrix::from_element(n, n, 1.0).lower_triangle(),
    };
    let mut torque = DMatrix::zeros(2 * n, n);
    let accelerate = convention * mass.inverse();
    torque.view_mut((n, 0), (n, n)).copy_from(&accelerate);
    Ok(torque)
}

/// With sums the driven joints rest at the pose, and the inputs are whatever it takes: 0 = A x + B
/// u + `torque` d, 0 = q of the joints that are summed.
fn with_sums(
    design: &Design,
    integral: &Integral,
    torque: &DMatrix<f64>,
) -> Result<DMatrix<f64>, DesignError> {
    let (states, inputs) = design.plant.b.shape();
    let size = states + inputs;
    let mut rest = DMatrix::zeros(size, size);
    rest.view_mut((0, 0), (states, states))
        .copy_from(&design.plant.a);
    rest.view_mut((0, states), (states, inputs))
        .copy_from(&design.plant.b);
    for (sum, joint) in integral.joints.iter().enumerate() {
        rest[(states + sum, *joint)] = 1.0;
    }
    let push = -torque.clone().resize_vertically(size, 0.0);
    let lean = rest.lu().solve(&push).ok_or_else(no_eigenvalues)?;
    Ok(lean.rows(0, states / 2).into_owned())
}

/// Where the loop rests if each input lacks its limit: with signs that the inputs there have.
fn dead_zone(
    per_input: &DMatrix<f64>,
    k: &DMatrix<f64>,
    limits: &DVector<f64>,
) -> Option<DVector<f64>> {
    let inputs = limits.len();
    if inputs > MOST_INPUTS {
        return None;
    }
    let rests = (0..1_u32 << inputs).filter_map(|signs| {
        let sign = |i: usize| if signs >> i & 1 == 1 { -1.0 } else { 1.0 };
        let lost = DVector::from_fn(inputs, |i, _| -sign(i) * limits[i]);
        let rest = per_input * &lost;
        let input = -k * &rest;
        let keeps = (0..inputs).all(|i| input[i] * sign(i) > limits[i]);
        keeps.then_some(rest)
    });
    rests.max_by(|a, b| a.amax().total_cmp(&b.amax()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::synth::{CostWeights, Request};
    use std::path::Path;

    fn designed(text: &str, q: f64) -> (Model, Design) {
        let model = Model::parse(text, Path::new("handstand.toml")).unwrap();
        let request = Request {
            weights: CostWeights::equal(q),
            ..Request::standard(&model)
        };
        let design = Design::of(&model, &request).unwrap();
        (model, design)
    }

    /// The figures of an independent computation for the paper's robot.
    #[test]
    fn the_paper_s_robot_is_soft_on_the_bar() {
        let (model, design) = designed(include_str!("../../../models/handstand.toml"), 100.0);
        let found = stiffness(&model, &design).unwrap();
        let degrees = |lean: &DVector<f64>| lean.map(f64::to_degrees);
        let bar = degrees(&found.lean_per_torque.column(0).into_owned()) * 0.01;
        for (lean, expected) in bar.iter().zip([-9.0, 16.1, 12.7]) {
            assert!((lean - expected).abs() < 0.06, "{bar}");
        }
        let zone = degrees(&found.lean_per_dead_zone.unwrap()) * 0.005;
        for (lean, expected) in zone.iter().zip([0.34, -3.69, 8.24]) {
            let lean = lean * zone[0].signum();
            assert!((lean - expected).abs() < 0.006, "{zone}");
        }
    }

    /// Late inputs and absolute angles change what K looks like, not that torque is answered.
    #[test]
    fn a_lasting_torque_is_answered_by_gravity_and_gains() {
        let text = include_str!("../../../models/handstand.toml").to_string()
            + "\n[[effect]]\nkind = \"delay\"\njoint = \"all\"\ndelay_s = 0.013\n";
        for angles in ["relative", "absolute"] {
            let text = text.replace("angles = \"relative\"", &format!("angles = \"{angles}\""));
            let (model, design) = designed(&text, 1.0);
            let found = stiffness(&model, &design).unwrap();
            // Sampled: the lasting torque of a driven joint is an input that K does not know of.
            let (plant, _) = design.sampled.as_ref().unwrap();
            let own = plant.plant_states();
            let zoh = crate::synth::zoh(&design.plant, plant.ts_s, 0.0).unwrap();
            let mut push = DMatrix::zeros(plant.a.nrows(), zoh.b.ncols());
            push.rows_mut(0, own).copy_from(&zoh.b);
            let size = plant.a.nrows();
            let closed = &plant.a - &plant.b * &design.gains.k;
            let rest = (DMatrix::identity(size, size) - closed)
                .lu()
                .solve(&push)
                .unwrap();
            let driven = found.lean_per_torque.columns(1, 2);
            let rest = rest.rows(0, 3);
            assert!(
                (driven - rest).amax() < 1e-6 * rest.amax(),
                "{angles}: {driven} {rest}"
            );
        }
    }
}
