use super::*;
use crate::dynamics::EquationsOfMotion;
use crate::synth::rigid::rigid_rig;
use crate::synth::{NonSmooth, balanced, upright};
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
    let rig = rigid_rig(model);
    let equations = EquationsOfMotion::new(&rig.chain, rig.gravity_turn_rad);
    let left = torque
        - equations.coriolis(&hanging, &w) * DVector::from_column_slice(&w)
        - equations.gravity(&hanging);
    let relative = equations.mass(&hanging).lu().solve(&left).unwrap();
    let sum = |i: usize| {
        if absolute {
            relative.rows(0, i + 1).sum()
        } else {
            relative[i]
        }
    };
    (0..3).map(sum).collect()
}

#[test]
fn slopes_are_those_of_the_whole_law() {
    for angles in ["relative", "absolute"] {
        let model = model(angles);
        let pose = balanced(&model, &[0.1, 0.3, -0.2]).unwrap();
        let Linearisation {
            plant,
            inputs,
            omitted,
        } = linearise(&model, &pose).unwrap();
        assert_eq!(omitted, []);
        let still = accelerations(&model, &pose, &[0.0; 3], &inputs);
        assert!(still.iter().all(|a| a.abs() < 1e-9), "{still:?}");
        let at = |column: usize, h: f64| {
            let mut z = [pose.clone(), vec![0.0; 3], inputs.clone()].concat();
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

fn put(model: &mut Model, id: &str, joint: usize, values: &[f64]) {
    model.effects.push(crate::model::EffectInstance {
        effect: crate::effects::named(id).unwrap(),
        joint: Some(joint),
        values: values.to_vec(),
    });
}

#[test]
fn what_has_no_derivative_is_left_out_and_listed() {
    let mut model = model("relative");
    let pose = balanced(&model, &[0.0; 3]).unwrap();
    let smooth = linearise(&model, &pose).unwrap();
    put(&mut model, "coulomb", 0, &[0.1]);
    put(&mut model, "coulomb", 1, &[0.1]);
    put(&mut model, "dead_zone", 1, &[0.08, 0.0]);
    put(&mut model, "backlash", 2, &[0.02]);
    put(&mut model, "torque_saturation", 1, &[1.0]);
    // At the value at which it does nothing, an effect is not left out: it is not there.
    put(&mut model, "coulomb", 2, &[0.0]);
    assert_eq!(balanced(&model, &[0.0; 3]).unwrap(), pose);
    let found = linearise(&model, &pose).unwrap();
    assert_eq!(found.plant, smooth.plant);
    assert_eq!(found.inputs, smooth.inputs);
    let listed: Vec<_> = found
        .omitted
        .iter()
        .map(|o| (o.effect.info().id, o.joint.unwrap(), o.why))
        .collect();
    assert_eq!(
        listed,
        [
            ("coulomb", 0, NonSmooth::JumpsAtStandstill),
            ("dead_zone", 1, NonSmooth::DeadAtZero),
            ("coulomb", 1, NonSmooth::JumpsAtStandstill),
            ("backlash", 2, NonSmooth::Memory),
        ]
    );
}

#[test]
fn a_gear_that_gives_is_designed_with_as_if_it_were_rigid() {
    let mut rigid = model("relative");
    let mut geared = rigid.clone();
    put(&mut rigid, "armature", 1, &[2e-3]);
    put(&mut rigid, "armature", 2, &[1e-3]);
    put(&mut geared, "gear_compliance", 1, &[2e-3, 5.0, 0.1]);
    put(&mut geared, "gear_backlash", 2, &[1e-3, 0.03]);
    let pose = balanced(&rigid, &[0.0; 3]).unwrap();
    let (rigid, found) = (linearise(&rigid, &pose), linearise(&geared, &pose));
    let (rigid, found) = (rigid.unwrap(), found.unwrap());
    assert_eq!(found.plant, rigid.plant);
    let listed = found.omitted.iter();
    let listed: Vec<_> = listed.map(|o| (o.effect.info().id, o.why)).collect();
    let why = NonSmooth::OwnState;
    assert_eq!(listed, [("gear_compliance", why), ("gear_backlash", why)]);
}

/// A limit at the very torque that the pose takes is left out; below that nothing holds the
/// pose.
#[test]
fn a_torque_limit_counts_by_what_the_pose_takes() {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../models/handstand.toml");
    let mut model = Model::load(&file).unwrap();
    let pose = balanced(&model, &[1.5, 1.9, 1.9]).unwrap();
    let inputs = linearise(&model, &pose).unwrap().inputs;
    assert!(inputs[1].abs() > 0.1, "{inputs:?}");
    put(&mut model, "torque_saturation", 2, &[inputs[1].abs()]);
    let omitted = linearise(&model, &pose).unwrap().omitted;
    assert_eq!(omitted[0].why, NonSmooth::AtLimit);
    model.effects.last_mut().unwrap().values[0] *= 0.9;
    let error = linearise(&model, &pose).unwrap_err();
    assert!(error.to_string().contains("joint 3 needs"), "{error}");
    model.effects.last_mut().unwrap().values[0] *= 2.0;
    assert_eq!(linearise(&model, &pose).unwrap().omitted, []);
}

/// What `handstand virtual --robot` simulates: position servos, viscous friction on the bar,
/// Coulomb in the gears.
#[test]
fn the_robot_behind_its_servos_has_a_linear_model() {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../models/robot.toml");
    let model = Model::load(&file).unwrap();
    let found = linearise(&model, &upright(&model)).unwrap();
    assert!(
        found.inputs.iter().all(|u| u.abs() < 1e-12),
        "{:?}",
        found.inputs
    );
    let joints: Vec<usize> = found.omitted.iter().filter_map(|o| o.joint).collect();
    assert_eq!(joints, [1, 2]);
    assert!(found.plant.a[(3, 3)] < 0.0, "friction of the bar counts");
}

#[test]
fn what_makes_a_design_impossible_is_refused() {
    let mut model = model("relative");
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
