//! A robot that balances with friction that its model lacks: with its log and its plan, the closed
//! loop of the right model differs from that of the wrong one.

use crate::common::Bench;
use handstand::Model;
use handstand::sim::closed_loop::{
    ClosedLoop, Commands, InitialState, Sensor, StateFeedback, stream,
};
use handstand::synth::StateFeedbackPlan;
use handstand_shared::raw::Position;
use serde_json::{Value, json};
use std::fmt::Write as _;

const HANDSTAND: &str = include_str!("../../models/handstand.toml");
/// The robot in one piece on a driven shoulder.
const PENDULUM: &str = r#"
[rig]
name = "inverted pendulum"
angle_zero = "upright"
step_s = 0.002
[[link]]
com_m = 0.12
mass_kg = 1.5
inertia_kg_m2 = 0.015
[[joint]]
drive = "torque"
[log]
time = { column = "time_s", unit = "s" }
[[log.joint]]
position = { column = "q1_rad", unit = "rad" }
velocity = { column = "dq1_rad_s", unit = "rad/s" }
input = { column = "torque1_nm", unit = "N m" }
"#;

/// With `nominal.toml`, `gains.json` for it, `true.toml` with this Coulomb friction at `joint`, and
/// logs of the true robot under the gains of the nominal one, from three starts up to twice
/// `lean_rad`: `a.csv`, `b.csv`, `c.csv`.
fn bench(model: &str, joint: usize, coulomb_nm: f64, lean_rad: f64, seconds: f64) -> Bench {
    let bench = Bench::new();
    let ten_bits = format!("unit = \"rad\", resolution_rad = {} }}", Position::LSB_RAD);
    let nominal = model.replace("unit = \"rad\" }", &ten_bits);
    bench.put("nominal.toml", &nominal);
    let friction =
        format!("\n[[effect]]\nkind = \"coulomb\"\njoint = {joint}\ntorque_nm = {coulomb_nm}\n");
    bench.put("true.toml", format!("{nominal}{friction}"));
    let ran = bench.run("gains nominal.toml --q 100 --state-space gains.json");
    assert_eq!(ran.code, Some(0), "{ran:?}");
    for (name, factor) in [("a.csv", 1.0), ("b.csv", -1.5), ("c.csv", 2.0)] {
        bench.put(name, balanced(&bench, factor * lean_rad, seconds));
    }
    bench
}

/// The true robot from this lean, measured at 100 Hz.
fn balanced(bench: &Bench, lean_rad: f64, seconds: f64) -> String {
    let model = Model::load(&bench.path("true.toml")).unwrap();
    let plan = StateFeedbackPlan::load(&bench.path("gains.json"), &model).unwrap();
    let mut closed = ClosedLoop::new(&model, &plan.pose_rad, Commands::Own, 0.01).unwrap();
    closed.sensor = Sensor {
        position_resolution_rad: Position::LSB_RAD,
        ..Sensor::EXACT
    };
    let joints = model.link_count();
    let law = StateFeedback::new(joints, plan.k.clone()).feeding(&plan.u0);
    let mut text = String::from("time_s");
    for joint in 1..=joints {
        let _ = write!(text, ",q{joint}_rad,dq{joint}_rad_s,torque{joint}_nm");
    }
    let mut start = vec![0.0; joints];
    start[0] = lean_rad;
    let outcome = closed.watch(
        &law,
        &InitialState::at(start),
        seconds,
        stream(7, 0),
        |sample| {
            let _ = write!(text, "\n{:.2}", sample.time_s);
            for joint in 0..joints {
                let angle = plan.pose_rad[joint] + sample.measured.angle_rad[joint];
                let speed = sample.speed_rad_s[joint];
                let passive = joints - sample.command.len();
                let drive = joint.checked_sub(passive);
                let torque = drive.map_or(0.0, |drive| sample.command[drive]);
                let _ = write!(text, ",{angle},{speed},{torque}");
            }
        },
    );
    assert_eq!(outcome.fell_s, None);
    text
}

/// Simulated over measured limit cycle, each of the joint that swings most.
fn cycle_ratio(closed_loop: &Value) -> f64 {
    let signals = closed_loop["signals"].as_array().unwrap();
    let largest = |key: &str| {
        let cycles = signals.iter().map(|signal| signal[key].as_f64().unwrap());
        cycles.fold(0.0, f64::max)
    };
    largest("simulated_limit_cycle_rad") / largest("measured_limit_cycle_rad")
}

#[test]
fn the_limit_cycle_tells_the_right_model_from_the_wrong_one() {
    // The cycle wanders: a few seconds do not tell how large it is, many tell nothing of errors.
    let of_seconds = |seconds| bench(HANDSTAND, 2, 0.05, 0.01, seconds);
    let (brief, bench) = (of_seconds(2.0), of_seconds(20.0));
    let line =
        "compare nominal.toml a.csv b.csv c.csv --model true.toml --plan gains.json --horizon 0.1";
    let ran = bench.run(line);
    assert_eq!(ran.code, Some(0), "{ran:?}");
    let (_, table) = ran.stdout.split_once("Closed loop with the plan").unwrap();
    for part in [
        "measured",
        "nominal.toml",
        "true.toml",
        "joint 3: limit cycle, mrad",
        "0 of 3",
    ] {
        assert!(table.contains(part), "the table lacks {part}: {table}");
    }

    let report = bench
        .run(&format!("{line} --json --report report.html"))
        .json();
    let loops = [0, 1].map(|model| &report["comparisons"][model]["closed_loop"]);
    let [nominal, right] = loops.map(cycle_ratio);
    assert!(nominal < 0.5, "nominal: {nominal}");
    assert!((right - 1.0).abs() < 0.3, "true: {right}");
    let report = brief.run(&format!("{line} --json")).json();
    let errors = [0, 1].map(|model| {
        let closed = &report["comparisons"][model]["closed_loop"];
        closed["signals"][2]["rms_error_rad"].as_f64().unwrap()
    });
    assert!(errors[1] < errors[0], "{errors:?}");
    assert!(
        loops
            .iter()
            .all(|closed| closed["motions"][0]["simulated_fell_s"].is_null())
    );
    assert!(bench.get("report.html").contains("id=\"closed-loop\""));

    let without = bench
        .run("compare nominal.toml a.csv --json --horizon 0.1")
        .json();
    assert!(without["comparisons"][0]["closed_loop"].is_null());
}

