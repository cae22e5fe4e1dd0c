//! Two joints of one servo type: what they share, and what one log cannot tell of them.

use handstand::Model;
use handstand::diagnose::{
    DiagnoseOptions, Diagnosis, FittedEffect, Verdict, candidates, diagnose,
};
use handstand::fitting::{Candidate, Horizon};
use handstand::log::{LogRequest, read};
use handstand::motion::{Motion, MotionSource};
use handstand::sim::{Plant, PlantMemory, StartState, predict};
use std::fmt::Write as _;
use std::path::Path;

/// Two links, each driven by a torque.
const ARM: &str = r#"
[rig]
name = "two links"
angle_zero = "hanging"

[[link]]
length_m = 0.2
com_m = 0.1
mass_kg = 0.4
inertia_kg_m2 = 0.0015

[[link]]
length_m = 0.2
com_m = 0.1
mass_kg = 0.3
inertia_kg_m2 = 0.001

[[joint]]
drive = "torque"

[[joint]]
drive = "torque"

[log]
time = { column = "t", unit = "s" }

[[log.joint]]
position = { column = "q1", unit = "rad", resolution_rad = 0.002 }
input = { column = "u1", unit = "N m" }

[[log.joint]]
position = { column = "q2", unit = "rad", resolution_rad = 0.002 }
input = { column = "u2", unit = "N m" }
"#;

const SAMPLES: usize = 300;

fn model(text: &str) -> Model {
    Model::parse(text, Path::new("arm.toml")).unwrap()
}

/// 3 s at 100 Hz under torques that differ from joint to joint and from log to log.
fn log(truth: &Model, seed: f64) -> String {
    let time_s: Vec<f64> = (0..SAMPLES).map(|k| k as f64 / 100.0).collect();
    let torque = |joint: f64, t: f64| {
        (0.2 - 0.15 * joint)
            * ((t * (4.1 + 2.3 * joint + 0.3 * seed) + seed).sin() + (t * (9.7 - joint)).sin())
    };
    let inputs = [0.0, 1.0].map(|joint| time_s.iter().map(|t| torque(joint, *t)).collect());
    let motion = Motion {
        name: String::new(),
        source: MotionSource {
            path: "arm".into(),
            sha256: String::new(),
            lines: (0, 0),
        },
        position_rad: vec![vec![0.0; SAMPLES]; 2],
        velocity_rad_s: vec![None; 2],
        rate_rad_s: Vec::new(),
        input: inputs.map(Some).to_vec(),
        supply_v: None,
        torque_on: None,
        payload_kg: 0.0,
        turned: false,
        time_s,
    };
    let plant = Plant::new(truth, &motion);
    let start = StartState {
        angle_rad: vec![0.2 * seed, -0.1],
        speed_rad_s: vec![0.0; 2],
        reading_slope: None,
    };
    let (mut readings, mut sensors) = (vec![0.0; 2 * SAMPLES], PlantMemory::default());
    predict(
        &plant,
        &motion,
        0..SAMPLES,
        &start,
        &mut sensors,
        &mut readings,
    );
    let mut text = "t,q1,q2,u1,u2".to_string();
    for k in 0..SAMPLES {
        let [q1, q2] = [readings[k], readings[SAMPLES + k]].map(|q| (q / 0.002).round() * 0.002);
        let [u1, u2] = [0.0, 1.0].map(|joint| torque(joint, motion.time_s[k]));
        let _ = write!(text, "\n{:.2},{q1},{q2},{u1},{u2}", motion.time_s[k]);
    }
    text
}

/// The arm diagnosed from logs of the arm with something hidden.
fn diagnosed(hidden: &str, options: &DiagnoseOptions) -> Diagnosis {
    believed("", hidden, options)
}

/// The same of an arm that its owner believes to have an effect too.
fn believed(given: &str, hidden: &str, options: &DiagnoseOptions) -> Diagnosis {
    let with = |effect: &str| model(&format!("{ARM}\n{effect}"));
    let (model, truth) = (with(given), with(hidden));
    let (training, held_out) = (motions(&truth, &[1.0, 2.0]), motions(&truth, &[3.0]));
    diagnose(&model, training, held_out, options, &|_| {})
}

