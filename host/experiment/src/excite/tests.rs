//! What is written keeps its limits and says what it must.

use super::*;

fn plan() -> ExcitePlan {
    let joint = |servos: &[u8], low_rad, high_rad| JointLimits {
        servos: servos.to_vec(),
        low_rad,
        high_rad,
        speed_rad_s: 2.0,
    };
    ExcitePlan {
        joints: vec![joint(&[1, 2], -0.6, 0.4), joint(&[11, 12], -0.2, 0.8)],
        kinds: EXCITATION_KINDS.to_vec(),
        each_s: 12.0,
        hz: 100.0,
        band_hz: (0.2, 3.0),
        seed: 1,
    }
}

#[test]
fn every_motion_keeps_angles_and_speeds_and_uses_the_range() {
    for seed in 1..20 {
        let excitation = excite(&ExcitePlan { seed, ..plan() }).unwrap();
        for (extent, joint) in excitation.extents().iter().zip(plan().joints) {
            let slack = 1e-9;
            assert!(extent.lowest_rad >= joint.low_rad - slack, "{extent:?}");
            assert!(extent.highest_rad <= joint.high_rad + slack, "{extent:?}");
            assert!(extent.fastest_rad_s <= 2.0 + 1e-6, "{seed}: {extent:?}");
            assert!(extent.fastest_rad_s > 1.5, "{extent:?}");
            let range = extent.highest_rad - extent.lowest_rad;
            assert!(range > 0.95, "{extent:?}");
        }
        let kinds: Vec<ExcitationKind> = excitation.motions.iter().map(|m| m.kind).collect();
        assert_eq!(kinds, EXCITATION_KINDS);
    }
}

#[test]
fn one_joint_s_multisine_says_nothing_of_the_other_s() {
    let kinds = vec![ExcitationKind::Multisine];
    let excitation = excite(&ExcitePlan {
        kinds,
        each_s: 20.0,
        ..plan()
    })
    .unwrap();
    let column = |at: usize| -> Vec<f64> {
        let values: Vec<f64> = excitation.angle_rad.iter().map(|row| row[at]).collect();
        let mean = values.iter().sum::<f64>() / values.len() as f64;
        values.iter().map(|value| value - mean).collect()
    };
    let product = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let (a, b) = (column(0), column(1));
    let correlation = product(&a, &b) / (product(&a, &a) * product(&b, &b)).sqrt();
    assert!(correlation.abs() < 0.2, "{correlation}");
}

#[test]
fn torque_goes_off_once_and_for_all_at_the_raised_pose() {
    let excitation = excite(&plan()).unwrap();
    let off = excitation.torque_on.iter().position(|on| !on).unwrap();
    assert!(excitation.torque_on[off..].iter().all(|on| !on));
    assert!(excitation.seconds() - excitation.time_s[off] > 2.0);
    assert_eq!(excitation.angle_rad[off], [0.4, 0.8]);
    let csv = excitation.to_csv();
    let header = csv.lines().next().unwrap();
    assert_eq!(
        header,
        "time_s,goal1_rad,goal2_rad,goal11_rad,goal12_rad,torque_on"
    );
    assert!(
        csv.lines()
            .last()
            .unwrap()
            .ends_with(",0.40000,-0.40000,0.80000,-0.80000,0")
    );
}

#[test]
fn equal_plans_are_equal_and_seeds_differ() {
    let csv = |seed| excite(&ExcitePlan { seed, ..plan() }).unwrap().to_csv();
    assert_eq!(csv(3), csv(3));
    assert_ne!(csv(3), csv(4));
}

#[test]
fn limits_that_cannot_be_held_are_refused() {
    type Change = fn(&mut ExcitePlan);
    let wrong: [(Change, &str); 10] = [
        (|plan| plan.joints.clear(), "no servo"),
        (|plan| plan.joints[0].servos.clear(), "no servo"),
        (
            |plan| plan.joints[0].servos[1] = 11,
            "servo 11 is named twice",
        ),
        (|plan| plan.joints[0].high_rad = -0.7, "of servo 1"),
        (|plan| plan.joints[1].high_rad = 2.7, "of servo 11"),
        (|plan| plan.joints[1].speed_rad_s = 9.0, "9 rad/s"),
        (|plan| plan.joints[1].speed_rad_s = 0.01, "within 12 s"),
        (|plan| plan.band_hz.1 = 30.0, "0.2 to 30 Hz"),
        (|plan| plan.each_s = f64::NAN, "within NaN s"),
        (|plan| plan.kinds.push(ExcitationKind::Drop), "twice"),
    ];
    for (change, said) in wrong {
        let mut plan = plan();
        change(&mut plan);
        let error = excite(&plan).unwrap_err();
        assert!(error.to_string().contains(said), "{said}: {error}");
        assert_eq!(error.exit_code(), 2);
    }
}