#[test]
fn a_loop_that_falls_is_told() {
    let bench = bench(HANDSTAND, 2, 0.05, 0.01, 5.0);
    // A law of the wrong sign.
    let mut plan: Value = serde_json::from_str(&bench.get("gains.json")).unwrap();
    for gain in plan["k"].as_array_mut().unwrap() {
        for gain in gain.as_array_mut().unwrap() {
            *gain = json!(-gain.as_f64().unwrap());
        }
    }
    bench.put("wrong.json", plan.to_string());
    let ran = bench.run("compare true.toml a.csv --plan wrong.json --json --horizon 0.1");
    let motion = &ran.json()["comparisons"][0]["closed_loop"]["motions"][0];
    assert!(motion["measured_fell_s"].is_null());
    assert!(
        motion["simulated_fell_s"].as_f64().unwrap() < 1.0,
        "{motion}"
    );
    let signal = &motion["signals"][0];
    assert!(signal["simulated_limit_cycle_rad"].is_null());
    assert!(signal["rms_error_rad"].as_f64().unwrap() > 0.05, "{motion}");
}

#[test]
fn diagnose_shows_the_closed_loop_with_what_it_found() {
    let bench = bench(PENDULUM, 1, 0.1, 0.15, 1.5);
    let line = "diagnose nominal.toml a.csv b.csv --holdout c.csv --plan gains.json";
    let text = bench.run(line);
    assert_eq!(text.code, Some(0), "{text:?}");
    let (_, table) = text.stdout.split_once("Closed loop with the plan").unwrap();
    assert!(
        table.contains("the model as it is | the model with "),
        "{table}"
    );
    let found = bench.run(&format!("{line} --json")).json();
    let [before, after] = ["before", "after"].map(|key| {
        let error = &found["closed_loop"][key]["signals"][0]["rms_error_rad"];
        error.as_f64().unwrap()
    });
    assert!(after < 0.3 * before, "{before} {after}");
}

#[test]
fn plans_that_do_not_fit_are_refused_with_their_key() {
    let bench = bench(HANDSTAND, 2, 0.05, 0.01, 5.0);
    let plan: Value = serde_json::from_str(&bench.get("gains.json")).unwrap();
    let mut cases = vec![("{".to_string(), "not JSON")];
    let mut case = |pointer: &str, value: Value, said| {
        let mut plan = plan.clone();
        match pointer.rsplit_once('/') {
            Some((parent, key)) => plan.pointer_mut(parent).unwrap()[key] = value,
            None => plan = value,
        }
        cases.push((plan.to_string(), said));
    };
    case("", json!([1.0]), "`u0` holds nothing");
    case("/k", json!([[1.0]]), "`k` has 1 values");
    case("/k", json!([[1.0], [2.0]]), "`k[0]` has 1 values");
    case("/k", Value::Null, "`k` holds null, not a list of rows");
    case("/x0", json!([1.0, 2.0]), "`x0` has 2 values");
    case("/u0", json!([0.0, "a"]), "`u0[1]` holds \"a\"");
    case("/sampled/ts_s", json!(0.0), "`sampled.ts_s`");
    case("/sampled/ts_s", json!(1e-300), "`sampled.ts_s`");
    case("/sampled/delay_s", json!(1.0), "`sampled.delay_s` is 1 s");
    case(
        "/sampled/delayed_inputs",
        json!(u64::MAX),
        "`x0` has 6 values",
    );
    case(
        "/sampled/delayed_inputs",
        json!(-1),
        "`sampled.delayed_inputs`",
    );
    case("/estimator", json!({}), "`estimator` is set");
    for (text, said) in cases {
        bench.put("bad.json", &text);
        let ran = bench.run("compare nominal.toml a.csv --plan bad.json");
        assert_eq!(ran.code, Some(3), "{said}: {ran:?}");
        // The message may be folded anywhere.
        let words = |text: &str| text.split_whitespace().collect::<Vec<_>>().join(" ");
        let told = words(&ran.stderr.replace('│', " "));
        assert!(
            told.contains("bad.json") && told.contains(said),
            "{said}: {told}"
        );
    }
    let ran = bench.run("diagnose model.toml a.csv --plan gains.json");
    assert_eq!(ran.code, Some(3), "{ran:?}");
    assert!(ran.stderr.contains("`u0` has 2 values"), "{ran:?}");
    let ran = bench.run("compare nominal.toml a.csv --plan none.json");
    assert_eq!(ran.code, Some(3), "{ran:?}");
}
