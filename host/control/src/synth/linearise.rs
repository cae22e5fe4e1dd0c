//! The linear model about a pose at rest, exact: no differences are taken.
//!
//! At rest M q'' = torque - G, and M's own change multiplies q'' = 0, so
//! dq''/dq = M^-1 (dtorque/dq - dG/dq). The Coriolis torques are quadratic in the speeds and
//! leave nothing.

use super::error::DesignError;
use super::joint_slope::JointSlope;
use super::omitted::OmittedEffect;
use super::operating_point::OperatingPoint;
use super::system::Continuous;
use crate::model::{Angles, Model};
use nalgebra::{DMatrix, DVector, stack};

/// A linear model with the operating point that it departs from.
#[derive(Debug, Clone)]
pub struct Linearisation {
    /// The linear model.
    pub plant: Continuous,
    /// Inputs of the driven joints that hold the pose, each in the SI unit of its drive.
    pub inputs: Vec<f64>,
    /// Effects that it leaves out, by joint.
    pub omitted: Vec<OmittedEffect>,
}

/// The linear model of `model` about `pose_rad` (its own convention of angles).
///
/// Body effects, joint torques and drives count with their exact slopes at rest; effects without a
/// derivative there (Coulomb friction, dead zones, ..) are left out and listed. A delay does not
/// count: it is [`zoh`](super::zoh)'s matter, see [`input_delay_s`](super::input_delay_s).
///
/// # Errors
/// A pose that is no equilibrium of the smooth effects, nothing driven.
pub fn linearise(model: &Model, pose_rad: &[f64]) -> Result<Linearisation, DesignError> {
    let point = OperatingPoint::of(model, pose_rad)?;
    let n = model.link_count();
    let driven = model.driven_joints();
    if driven.is_empty() {
        return Err(DesignError::model(
            format!("no joint of `{}` is driven", model.name),
            "give a [[joint]] another drive than passive",
        ));
    }
    // The model's own angles are `convention` times the relative ones.
    let (convention, back) = match model.angles {
        Angles::Relative => (DMatrix::identity(n, n), DMatrix::identity(n, n)),
        Angles::Absolute => (
            DMatrix::from_element(n, n, 1.0).lower_triangle(),
            DMatrix::from_fn(n, n, |i, j| f64::from(i == j) - f64::from(i == j + 1)),
        ),
    };
    let diagonal = |of: fn(&JointSlope) -> f64| {
        DMatrix::from_diagonal(&DVector::from_iterator(n, point.joints.iter().map(of)))
    };
    let per_rad = diagonal(|s| s.per_rad) - &point.rigid.gravity_slope
        + diagonal(|s| s.per_pose_rad) * &convention;
    let mut per_input = DMatrix::zeros(n, driven.len());
    for (input, &joint) in driven.iter().enumerate() {
        per_input[(joint, input)] = point.joints[joint].per_input;
    }
    let mass = point.rigid.mass.clone();
    let mass = mass.cholesky().ok_or_else(|| no_inertia(model))?;
    let accelerate = |torque: DMatrix<f64>| &convention * mass.solve(&torque);
    let damping = accelerate(diagonal(|s| s.per_rad_s)) * &back;
    let a = stack![0, DMatrix::identity(n, n); accelerate(per_rad) * &back, damping];
    let b = stack![DMatrix::zeros(n, driven.len()); accelerate(per_input)];
    let mut c = DMatrix::identity(2 * n, 2 * n);
    for (joint, slope) in point.joints.iter().enumerate() {
        c[(joint, joint)] = slope.reading;
        c[(n + joint, n + joint)] = slope.reading;
    }
    Ok(Linearisation {
        plant: Continuous { a, b, c },
        inputs: point.inputs,
        omitted: point.omitted,
    })
}

/// Masses and inertias with which some motion has no inertia.
pub(super) fn no_inertia(model: &Model) -> DesignError {
    DesignError::model(
        format!(
            "the masses and inertias of `{}` do not make a positive inertia",
            model.name
        ),
        "give every link a mass and an inertia",
    )
}

#[cfg(test)]
mod tests;
