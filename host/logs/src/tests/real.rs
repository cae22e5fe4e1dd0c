//! The public logs: they read in full, pass with justified warnings only, and faults put into them
//! show.
//!
//! The folder is named by `HANDSTAND_DATA`; without it these tests say so and pass.

use super::*;
use crate::model::{JointColumns, LogColumns};
use handstand_model::fixture::{column, columns, first};
use std::path::PathBuf;

/// The folder of real logs, if the environment names one.
fn data() -> Option<PathBuf> {
    let folder = std::env::var_os("HANDSTAND_DATA").map(PathBuf::from);
    if folder.is_none() {
        println!("HANDSTAND_DATA is unset: real logs not read");
    }
    folder
}

/// A joint's angle column in rad, its speed column in rad/s, its input column with its unit.
type JointNames<'a> = (&'a str, Option<&'a str>, Option<(&'a str, &'a str)>);

/// Columns of a log in seconds.
fn free(time: &str, joints: &[JointNames]) -> LogColumns {
    let joint =
        |(position, speed, input): &(&str, Option<&str>, Option<(&str, &str)>)| JointColumns {
            position: Some(column(position, "rad").into()),
            velocity: speed.map(|name| column(name, "rad/s").into()),
            input: input.map(|(name, unit)| column(name, unit).into()),
            ..JointColumns::default()
        };
    LogColumns {
        time: column(time, "s"),
        joints: joints.iter().map(joint).collect(),
        ..columns()
    }
}

#[test]
fn reads_the_real_logs() {
    let Some(data) = data() else { return };
    let count = |file: &str, columns: &LogColumns| -> (usize, usize) {
        let motions = read(&[LogRequest::whole(data.join(file))], columns).unwrap();
        (motions.len(), motions.iter().map(Motion::len).sum())
    };
    let drop = free("t_s", &[("pos_rad", None, None)]);
    assert_eq!(count("mx106_drop/drop.csv", &drop), (1, 313));
    let mut single = free("t", &[("theta1", Some("dtheta1"), None)]);
    single.segment = Some("segment".into());
    assert_eq!(count("multiarm/single_id.csv", &single), (4, 18336));
    let mut triple = free("t", &["1", "2", "3"].map(|_| ("theta1", None, None)));
    for (joint, name) in triple.joints.iter_mut().zip(["theta1", "theta2", "theta3"]) {
        joint.position = Some(column(name, "rad").into());
    }
    triple.segment = Some("segment".into());
    assert_eq!(count("multiarm/triple_id.csv", &triple), (22, 16940));
    let fft = free("time", &[("pos", Some("vel"), Some(("torque", "N m")))]);
    assert_eq!(
        count("dfki_pendulum/fft_excitation_measured.csv", &fft),
        (1, 10000)
    );
}

#[test]
fn real_logs_are_judged() {
    let Some(data) = data() else { return };
    for (files, model) in real(&data) {
        let requests: Vec<_> = files
            .iter()
            .map(|f| f.parse::<LogRequest>().unwrap())
            .collect();
        for finding in check(&requests, &model).unwrap() {
            println!(
                "{}",
                finding.to_string().replace(&data.display().to_string(), "")
            );
            assert_ne!(finding.severity, Severity::Refuse, "{finding}");
        }
        println!();
    }
}

