use super::*;
use crate::model::Model;

/// Two links of 0.2 m and a finger of 0.1 m that all turn about y, 0.3 m over the base.
const URDF: &str = r#"<robot name="arm">
  <link name="base"/>
  <link name="upper"><inertial><origin xyz="0.1 0 0"/><mass value="0.2"/>
    <inertia ixx="1e-5" ixy="0" ixz="0" iyy="7e-4" iyz="0" izz="7e-4"/></inertial></link>
  <link name="lower"><inertial><origin xyz="0.1 0 0"/><mass value="0.2"/>
    <inertia ixx="1e-5" ixy="0" ixz="0" iyy="7e-4" iyz="0" izz="7e-4"/></inertial></link>
  <link name="finger"><inertial><origin xyz="0.05 0 0"/><mass value="0.1"/>
    <inertia ixx="5e-6" ixy="0" ixz="0" iyy="9e-5" iyz="0" izz="9e-5"/></inertial></link>
  <joint name="shoulder" type="revolute"><parent link="base"/><child link="upper"/>
    <origin xyz="0 0 0.3"/><axis xyz="0 1 0"/>
    <limit lower="-1.5" upper="1.5" effort="1" velocity="5"/></joint>
  <joint name="elbow" type="revolute"><parent link="upper"/><child link="lower"/>
    <origin xyz="0.2 0 0"/><axis xyz="0 1 0"/>
    <limit lower="-3" upper="3" effort="1" velocity="5"/></joint>
  <joint name="wrist" type="revolute"><parent link="lower"/><child link="finger"/>
    <origin xyz="0.2 0 0"/><axis xyz="0 1 0"/>
    <limit lower="-3" upper="3" effort="1" velocity="5"/></joint>
</robot>"#;

fn arm() -> Model {
    let joint = |name: &str| {
        format!(
            "[[joint]]\nname = \"{name}\"\ndrive = \"position\"\ngain_per_rad = 5.0\n\
             stall_torque_nm = 2.0\nno_load_speed_rad_s = 60.0\n\
             [[log.joint]]\nposition = {{ column = \"{name}\", unit = \"rad\" }}\n\
             input = {{ column = \"{name}_goal\", unit = \"rad\" }}\n"
        )
    };
    let joints = ["shoulder", "elbow", "wrist"].map(joint).concat();
    let text = format!(
        "[rig]\nname = \"arm\"\nrobot = \"arm.urdf\"\n{joints}\
         [log]\ntime = {{ column = \"t\", unit = \"s\" }}\n"
    );
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("arm.urdf"), URDF).unwrap();
    Model::parse(&text, &folder.path().join("arm.toml")).unwrap()
}

/// A motion through these poses, one sample each.
fn through(poses: &[[f64; 3]]) -> Motion {
    let of_joint = |joint: usize| poses.iter().map(|pose| pose[joint]).collect();
    Motion {
        time_s: (0..poses.len())
            .map(|sample| 0.02 * sample as f64)
            .collect(),
        position_rad: (0..3).map(of_joint).collect(),
        velocity_rad_s: vec![None; 3],
        rate_rad_s: vec![None; 3],
        input: vec![Some(vec![0.0; poses.len()]); 3],
        ..Motion::default()
    }
}

fn keeps(logged: &[[f64; 3]], asked: [f64; 3]) -> bool {
    let model = arm();
    let clearance = Clearance::of_logs(&model, &[through(logged)]).unwrap();
    clearance.broken_by(&model, &through(&[asked])).is_none()
}

const LEVEL: [f64; 3] = [0.0; 3];

#[test]
fn a_robot_stays_above_the_plane_that_it_stands_on_or_where_its_logs_were() {
    // The tip of the finger is 0.5 m away, 0.3 m up: it meets the plane at 0.64 rad.
    assert!(keeps(&[LEVEL], [0.55, 0.0, 0.0]));
    assert!(!keeps(&[LEVEL], [0.65, 0.0, 0.0]));
    let model = arm();
    let over = |floor_m| {
        let clearance = Clearance::of_logs(&model, &[]).unwrap().over(floor_m);
        clearance.broken_by(&model, &through(&[[0.65, 0.0, 0.0]]))
    };
    assert_eq!([over(Some(-0.05)), over(None)], [None, None]);
    let dips = |floor_m| over(Some(floor_m)).unwrap();
    assert!(dips(0.1).starts_with("dips lower into the plane"));
    assert!(dips(0.0).starts_with("dips finger into the plane"));
    // On an edge of a table its logs were lower already.
    assert!(keeps(&[LEVEL, [0.8, 0.0, 0.0]], [0.65, 0.0, 0.0]));
}