fn motions(truth: &Model, seeds: &[f64]) -> Vec<Motion> {
    let dir = tempfile::tempdir().unwrap();
    let files = seeds.iter().map(|seed| {
        let file = dir.path().join(format!("{seed}.csv"));
        std::fs::write(&file, log(truth, *seed)).unwrap();
        LogRequest::whole(file)
    });
    read(&files.collect::<Vec<_>>(), &truth.log).unwrap()
}

fn addresses(effects: &[FittedEffect]) -> Vec<String> {
    effects.iter().map(FittedEffect::address).collect()
}

#[test]
fn a_delay_of_all_servos_is_one_effect_with_one_value() {
    let hidden = "[[effect]]\nkind = \"delay\"\njoint = \"all\"\ndelay_s = 0.02\n";
    let found = diagnosed(hidden, &DiagnoseOptions::default());
    assert_eq!(found.verdict, Verdict::Named, "{:?}", found.summary);
    assert_eq!(addresses(&found.effects), ["delay@all"]);
    let delay = &found.effects[0].parameters[0];
    assert!((delay.value - 0.02).abs() < 5e-4, "{}", delay.value);
    assert_eq!(delay.path, "delay@all.delay_s");
    assert!(
        found.summary[0].contains("at all driven joints"),
        "{:?}",
        found.summary
    );
    let added = found.applied_to(&model(ARM));
    assert_eq!(added.effects_at(0).count(), 1);
    assert_eq!(added.effects_at(1).count(), 1);
}

#[test]
fn a_delay_of_one_servo_is_not_one_of_all() {
    let hidden = "[[effect]]\nkind = \"delay\"\njoint = 2\ndelay_s = 0.02\n";
    let found = diagnosed(hidden, &DiagnoseOptions::default());
    assert_eq!(
        addresses(&found.effects),
        ["delay@2"],
        "{:?}",
        found.summary
    );
}

#[test]
fn weaker_drives_and_heavier_links_are_not_told_apart() {
    let hidden = "[[effect]]\nkind = \"torque_scale\"\njoint = \"all\"\nfactor = 0.8\n";
    let options = DiagnoseOptions {
        most_effects: 1,
        ..DiagnoseOptions::default()
    };
    let found = diagnosed(hidden, &options);
    assert_eq!(found.verdict, Verdict::Ambiguous, "{:?}", found.summary);
    assert_eq!(addresses(&found.effects), ["torque_scale@all"]);
    let heavier = found
        .alternatives
        .iter()
        .find(|other| other.effects.is_empty());
    let heavier = heavier.expect("other masses and inertias of all links do as well");
    let paths: Vec<&str> = heavier
        .wrong_values
        .iter()
        .map(|w| w.fitted.path.as_str())
        .collect();
    assert_eq!(
        paths,
        [
            "link1.mass_kg",
            "link1.inertia_kg_m2",
            "link2.mass_kg",
            "link2.inertia_kg_m2"
        ]
    );
    for wrong in &heavier.wrong_values {
        let ratio = wrong.fitted.value / wrong.given;
        assert!((ratio - 1.25).abs() < 0.05, "{} {ratio}", wrong.fitted.path);
    }
    assert!(
        found.summary[1].contains("weigh link 1"),
        "{:?}",
        found.summary
    );
    // The file takes for exact what would part them; one that says how exact is not told to.
    let advises = |found: &Diagnosis| {
        found
            .next
            .iter()
            .any(|line| line.contains("typical = true"))
    };
    assert!(advises(&found), "{:?}", found.next);
    let weighed = "[uncertainty]\n\"link1.mass_kg\" = 0.01\n\"link2.mass_kg\" = 0.01\n";
    let stated = believed(weighed, hidden, &options);
    assert!(!advises(&stated), "{:?}", stated.next);
}

#[test]
fn a_value_that_the_file_frees_goes_before_an_effect_that_does_as_well() {
    let friction = |coefficient: f64| {
        format!("[[effect]]\nkind = \"viscous\"\njoint = 1\ncoefficient_nm_s_rad = {coefficient}\n")
    };
    let options = DiagnoseOptions {
        most_effects: 1,
        ..DiagnoseOptions::default()
    };
    let found = believed(&friction(0.01), &friction(0.03), &options);
    assert_eq!(found.verdict, Verdict::WrongValue, "{:?}", found.summary);
    assert_eq!(
        found.wrong_values[0].fitted.path,
        "viscous@1.coefficient_nm_s_rad"
    );
    let others: Vec<Vec<String>> = found
        .alternatives
        .iter()
        .map(|other| addresses(&other.effects))
        .collect();
    assert!(
        others.contains(&vec!["speed_limit@1".to_string()]),
        "{others:?}"
    );
    assert!(
        found.summary[1].starts_with("These logs cannot tell this from"),
        "{:?}",
        found.summary
    );
}