#[test]
fn faults_in_real_logs_are_found() {
    let Some(data) = data() else { return };
    let warned = |files: &[String], model: &crate::model::Model, what: &str| {
        let requests: Vec<_> = files.iter().map(|f| f.parse().unwrap()).collect();
        let findings = check(&requests, model).unwrap();
        let hit = findings
            .iter()
            .any(|f| f.severity == Severity::Warn && f.what.contains(what));
        assert!(hit, "{what} is not among {findings:#?}");
    };
    for (files, model) in real(&data) {
        for joint in 0..model.joints.len() {
            let mut reversed = model.clone();
            let columns = &mut reversed.log.joints[joint];
            if let Some(input) = &mut columns.input {
                input.columns_mut()[0].reversed = true;
                // Where feedback makes the input follow the motion, the sign need not show.
                let open = files[0].contains("fft") || files[0].contains("design_C") && joint == 1;
                match model.joints[joint].drive {
                    crate::model::Drive::Position { .. } => {
                        warned(&files, &reversed, "runs against")
                    }
                    _ if open => warned(&files, &reversed, "the wrong way"),
                    _ => {}
                }
            }
            let mut reversed = model.clone();
            if let Some(speed) = &mut reversed.log.joints[joint].velocity {
                speed.columns_mut()[0].reversed = true;
                let name = speed.name();
                warned(&files, &reversed, "runs against the change");
                let mut minutes = model.clone();
                minutes.log.joints[joint].velocity = Some(column(&name, "rpm").into());
                warned(&files, &minutes, "times the change");
            }
        }
        // One drop is too short for this; the free swings are not.
        if files[0].contains("single_id") {
            let mut zero = model.clone();
            zero.angle_zero = crate::model::AngleZero::Hanging;
            warned(&files, &zero, "gravity pulls");
        }
    }
}

/// The public logs with models that read them.
fn real(data: &std::path::Path) -> Vec<(Vec<String>, crate::model::Model)> {
    use crate::model::{AngleZero, Angles, Drive};
    use handstand_model::fixture::{model, position_drive};
    let files = |names: &[&str]| -> Vec<String> {
        names
            .iter()
            .map(|name| data.join(name).display().to_string())
            .collect()
    };
    let mut drop = model(Drive::Passive, free("t_s", &[("pos_rad", None, None)]));
    drop.angle_zero = AngleZero::Horizontal;
    first(&mut drop.log.joints[0].position).resolution = Some(0.001534);
    let mut servo = model(
        position_drive(),
        free("t_s", &[("position_rad", None, Some(("goal_rad", "rad")))]),
    );
    servo.log.torque_on = Some("torque_on".into());
    servo.log.supply = Some(column("supply_v", "V"));
    let mut single = model(
        Drive::Passive,
        free("t", &[("theta1", Some("dtheta1"), None)]),
    );
    single.angle_zero = AngleZero::Upright;
    single.log.segment = Some("segment".into());
    let mut triple = model(
        Drive::Passive,
        free(
            "t",
            &[
                ("theta1", Some("dtheta1"), None),
                ("theta2", Some("dtheta2"), None),
                ("theta3", Some("dtheta3"), None),
            ],
        ),
    );
    triple.angle_zero = AngleZero::Upright;
    triple.angles = Angles::Absolute;
    triple.log.segment = Some("segment".into());
    let torque = |position, speed, torque| (position, Some(speed), Some((torque, "N m")));
    let pd = model(
        Drive::Torque,
        free("time", &[torque("position", "velocity", "torque")]),
    );
    let fft = model(
        Drive::Torque,
        free("time", &[torque("pos", "vel", "torque")]),
    );
    let double = model(
        Drive::Torque,
        free(
            "time",
            &[
                torque("pos_meas1", "vel_meas1", "tau_meas1"),
                torque("pos_meas2", "vel_meas2", "tau_meas2"),
            ],
        ),
    );
    vec![
        (files(&["mx106_drop/drop.csv"]), drop.clone()),
        (files(&["mx106_drop/drop.csv:26-139"]), drop),
        (
            files(&[
                "htd45h/sin_sin.csv",
                "htd45h/sin_time_square.csv",
                "htd45h/up_and_down.csv",
                "htd45h/lift_and_drop.csv",
            ]),
            servo,
        ),
        (files(&["multiarm/single_id.csv"]), single),
        (files(&["multiarm/triple_id.csv"]), triple),
        (files(&["dfki_pendulum/pd_sysid_measured.csv"]), pd),
        (files(&["dfki_pendulum/fft_excitation_measured.csv"]), fft),
        (
            files(&[
                "dfki_double/design_A.0_20220815_sys_id_trajectory_00.csv",
                "dfki_double/design_A.0_20220815_sys_id_trajectory_05.csv",
            ]),
            double.clone(),
        ),
        (
            files(&["dfki_double/design_C.0_20220914_172144_acrobot_lqr_video_trajectory.csv"]),
            double,
        ),
    ]
}
