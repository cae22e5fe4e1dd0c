//! Drafts from headers and ranges.

mod field;

use super::*;
use crate::model::Model;
use std::path::Path;

const SAMPLES: usize = 400;

/// A column over time, s.
type TestCurve = fn(f64) -> f64;

/// A log of these columns, each a function of time in s.
fn log(columns: &[(&str, TestCurve)]) -> RawLog {
    let time = |k: usize| 0.01 * k as f64;
    RawLog {
        names: columns.iter().map(|(name, _)| name.to_string()).collect(),
        columns: columns
            .iter()
            .map(|(_, value)| (0..SAMPLES).map(|k| value(time(k))).collect())
            .collect(),
        iso: vec![false; columns.len()],
        words: vec![None; columns.len()],
        ..RawLog::default()
    }
}

/// A pendulum's swing of half a radian.
fn swing(t: f64) -> f64 {
    0.5 * (7.0 * t).cos()
}

fn rate(t: f64) -> f64 {
    -3.5 * (7.0 * t).sin()
}

fn draft(columns: &[(&str, TestCurve)]) -> (Draft, Model) {
    let draft = Draft::of(&log(columns), "a.csv", None).unwrap();
    let text = draft.toml().unwrap();
    let model = Model::parse(&text, Path::new("a.toml")).unwrap();
    (draft, model)
}

#[test]
fn the_same_swing_is_understood_under_many_headers() {
    let headers: [[(&str, TestCurve); 3]; 8] = [
        [("t", |t| t), ("q", swing), ("dq", rate)],
        [("time_s", |t| t), ("q1_rad", swing), ("dq1_rad_s", rate)],
        [
            ("time_ms", |t| 1e3 * t),
            ("angle_deg", |t| swing(t).to_degrees()),
            ("speed_dps", |t| rate(t).to_degrees()),
        ],
        [
            ("Timestamp [us]", |t| 1e6 * t),
            ("Position (deg)", |t| swing(t).to_degrees()),
            ("Velocity [rpm]", |t| rate(t) * 9.549_296_585_513_72),
        ],
        // Units that no name tells.
        [
            ("timestamp", |t| 1e9 * t),
            ("theta", |t| swing(t).to_degrees()),
            ("omega", |t| rate(t).to_degrees()),
        ],
        [
            ("t", |t| 1e3 * t),
            ("theta", swing),
            ("theta_dot", |t| rate(t) * 9.549_296_585_513_72),
        ],
        [
            ("stamp", |t| t),
            ("arm.position", swing),
            ("arm.velocity", rate),
        ],
        // A speed that counts the other way round.
        [
            ("elapsed", |t| t),
            ("joint_angle", swing),
            ("joint_speed", |t| -rate(t)),
        ],
    ];
    for header in &headers {
        let (draft, model) = draft(header);
        let raw = log(header);
        assert_eq!(model.links.len(), 1, "{header:?}");
        assert_eq!(
            (draft.plan.angle_zero.as_str(), model.joints[0].drive.name()),
            ("hanging", "passive")
        );
        let own = &model.log.joints[0];
        let column =
            |mean: &Option<crate::model::ColumnMean>| mean.as_ref().unwrap().columns()[0].clone();
        let checks = [
            (model.log.time.clone(), (|t| t) as fn(f64) -> f64),
            (column(&own.position), swing),
            (column(&own.velocity), rate),
        ];
        for (column, truth) in checks {
            let index = raw
                .names
                .iter()
                .position(|name| *name == column.name)
                .unwrap();
            let off = (0..SAMPLES)
                .map(|k| (column.to_si(raw.columns[index][k]) - truth(0.01 * k as f64)).abs());
            let off = off.fold(0.0, f64::max);
            assert!(off < 1e-9, "{}: {off}", column.name);
        }
        // An even rod of 1.5 g / 7^2.
        assert!(
            (draft.plan.links[0].length_m - 0.300).abs() < 0.01,
            "{}",
            draft.plan.links[0].length_m
        );
    }
}

#[test]
fn drives_come_from_their_inputs() {
    let inputs: [(&str, TestCurve, &str); 6] = [
        ("tau", |t| t.sin(), "torque"),
        ("goal_rad", |t| t.sin(), "position"),
        ("goal_speed_rad_s", |t| t.cos(), "speed"),
        ("duty", |t| 0.5 * t.sin(), "duty"),
        ("effort", |t| t.sin(), "torque"),
        // A torque that never is one.
        ("torque", |_| 0.0, "passive"),
    ];
    for (name, value, drive) in inputs {
        let (_, model) = draft(&[("t", |t| t), ("q", swing), (name, value)]);
        assert_eq!(model.joints[0].drive.name(), drive, "{name}");
    }
    let both = log(&[
        ("t", |t| t),
        ("q", swing),
        ("tau", |t| t.sin()),
        ("q_des", |t| t.cos()),
    ]);
    let chosen = |drive| {
        Draft::of(&both, "a.csv", drive).unwrap().plan.links[0]
            .drive
            .clone()
    };
    assert_eq!(
        (chosen(None), chosen(Some("position"))),
        ("torque".into(), "position".into())
    );
    assert_eq!(chosen(Some("passive")), "passive");
}