#[test]
fn only_what_comes_with_servos_of_one_type_is_shared() {
    let shared = |model: &Model| -> Vec<String> {
        let tried = candidates(model, &motions(model, &[1.0]), &[]);
        let names = tried.iter().map(Candidate::to_string);
        names.filter(|name| name.ends_with("@all")).collect()
    };
    let alike = shared(&model(ARM));
    for id in [
        "delay",
        "dead_zone",
        "coulomb",
        "viscous",
        "armature",
        "sensor_lag",
    ] {
        assert!(alike.contains(&format!("{id}@all")), "{id}: {alike:?}");
    }
    for id in [
        "mass",
        "com_angle",
        "encoder_zero",
        "time_offset",
        "cable_spring",
        "bearing_friction",
    ] {
        assert!(!alike.contains(&format!("{id}@all")), "{id}");
    }
    let held = "[[effect]]\nkind = \"coulomb\"\njoint = 2\ntorque_nm = 0.01\n";
    let with_one = shared(&model(&format!("{ARM}\n{held}")));
    assert!(
        !with_one.contains(&"coulomb@all".to_string()),
        "{with_one:?}"
    );
    let (first, second) = ARM.rsplit_once("drive = \"torque\"").unwrap();
    let other = "drive = \"duty\"\nstall_torque_nm = 1.5";
    let second = second.replacen("unit = \"N m\"", "unit = \"1\"", 2);
    let second = second.replacen("unit = \"1\"", "unit = \"N m\"", 1);
    assert_eq!(
        shared(&model(&format!("{first}{other}{second}"))),
        Vec::<String>::new()
    );
}

#[test]
fn an_effect_of_all_meets_that_of_each_driven_joint() {
    let named = |name: &str, model: &Model| Candidate::named(name, model).unwrap();
    let driven = model(ARM);
    let all = named("coulomb@all", &driven);
    assert!(all.overlaps(named("coulomb@2", &driven), &driven));
    assert!(named("coulomb@1", &driven).overlaps(all, &driven));
    assert!(!all.overlaps(named("delay@2", &driven), &driven));
    let text = ARM.replacen("drive = \"torque\"", "drive = \"passive\"", 1);
    let bar = model(&text.replacen("input = { column = \"u1\", unit = \"N m\" }", "", 1));
    assert!(!named("coulomb@all", &bar).overlaps(named("coulomb@1", &bar), &bar));
    assert!(Candidate::named("bearing_friction@all", &bar).is_err());
}

#[test]
fn the_error_budget_says_what_each_part_removes() {
    let hidden = "[[effect]]\nkind = \"delay\"\njoint = \"all\"\ndelay_s = 0.01\n\
                  [[effect]]\nkind = \"viscous\"\njoint = 1\ncoefficient_nm_s_rad = 0.02\n";
    // Over whole motions the model as given is lost, and a share of its error may be anything.
    let options = DiagnoseOptions {
        most_effects: 2,
        horizon: Some(Horizon::Seconds(0.5)),
        ..DiagnoseOptions::default()
    };
    let found = diagnosed(hidden, &options);
    let mut parts: Vec<&str> = found.budget.iter().map(|part| part.part.as_str()).collect();
    parts.sort_unstable();
    let mut effects = addresses(&found.effects);
    effects.sort_unstable();
    assert_eq!(parts, effects);
    assert_eq!(parts.len(), 2, "{:?}", found.summary);
    for part in &found.budget {
        let (alone, beyond) = (&part.alone, &part.beyond_others);
        assert!(alone.error_rad < found.error.before_rad, "{part:?}");
        assert!(beyond.error_rad > 2.0 * found.error.after_rad, "{part:?}");
        for share in [alone, beyond] {
            assert!(
                share.low <= share.share && share.share <= share.high,
                "{part:?}"
            );
            assert!(share.low > 0.0 && share.high < 1.0, "{part:?}");
        }
        // One joint of two decides alike: the share follows from the errors.
        let follows = 1.0 - (alone.error_rad / found.error.before_rad).powi(2);
        assert!((alone.share - follows).abs() < 0.02, "{part:?} {follows}");
    }
}
