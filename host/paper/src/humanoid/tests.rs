use super::*;
use crate::study::handstand;
use handstand_model::dynamics::{EquationsOfMotion, TreeAtPose};
use nalgebra::{DMatrix, DVector};

#[test]
fn the_file_of_the_robot_is_what_the_places_make() {
    let made = humanoid_urdf(&handstand().unwrap());
    let kept = include_str!("../humanoid.urdf");
    assert!(
        made == kept,
        "cargo run -p handstand-paper --example humanoid > host/models/humanoid.urdf"
    );
}

#[test]
fn eighteen_servos_are_table_1_and_the_rest_fits_into_the_blocks() {
    let blocks = lumped_blocks(&handstand().unwrap()).unwrap();
    assert_eq!(blocks.iter().map(|block| block.servos).sum::<usize>(), 18);
    for block in &blocks {
        for BlockValue { name, values, .. } in block.values() {
            let [stated, lumped, _] = values;
            assert!(
                (stated - lumped).abs() < 0.05,
                "{} {name}: {values:?}",
                block.name
            );
        }
        let ([low, high], [from, to]) = (block.rest_at_m, block.reach_m);
        assert!(from < low && low < high && high < to, "{block:?}");
        // What is unknown of the rest explains what an even spread misses.
        assert!((block.evenly.com_m - block.stated.com_m).abs() < 0.015);
        assert!((block.evenly.inertia_kg_m2 / block.stated.inertia_kg_m2 - 1.0).abs() < 0.1);
    }
}

/// Elbows, knees and ankles held, both shoulders and both hips moved alike, its masses and its
/// weight are the chain's at any posture.
#[test]
fn moved_as_three_links_it_is_the_chain() {
    let table = handstand().unwrap();
    let robot = Robot::parse(&humanoid_urdf(&table), Path::new("humanoid.urdf"), &[]).unwrap();
    assert_eq!(robot.tree.len(), 19);
    let chain = table.chain();
    let equations = EquationsOfMotion::new(&chain, 0.0);
    let mut alike = DMatrix::zeros(19, 3);
    for (name, joint, sign) in [
        ("bar", 0, 1.0),
        ("right_shoulder_pitch", 1, 1.0),
        ("left_shoulder_pitch", 1, -1.0),
        ("right_hip_pitch", 2, 1.0),
        ("left_hip_pitch", 2, 1.0),
    ] {
        let row = robot.joints.iter().position(|own| own == name).unwrap();
        alike[(row, joint)] = sign;
    }
    for turned in [[0.0; 3], [0.3, -0.7, 1.1], [-2.0, 0.9, -1.6]] {
        let turned_rad = DVector::from_row_slice(&turned);
        let pose = TreeAtPose::new(&robot.tree, (&alike * &turned_rad).as_slice());
        // The chain's first angle is from hanging.
        let of_chain = [turned[0] + std::f64::consts::PI, turned[1], turned[2]];
        let mass = alike.transpose() * pose.mass() * &alike;
        let weight = alike.transpose() * pose.gravity();
        assert!((mass - equations.mass(&of_chain)).norm() < 1e-8);
        assert!((weight - equations.gravity(&of_chain)).norm() < 1e-6);
    }
}
