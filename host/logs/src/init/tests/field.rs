//! Logs as they are met in the field: zeros anywhere, data sets with definitions, registers.

use super::*;
use crate::{BenchFigures, LogRequest};

fn said(draft: &Draft, what: &str) -> Vec<String> {
    let guesses = draft.guesses.iter().filter(|guess| guess.what == what);
    guesses
        .map(|g| format!("{} ({})", g.guess, g.why))
        .collect()
}

fn input_of(draft: &Draft) -> Option<&str> {
    let input = draft.columns.joints[0].input.as_ref();
    input.map(|column| column.name.as_str())
}

#[test]
fn a_free_joint_hangs_where_it_rests() {
    let (draft, model) = draft(&[("t", |t| t), ("q", |t| 0.88 + swing(t))]);
    assert_eq!(draft.plan.angle_zero, "hanging");
    let position = model.log.joints[0].position.as_ref().unwrap();
    let at_rest = position.columns()[0].to_si(0.88);
    assert!(at_rest.abs() < 0.03, "{at_rest}");
    // What turns round rests nowhere; what is driven neither.
    for (q, input) in [
        ((|t| 100.0 + 3.0 * t) as TestCurve, None),
        (|t| 0.88 + swing(t), Some(("goal", swing as TestCurve))),
    ] {
        let mut columns: Vec<(&str, TestCurve)> = vec![("t", |t| t), ("q_rad", q)];
        columns.extend(input);
        let draft = Draft::of(&log(&columns), "a.csv", None).unwrap();
        let position = draft.columns.joints[0].position.as_ref().unwrap();
        assert_eq!(
            (draft.plan.angle_zero.as_str(), position.offset_rad),
            ("hanging", 0.0)
        );
    }
}

#[test]
fn joint_states_are_in_rad_however_far_they_turn() {
    let turning: [(&str, TestCurve); 3] = [
        ("t", |t| t),
        ("/joint_states/a/position", |t| 104.4 + 3.0 * t),
        ("/joint_states/a/velocity", |_| 3.0),
    ];
    let (draft, model) = draft(&turning);
    let unit = |model: &Model| model.log.joints[0].position.as_ref().unwrap().columns()[0].unit;
    assert_eq!(unit(&model).name, "rad");
    assert!(said(&draft, "angle of joint a")[0].contains("by definition"));
    // Of a bag the format says so, whatever its joints are called.
    let mut bag = log(&[("time_s", |t| t), ("a.position", |t| 104.4 + 3.0 * t)]);
    let unit_of = |log: &RawLog| {
        let draft = Draft::of(log, "a.db3", None).unwrap();
        draft.columns.joints[0].position.as_ref().unwrap().unit
    };
    assert_eq!(unit_of(&bag), "deg");
    bag.is_si = true;
    assert_eq!(unit_of(&bag), "rad");
}

#[test]
fn a_data_set_of_lerobot_is_understood() {
    let (draft, model) = draft(&[
        ("action_1", |t| 60.0 * t.sin()),
        ("action_2", |t| 40.0 * t.cos()),
        ("observation.state_1", |t| 60.0 * (t - 0.04).sin()),
        ("observation.state_2", |t| 40.0 * (t - 0.04).cos()),
        ("timestamp", |t| t % 2.0),
        ("frame_index", |t| (100.0 * (t % 2.0)).round()),
        ("episode_index", |t| (t / 2.0).floor()),
    ]);
    let joints = &draft.columns.joints;
    let names = |joint: &JointGuess| {
        let (position, input) = (joint.position.as_ref(), joint.input.as_ref());
        [position, input].map(|column| column.unwrap().name.clone())
    };
    assert_eq!(names(&joints[0]), ["observation.state_1", "action_1"]);
    assert_eq!(names(&joints[1]), ["observation.state_2", "action_2"]);
    assert_eq!(model.log.segment.as_deref(), Some("episode_index"));
    assert_eq!(model.log.time.name, "timestamp");
    assert!(said(&draft, "angle of joint 1")[0].contains("per cent"));
}