/// Data sets of arms call goals actions, and write both in degrees.
#[test]
fn what_an_angle_stays_by_is_its_goal() {
    let degrees: [(&str, TestCurve); 3] = [
        ("t", |t| t),
        ("elbow.pos", |t| swing(t).to_degrees()),
        ("elbow.action", |t| swing(t + 0.04).to_degrees()),
    ];
    let (draft, model) = draft(&degrees);
    assert_eq!(model.joints[0].drive.name(), "position");
    let goal = model.log.joints[0].input.as_ref().unwrap();
    assert_eq!(goal.columns()[0].unit.name, "deg");
    assert!(draft.toml().unwrap().contains("elbow.action"));

    let torques = log(&[degrees[0], degrees[1], ("elbow.action", |t| 3.0 * t.sin())]);
    let drive = |log: &RawLog, known| {
        Draft::of(log, "a.csv", known).unwrap().plan.links[0]
            .drive
            .clone()
    };
    assert_eq!(drive(&torques, None), "torque");
    // One of three joints hardly moves by its goal.
    let names = [
        "a.pos", "a.action", "b.pos", "b.action", "c.pos", "c.action",
    ];
    let curves = [degrees[1].1, degrees[2].1].repeat(3);
    let mut arm = log(&[degrees[0]]);
    for (name, curve) in names.into_iter().zip(curves) {
        arm.names.push(name.to_string());
        arm.columns
            .push((0..SAMPLES).map(|k| curve(0.01 * k as f64)).collect());
        arm.iso.push(false);
        arm.words.push(None);
    }
    arm.columns[6].iter_mut().for_each(|goal| *goal = -*goal);
    let links = Draft::of(&arm, "a.csv", None).unwrap().plan.links;
    assert!(
        links.iter().all(|link| link.drive == "position"),
        "{links:?}"
    );
    assert_eq!(drive(&log(&degrees), Some("torque")), "torque");
}

#[test]
fn several_joints_and_conventions() {
    let (draft, model) = draft(&[
        ("segment", |_| 0.0),
        ("t", |t| t),
        ("theta1", |t| 3.1 + swing(t)),
        ("theta2", |t| 3.1 - swing(t)),
        ("dtheta1", rate),
        ("dtheta2", |t| -rate(t)),
        ("supply_mv", |_| 11800.0),
    ]);
    assert_eq!(
        (draft.plan.angle_zero.as_str(), draft.plan.angles.as_str()),
        ("upright", "absolute")
    );
    assert_eq!(model.log.segment.as_deref(), Some("segment"));
    assert_eq!(model.links.len(), 2);
    assert!((model.log.supply.as_ref().unwrap().to_si(11800.0) - 11.8).abs() < 1e-12);
}

#[test]
fn every_guess_is_said_and_hostile_names_stay_comments() {
    let (draft, _) = draft(&[("t", |t| t), ("q \"\n[rig]\u{7}#", swing), ("x\ny", |t| t)]);
    let whats: Vec<&str> = draft
        .guesses
        .iter()
        .map(|guess| guess.what.as_str())
        .collect();
    assert_eq!(whats[0], "time");
    assert!(
        whats.contains(&"not used") && whats.contains(&"angle zero") && whats.contains(&"link")
    );
}

#[test]
fn answers_replace_guesses_and_wrong_ones_are_refused() {
    let (mut draft, _) = draft(&[("t", |t| t), ("q1", swing), ("q2", swing)]);
    draft.set("angle zero", "upright").unwrap();
    draft.set_links("length", &[0.3, 0.2]).unwrap();
    draft.set_links("mass", &[0.5]).unwrap();
    let lengths: Vec<f64> = draft.plan.links.iter().map(|link| link.length_m).collect();
    assert_eq!(
        (lengths, draft.plan.links[1].mass_kg),
        (vec![0.3, 0.2], 0.5)
    );
    assert!((draft.plan.links[0].com_m - 0.15).abs() < 1e-12);
    assert!(draft.set("angle zero", "sideways").is_err());
    assert!(draft.set_links("length", &[0.3, 0.2, 0.1]).is_err());
    assert!(draft.set_links("mass", &[-1.0]).is_err());
}

#[test]
fn what_is_no_log_of_joints_is_refused() {
    for columns in [
        &[("a", swing as fn(f64) -> f64), ("b", rate)][..],
        &[("t", |t| t), ("x", swing)],
    ] {
        assert!(Draft::of(&log(columns), "a.csv", None).is_err());
    }
    assert!(Draft::of(&RawLog::default(), "a.csv", None).is_err());
    let (none, _) = (
        RawLog {
            names: vec!["t".into(), "q".into()],
            columns: vec![vec![]; 2],
            iso: vec![false; 2],
            words: vec![None; 2],
            ..RawLog::default()
        },
        (),
    );
    assert!(Draft::of(&none, "a.csv", None).is_err());
}