#[test]
fn what_turns_about_the_vertical_comes_no_lower() {
    let axis = nalgebra::Unit::new_normalize;
    let tree = arm().tree().unwrap();
    let up = Some(Vector3::z());
    let mut link = tree.links[0].clone();
    assert!(!stays_level(&link, up));
    link.axis = axis(Vector3::new(0.01, 0.0, -1.0));
    assert!(stays_level(&link, up) && !stays_level(&link, None));
    let mut carried = link.clone();
    carried.parent = Some(0);
    assert!(!stays_level(&carried, up));
}

#[test]
fn a_finger_stays_clear_of_the_upper_arm_or_as_near_as_in_the_logs() {
    // Folded back, the finger's line would cross the upper arm's.
    let folded = [-0.5, -2.6, -2.3];
    assert!(keeps(&[LEVEL], [-0.5, -1.5, -1.0]));
    assert!(!keeps(&[LEVEL], folded));
    assert!(keeps(&[LEVEL, folded], folded));
}

#[test]
fn no_joint_turns_beyond_its_end_stops_but_where_its_logs_do() {
    assert!(!keeps(&[LEVEL], [-1.6, 0.0, 0.0]));
    assert!(keeps(&[LEVEL], [-1.45, 0.0, 0.0]));
    assert!(keeps(&[LEVEL, [-1.7, 0.0, 0.0]], [-1.6, 0.0, 0.0]));
}

#[test]
fn what_is_not_known_says_nothing() {
    assert!(keeps(&[LEVEL], [f64::NAN, 0.0, 0.0]));
}

#[test]
fn lines_are_as_far_apart_as_geometry_says() {
    let line = |a: [f64; 3], b: [f64; 3]| [Point3::from(a), Point3::from(b)];
    let x = line([0.0; 3], [1.0, 0.0, 0.0]);
    for (other, expected_m) in [
        (line([0.5, 1.0, -1.0], [0.5, 1.0, 1.0]), 1.0),
        (line([2.0, 0.0, 0.0], [3.0, 0.0, 0.0]), 1.0),
        (line([0.25, 0.0, 2.0], [0.75, 0.0, 2.0]), 2.0),
        (line([4.0, 4.0, 0.0], [4.0, 4.0, 0.0]), 5.0),
        (line([0.5, -1.0, 0.0], [0.5, 1.0, 0.0]), 0.0),
        // Beyond both ends.
        (line([1.0, 3.0, 4.0], [2.0, 6.0, 8.0]), 5.0),
    ] {
        let found_m = distance_m(&x, &other);
        assert!((found_m - expected_m).abs() < 1e-12, "{other:?}: {found_m}");
        assert!((distance_m(&other, &x) - expected_m).abs() < 1e-12);
    }
}

/// Motors that hardly brake swing past goals that change as fast as they may: by no more than twice
/// as fast, that is no reason to ask for less.
#[test]
fn servos_may_catch_up_with_their_goals() {
    use crate::excite::ExcitationKind;
    use crate::first_motions::first_motions;
    use crate::limits::ExperimentLimits;
    let model = arm();
    let mut limits = ExperimentLimits::of_model(&model, (0.5, 2.0), 100.0);
    limits.clearance = None;
    let kinds = &[ExcitationKind::Multisine, ExcitationKind::Steps];
    let found = first_motions(&model, &limits, (kinds, 14.0), (0.2, 3.0), 1).unwrap();
    let broken = limits.broken_by(&model, &found.motion).unwrap();
    assert!(broken.contains("rad/s, faster than 2.00"), "{broken}");
    assert!(limits.catching_up(&model).keeps(&model, &found.motion));
}