#[test]
fn a_column_that_steps_where_time_begins_anew_marks_the_recordings() {
    let restarting = |counts: TestCurve| {
        let columns: [(&str, TestCurve); 4] = [
            ("time_s", |t| t % 1.0),
            ("rollout", counts),
            ("kp", |_| 8.0),
            ("q", swing),
        ];
        Draft::of(&log(&columns), "a.csv", None).unwrap()
    };
    let counted = restarting(|t| (t + 1e-9).floor());
    assert_eq!(counted.columns.segment.as_deref(), Some("rollout"));
    let elsewhere = restarting(|t| (t + 0.5).floor());
    assert_eq!(elsewhere.columns.segment, None);
    assert!(said(&elsewhere, "segment")[0].contains("time begins anew 3 times"));
}

#[test]
fn other_joints_are_taken_by_their_number_or_said() {
    let (both, _) = draft(&[("t", |t| t), ("pos (1)", swing), ("pos (2)", |t| -swing(t))]);
    assert_eq!(both.columns.joints.len(), 2);
    let (one, _) = draft(&[
        ("t", |t| t),
        ("pendAngleZeroUp", swing),
        ("baseAngle", swing),
    ]);
    assert_eq!(one.columns.joints.len(), 1);
    assert!(said(&one, "another angle")[0].contains("pendAngleZeroUp"));
}

#[test]
fn an_input_that_is_sent_once_holds() {
    let once: TestCurve = |t| {
        if (t - 0.2).abs() < 0.004 {
            4.0
        } else {
            f64::NAN
        }
    };
    let (draft, _) = draft(&[("t", |t| t), ("q", swing), ("effort", once)]);
    assert_eq!(input_of(&draft), Some("effort"));
}

#[test]
fn registers_of_sign_and_magnitude_are_no_speeds() {
    let coded: TestCurve = |t| {
        let steps = (rate(t) * 4096.0 / std::f64::consts::TAU).round();
        if steps < 0.0 { 32768.0 - steps } else { steps }
    };
    let (draft, model) = draft(&[("t", |t| t), ("q", swing), ("speed", coded)]);
    assert!(model.log.joints[0].velocity.is_none());
    let speed = &said(&draft, "speed")[0];
    assert!(
        speed.contains("not taken: sign in bit 15") && speed.contains("Feetech"),
        "{speed}"
    );
}

#[test]
fn a_duty_beyond_a_hundred_is_counts_of_a_full_scale() {
    let (draft, model) = draft(&[
        ("t", |t| t),
        ("q", swing),
        ("pwm", |t| (221.0 * t.sin()).round()),
    ]);
    let duty = model.log.joints[0].input.as_ref().unwrap().columns()[0].clone();
    assert_eq!((duty.unit.name, duty.to_si(255.0)), ("counts", 1.0));
    assert!(said(&draft, "input")[0].contains("no per cent"));
}

#[test]
fn what_is_a_guess_about_the_header_is_said() {
    let (rising, _) = draft(&[("keys", |t| 1500.0 + 10.0 * t), ("q", swing)]);
    assert!(said(&rising, "time")[0].contains("a guess: none is named time"));
    let (twice, _) = draft(&[("t", |t| t), ("q", swing), ("q", |t| -swing(t))]);
    assert!(said(&twice, "twice")[0].contains("2 columns are called \"q\": the first"));
    // A column of the right name that holds words.
    let mut words = log(&[("t", |t| t), ("q_rad", |_| f64::NAN)]);
    words.words[1] = Some("0.5 rad".into());
    let error = Draft::of(&words, "a.csv", None).unwrap_err().to_string();
    assert!(
        error.contains("'q_rad' holds no number, but words such as '0.5 rad'"),
        "{error}"
    );
    let mut decimals = log(&[("t", |t| t)]);
    decimals.left_out.push(("q_rad".into(), "decimals".into()));
    let error = Draft::of(&decimals, "a.csv", None).unwrap_err().to_string();
    assert!(error.contains("'q_rad' holds decimals"), "{error}");
    let mut clock = log(&[("Time", |_| f64::NAN), ("q", swing)]);
    clock.words[0] = Some("noon".into());
    let error = Draft::of(&clock, "a.csv", None).unwrap_err().to_string();
    assert!(
        error.contains("'Time' holds no number, but words such as 'noon'"),
        "{error}"
    );
}

