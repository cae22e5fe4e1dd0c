//! The linear model about a pose at rest, exact: no differences are taken.
//!
//! At rest M q'' = torque - G, and M's own change multiplies q'' = 0, so dq''/dq = M^-1 (dtorque/dq - dG/dq). The
//! Coriolis torques are quadratic in the speeds and leave nothing.

use super::rest::Rest;
use super::system::Continuous;
use crate::error::{Error, Result};
use crate::model::{Angles, Model};
use nalgebra::{DMatrix, DVector};

/// The linear model of `model` about `pose_rad` (its own convention of angles).
///
/// Body effects, joint torques and drives count with their exact slopes at rest. A delay does not: it is
/// [`zoh`](super::zoh)'s matter, see [`input_delay_s`](super::input_delay_s).
///
/// # Errors
/// A pose that is no equilibrium, effects without a slope (Coulomb friction, dead zones, ..), nothing driven.
pub fn linearise(model: &Model, pose_rad: &[f64]) -> Result<Continuous> {
    let rest = Rest::of(model, pose_rad)?;
    let n = model.link_count();
    let driven: Vec<usize> = (0..n)
        .filter(|&joint| model.joints[joint].drive.is_driven())
        .collect();
    if driven.is_empty() {
        return Err(Error::design(
            format!("no joint of `{}` is driven", model.name),
            "give a [[joint]] another drive than passive",
        ));
    }
    // The model's own angles are `convention` times the relative ones.
    let convention = match model.angles {
        Angles::Relative => DMatrix::identity(n, n),
        Angles::Absolute => DMatrix::from_fn(n, n, |i, j| if j <= i { 1.0 } else { 0.0 }),
    };
    let back = match model.angles {
        Angles::Relative => DMatrix::identity(n, n),
        Angles::Absolute => DMatrix::from_fn(n, n, |i, j| match i.wrapping_sub(j) {
            0 => 1.0,
            1 => -1.0,
            _ => 0.0,
        }),
    };
    let diagonal = |of: fn(&super::rest::JointSlope) -> f64| {
        DMatrix::from_diagonal(&DVector::from_iterator(n, rest.joints.iter().map(of)))
    };
    let per_rad = diagonal(|s| s.per_rad) - rest.equations.gravity_slope(&rest.relative_rad)
        + diagonal(|s| s.per_pose_rad) * &convention;
    let mut per_input = DMatrix::zeros(n, driven.len());
    for (input, &joint) in driven.iter().enumerate() {
        per_input[(joint, input)] = rest.joints[joint].per_input;
    }
    let mass = rest.equations.mass(&rest.relative_rad);
    let mass = mass.cholesky().ok_or_else(|| {
        Error::design(
            format!(
                "the masses and inertias of `{}` do not make a positive inertia",
                model.name
            ),
            "give every link a mass and an inertia",
        )
    })?;
    let accelerate = |torque: DMatrix<f64>| &convention * mass.solve(&torque);
    let mut a = DMatrix::zeros(2 * n, 2 * n);
    a.view_mut((0, n), (n, n)).fill_with_identity();
    a.view_mut((n, 0), (n, n))
        .copy_from(&(accelerate(per_rad) * &back));
    a.view_mut((n, n), (n, n))
        .copy_from(&(accelerate(diagonal(|s| s.per_rad_s)) * &back));
    let mut b = DMatrix::zeros(2 * n, driven.len());
    b.view_mut((n, 0), (n, driven.len()))
        .copy_from(&accelerate(per_input));
    let mut c = DMatrix::identity(2 * n, 2 * n);
    for (joint, slope) in rest.joints.iter().enumerate() {
        c[(joint, joint)] = slope.reading;
        c[(n + joint, n + joint)] = slope.reading;
    }
    Ok(Continuous { a, b, c })
}
