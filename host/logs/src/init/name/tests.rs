//! Names of many benches.

use super::*;

fn guess(name: &str) -> (Option<Role>, Option<&'static str>, String) {
    let guess = name_guess(name);
    (guess.role, guess.unit.map(|(unit, _)| unit), guess.joint)
}

#[test]
fn names_of_many_benches_are_understood() {
    use Role::*;
    let cases = [
        ("t", Time, None, ""),
        ("t_s", Time, Some("s"), ""),
        ("time_ms", Time, Some("ms"), ""),
        ("Timestamp [us]", Time, Some("us"), ""),
        ("log.time", Time, None, "log"),
        ("rig.t_ms", Time, Some("ms"), "rig"),
        ("segment", Segment, None, ""),
        ("theta1", Position, None, "1"),
        ("dtheta1", Velocity, None, "1"),
        ("q2_rad", Position, Some("rad"), "2"),
        ("dq2_rad_s", Velocity, Some("rad/s"), "2"),
        ("pos_meas1", Position, None, "1"),
        ("vel_filt2", Velocity, None, "2"),
        ("tau_meas1", Torque, None, "1"),
        ("pos_count4096", Position, Some("ticks"), ""),
        ("shoulder.position", Position, None, "shoulder"),
        ("joint_goals/servo3.position", GoalPosition, None, "3"),
        ("elbow.effort", Effort, None, "elbow"),
        ("goal_rad", GoalPosition, Some("rad"), ""),
        // What a drive is given; fractions of a degree; a moment in N mm.
        ("input_pos", GoalPosition, None, ""),
        ("input_vel", GoalVelocity, None, ""),
        ("pos_estimate", Position, None, ""),
        ("angle_cdeg", Position, Some("ticks"), ""),
        ("angle_mdeg", Position, Some("ticks"), ""),
        ("q_mrad", Position, Some("ticks"), ""),
        ("torque_Nmm", Torque, Some("mN m"), ""),
        ("field.position0", Position, Some("rad"), "field_0"),
        ("goalSpeed[rpm]", GoalVelocity, Some("rpm"), ""),
        ("PresentPosition (deg)", Position, Some("deg"), ""),
        ("theta_dot", Velocity, None, ""),
        ("supply_v", Supply, Some("V"), ""),
        ("input_volts", Supply, Some("V"), ""),
        ("torque_on", TorqueOn, None, ""),
        ("torque_enable", TorqueOn, None, ""),
        ("duty1", Duty, None, "1"),
        ("Joint 1 Angle (deg)", Position, Some("deg"), "1"),
        ("gyro_rad_s", Velocity, Some("rad/s"), ""),
        // A number in brackets is a joint's, unless it is the unit of a share.
        ("pos (2)", Position, None, "2"),
        ("target pos (1)", GoalPosition, None, "1"),
        ("q[0]", Position, None, "0"),
        ("duty [1]", Duty, Some("1"), ""),
        ("duty (2)", Duty, None, "2"),
        // By definition.
        ("/joint_states/a/position", Position, Some("rad"), "a"),
        ("/joint_states/a/velocity", Velocity, Some("rad/s"), "a"),
    ];
    for (name, role, unit, joint) in cases {
        assert_eq!(guess(name), (Some(role), unit, joint.to_string()), "{name}");
    }
    for name in [
        "",
        "tau_fric1",
        "temperature1_celsius",
        "ddq1",
        "error2",
        "load1",
        "gyro_code",
    ] {
        assert_eq!(guess(name).0, None, "{name}");
    }
    assert_eq!(
        name_guess("pos_count4096").unit,
        Some(("ticks", Some(4096.0)))
    );
    assert!(name_guess("pos_meas1").rank < name_guess("pos_filt1").rank);
}