#[test]
fn a_bench_s_own_figures_make_its_model() {
    let text = |mass_kg: f64, arm: &str| {
        let entry = |k: u32| {
            format!(
                "{{\"timestamp\": {}, \"position\": {}, \"goal_position\": 0.5}}",
                0.01 * f64::from(k),
                swing(0.01 * f64::from(k))
            )
        };
        let entries: Vec<String> = (0..50).map(entry).collect();
        format!(
            "{{\"mass\": {mass_kg}, {arm}\"length\": 0.14, \"kp\": 8, \"entries\": [{}]}}",
            entries.join(",")
        )
    };
    let folder = tempfile::tempdir().unwrap();
    let written = |name: &str, text: String| {
        let path = folder.path().join(name);
        std::fs::write(&path, text).unwrap();
        LogRequest::whole(path)
    };
    let rod = "\"arm_mass\": 0.016, ";
    let loads = [0.07, 0.2].map(|kg| written(&format!("m{kg}.json"), text(kg, rod)));
    let model_of = |request: &LogRequest| {
        let log = RawLog::read_request(request).unwrap();
        let toml = Draft::of(&log, "a.json", None).unwrap().toml().unwrap();
        Model::parse(&toml, Path::new("a.toml")).unwrap()
    };
    // The model of one load reads the logs of all, each with its own weight.
    let model = model_of(&loads[0]);
    let motions = crate::read(&loads, &model.log).unwrap();
    let carried: Vec<f64> = motions.iter().map(|motion| motion.payload_kg).collect();
    assert_eq!(carried, [0.07, 0.2]);
    assert_eq!(
        (model.links[0].mass_kg, model.log.payload_at_m),
        (0.016, 0.14)
    );
    // Without a word of the rod the weight is the link.
    let bare = written("bare.json", text(0.07, ""));
    let model = model_of(&bare);
    assert_eq!((model.links[0].mass_kg, model.links[0].com_m), (0.07, 0.14));
    assert!(crate::read(&[bare], &model.log).is_ok());
    let figures = RawLog::read_request(&loads[1]).unwrap().bench;
    let expected = BenchFigures {
        mass_kg: 0.2,
        arm_mass_kg: 0.016,
        length_m: 0.14,
    };
    assert_eq!(figures, Some(expected));
}

#[test]
fn angles_of_one_log_are_in_one_unit() {
    let wide: TestCurve = |t| 60.0 * swing(t);
    let (draft, _) = draft(&[("t", |t| t), ("pan.pos", wide), ("lift.pos", swing)]);
    let units = draft.columns.joints.iter();
    let units: Vec<&str> = units.map(|j| j.position.as_ref().unwrap().unit).collect();
    assert_eq!(units, ["deg", "deg"]);
    let said = said(&draft, "angle of joint lift");
    assert!(said[0].contains("the unit of the other angles"), "{said:?}");
}

#[test]
fn fractions_of_units_are_read_by_their_names() {
    let centidegrees: TestCurve = |t| 100.0 * swing(t).to_degrees();
    let (_, model) = draft(&[("t", |t| t), ("angle_cdeg", centidegrees)]);
    let position = model.log.joints[0].position.as_ref().unwrap();
    assert!((position.columns()[0].to_si(18000.0) - std::f64::consts::PI).abs() < 1e-9);
}

#[test]
fn an_angle_whose_register_has_a_sign_bit_is_refused_with_what_to_write() {
    let coded: TestCurve = |t| {
        let value = (500.0 * swing(t)).trunc();
        if value < 0.0 { 32768.0 - value } else { value }
    };
    let error = Draft::of(&log(&[("t", |t| t), ("pos", coded)]), "a.csv", None).unwrap_err();
    assert!(
        error.to_string().contains("column 'pos': sign in bit 15"),
        "{error}"
    );
    assert!(
        error.remedy().unwrap().contains("write 32768 - value"),
        "{error}"
    );
}
