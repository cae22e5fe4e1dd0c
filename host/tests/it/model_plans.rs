//! What a model says of its drives is in the plan that `deploy` and `balance` make of it: they need
//! no option for it, and `deploy` says beforehand what `balance` then does.

use crate::common::{Bench, Ran};
use std::fmt::Write as _;

const CLEAN: &str = include_str!("../../robot/src/deploy/basis/robot.toml");
/// Starts, degrees off in each joint.
const LEANS: [&str; 10] = [
    "1/-1/1",
    "-1/1/-1",
    "1/1/1",
    "-1/-1/-1",
    "0.3/-0.8/0.5",
    "-0.6/0.2/0.9",
    "0.7/0.7/-0.7",
    "1/0/-1",
    "0.1/-0.2/0.1",
    "-0.4/-0.9/0.6",
];

/// The paper's robot with these effects, each as kind, joint and values.
fn robot(effects: &[(&str, &str, &str)]) -> String {
    let mut text = String::new();
    for (kind, joint, values) in effects {
        let _ = writeln!(
            text,
            "[[effect]]\nkind = \"{kind}\"\njoint = {joint}\n{values}\n"
        );
    }
    CLEAN.replace("# effects", &text)
}

/// How many of these starts `balance` stands from for 10 s, told nothing but the model and
/// `options`.
fn stood(bench: &Bench, leans: &[&str], options: &str) -> usize {
    let stands = |lean: &&&str| {
        let port = format!("--port sim-cm5:robot=m.toml,start=held,lean={lean}");
        let ran = bench.run(&format!(
            "balance m.toml {port} --yes --seconds 10 --countdown 0 {options}"
        ));
        assert!([Some(0), Some(5)].contains(&ran.code), "{ran:?}");
        ran.code == Some(0)
    };
    leans.iter().filter(stands).count()
}

fn deploy(bench: &Bench, options: &str) -> Ran {
    bench.run(&format!(
        "deploy m.toml --dry-run --states 1 --json {options}"
    ))
}

#[test]
fn a_robot_with_one_effect_of_its_drives_stands_by_the_plan_of_its_model() {
    let bench = Bench::new();
    for effect in [
        ("delay", "\"all\"", "delay_s = 0.018"),
        ("delay", "2", "delay_s = 0.018"),
        ("dead_zone", "\"all\"", "width = 0.2\npunch = 0.0"),
        ("dead_zone", "\"all\"", "width = 0.1\npunch = -0.1"),
        ("coulomb", "2", "torque_nm = 0.2"),
        ("torque_saturation", "\"all\"", "limit_nm = 1.0"),
        ("sensor_lag", "2", "time_constant_s = 0.02"),
        ("torque_scale", "\"all\"", "factor = 0.7"),
    ] {
        bench.put("m.toml", robot(&[effect]));
        let count = stood(&bench, &LEANS, "");
        assert!(count >= 9, "{effect:?}: {count} of 10");
        let ran = deploy(&bench, "");
        assert_eq!(ran.code, Some(0), "{effect:?}: {ran:?}");
    }
}

/// Behind play the joints swing faster than a robot's limits allow: that is said beforehand, and
/// holds for limits that are asked for.
#[test]
fn a_robot_that_swings_too_fast_is_let_down_as_deploy_says() {
    let bench = Bench::new();
    bench.put("m.toml", robot(&[("backlash", "2", "gap_rad = 0.032")]));
    for (options, code, stands) in [("", 1, 0), ("--joint-speed 12 --joint-range 1.5", 0, 3)] {
        assert_eq!(deploy(&bench, options).code, Some(code), "{options}");
        assert_eq!(stood(&bench, &LEANS[..3], options), stands, "{options}");
    }
}

/// The verdict of a plan and what becomes of it, of robots that stand and that fall.
#[test]
fn deploy_says_what_balance_then_does() {
    let bench = Bench::new();
    let late = ("delay", "\"all\"", "delay_s = 0.0128");
    let (heavy, bar) = (
        ("mass", "2", "added_kg = 0.134"),
        ("coulomb", "1", "torque_nm = 0.081"),
    );
    let lag = ("sensor_lag", "2", "time_constant_s = 0.02");
    let (far, weak) = (
        ("delay", "\"all\"", "delay_s = 0.06"),
        ("torque_saturation", "\"all\"", "limit_nm = 0.1"),
    );
    for (effects, holds) in [
        (&[late, heavy][..], true),
        (&[heavy], true),
        (&[bar], false),
        (&[lag], true),
        (&[far], false),
        (&[weak], false),
    ] {
        bench.put("m.toml", robot(effects));
        let ran = deploy(&bench, "");
        let code = if holds { 0 } else { 1 };
        assert_eq!(ran.code, Some(code), "{effects:?}: {ran:?}");
        let data = ran.json();
        assert_eq!(data["verdict"]["holds"], holds, "{effects:?}");
        assert_eq!(data["verdict"]["attempts"].as_array().unwrap().len(), 10);
        let count = stood(&bench, &LEANS[..3], "");
        assert_eq!(count == 3, holds, "{effects:?}: {count} of 3");
        assert!(holds || count == 0, "{effects:?}: {count} of 3");
    }
}

/// What is taken of a model, what cannot be, and what goes before it is said.
#[test]
fn what_a_plan_takes_of_its_model_is_listed() {
    let bench = Bench::new();
    let effects = [
        ("delay", "\"all\"", "delay_s = 0.018"),
        ("backlash", "2", "gap_rad = 0.004"),
    ];
    bench.put("m.toml", robot(&effects));
    let made = deploy(&bench, "").json();
    let place = |effect: &str| {
        let mut effects = made["effects"].as_array().unwrap().iter();
        effects.find(|it| it["effect"] == effect).unwrap()["place"].clone()
    };
    assert_eq!(
        (place("delay@all"), place("backlash@2")),
        ("observer".into(), "nowhere".into())
    );
    let told = deploy(&bench, "--drive-delay 0.01").json();
    assert_ne!(told["fingerprint"], made["fingerprint"]);
    let same = deploy(&bench, "--drive-delay 0.018").json();
    assert_eq!(same["fingerprint"], made["fingerprint"]);
    let text = bench.run("deploy m.toml --dry-run --states 1").stdout;
    assert!(text.contains("18.0 ms, from command to torque"), "{text}");
    assert!(text.contains("10 of 10 starts"), "{text}");
}
