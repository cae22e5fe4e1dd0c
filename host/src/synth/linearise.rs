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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::synth::{Equations, balanced};
    use std::path::Path;

    /// Three links with drives and effects of every kind that has a slope.
    fn model(angles: &str) -> Model {
        let text = format!(
            r#"
[rig]
name = "all"
angle_zero = "upright"
angles = "{angles}"
gravity_m_s2 = 9.81
step_s = 0.001
[[link]]
length_m = 0.15
com_m = 0.1
mass_kg = 0.2
inertia_kg_m2 = 1.2e-4
[[link]]
length_m = 0.1
com_m = 0.06
mass_kg = 0.3
inertia_kg_m2 = 2e-4
[[link]]
com_m = 0.08
mass_kg = 0.1
inertia_kg_m2 = 3e-4
[[joint]]
drive = "passive"
[[joint]]
drive = "position"
gain_per_rad = 8
stall_torque_nm = 1.5
no_load_speed_rad_s = 6.0
[[joint]]
drive = "speed"
gain_s_per_rad = 0.3
stall_torque_nm = 1.2
no_load_speed_rad_s = 5.0
[[effect]]
kind = "viscous"
joint = 1
coefficient_nm_s_rad = 0.02
[[effect]]
kind = "cable_spring"
joint = 2
stiffness_nm_rad = 0.3
rest_angle_rad = 0.1
[[effect]]
kind = "cogging"
joint = 3
amplitude_nm = 0.02
periods_per_turn = 5
phase_rad = 0.3
[[effect]]
kind = "supply_sag"
joint = 2
drop_share = 0.1
[[effect]]
kind = "torque_scale"
joint = 3
factor = 0.9
[[effect]]
kind = "speed_limit"
joint = 3
no_load_speed_rad_s = 7
[[effect]]
kind = "armature"
joint = 2
inertia_kg_m2 = 1e-3
[[effect]]
kind = "com_angle"
joint = 1
angle_rad = 0.1
[[effect]]
kind = "encoder_scale"
joint = 2
factor = 1.05
[log]
time = {{ column = "t", unit = "s" }}
[[log.joint]]
position = {{ column = "p1", unit = "rad" }}
[[log.joint]]
position = {{ column = "p2", unit = "rad" }}
input = {{ column = "u2", unit = "rad" }}
[[log.joint]]
position = {{ column = "p3", unit = "rad" }}
input = {{ column = "u3", unit = "rad/s" }}
"#
        );
        Model::parse(&text, Path::new("all.toml")).unwrap()
    }

    /// Accelerations in the model's convention, every law written out again.
    fn accelerations(model: &Model, pose: &[f64], speed: &[f64], input: &[f64]) -> Vec<f64> {
        let absolute = model.angles == Angles::Absolute;
        let apart = |x: &[f64]| -> Vec<f64> {
            let before = |i: usize| if absolute && i > 0 { x[i - 1] } else { 0.0 };
            (0..3).map(|i| x[i] - before(i)).collect()
        };
        let (q, w) = (apart(pose), apart(speed));
        let duty2 = 8.0 * (input[0] - 1.05 * pose[1]);
        let drive2 = 1.5 * (duty2 - w[1] / 6.0) * (1.0 - 0.1 * duty2.abs());
        let duty3 = input[1] / 5.0 + 0.3 * (input[1] - w[2]);
        let drive3 = 0.9 * 1.2 * (duty3 - w[2] / 5.0) - 1.2 * w[2] / 7.0;
        let torque = nalgebra::dvector![
            -0.02 * w[0],
            drive2 - 0.3 * (q[1] - 0.1),
            drive3 + 0.02 * (5.0 * q[2] + 0.3).sin()
        ];
        let mut hanging = q.clone();
        hanging[0] += std::f64::consts::PI;
        let equations = Equations::of(&model.rig(false));
        let left = torque
            - equations.coriolis(&hanging, &w) * DVector::from_column_slice(&w)
            - equations.gravity(&hanging);
        let relative = equations.mass(&hanging).lu().solve(&left).unwrap();
        let sum = |i: usize| match absolute {
            true => relative.rows(0, i + 1).sum(),
            false => relative[i],
        };
        (0..3).map(sum).collect()
    }

    #[test]
    fn slopes_are_those_of_the_whole_law() {
        for angles in ["relative", "absolute"] {
            let model = model(angles);
            let pose = balanced(&model, &[0.1, 0.3, -0.2]).unwrap();
            let rest = Rest::of(&model, &pose).unwrap();
            let still = accelerations(&model, &pose, &[0.0; 3], &rest.inputs);
            assert!(still.iter().all(|a| a.abs() < 1e-9), "{still:?}");
            let plant = linearise(&model, &pose).unwrap();
            let at = |column: usize, h: f64| {
                let mut z = [pose.clone(), vec![0.0; 3], rest.inputs.clone()].concat();
                z[column] += h;
                accelerations(&model, &z[..3], &z[3..6], &z[6..])
            };
            for column in 0..8 {
                let h = 1e-5;
                let (up, down) = (at(column, h), at(column, -h));
                for i in 0..3 {
                    let slope = (up[i] - down[i]) / (2.0 * h);
                    let found = match column {
                        0..6 => plant.a[(3 + i, column)],
                        _ => plant.b[(3 + i, column - 6)],
                    };
                    let off = (found - slope).abs();
                    assert!(
                        off < 1e-5 * slope.abs().max(10.0),
                        "{angles} {column} {i}: {found} {slope}"
                    );
                }
            }
            assert_eq!(plant.c[(1, 1)], 1.05);
        }
    }

    #[test]
    fn what_has_no_slope_is_named_with_its_remedy() {
        let mut model = model("relative");
        let pose = balanced(&model, &[0.0; 3]).unwrap();
        let coulomb = crate::effects::named("coulomb").unwrap();
        model.effects.push(crate::model::EffectInstance {
            effect: coulomb,
            joint: Some(1),
            values: vec![0.1],
        });
        let error = linearise(&model, &pose).unwrap_err();
        assert!(
            error.to_string().contains("at joint 2 has no slope"),
            "{error}"
        );
        assert!(error.remedy().unwrap().contains("--without coulomb"));
        model.effects.last_mut().unwrap().values = vec![0.0];
        assert!(linearise(&model, &pose).is_ok());
        let error = linearise(&model, &[0.5, 0.0, 0.0]).unwrap_err();
        assert!(error.to_string().contains("joint 1 is passive"), "{error}");
        for joint in &mut model.joints {
            joint.drive = crate::model::Drive::Passive;
        }
        let pose = balanced(&model, &[0.0; 3]).unwrap();
        let error = linearise(&model, &pose).unwrap_err();
        assert!(
            error.to_string().contains("no joint of `all` is driven"),
            "{error}"
        );
    }
}
