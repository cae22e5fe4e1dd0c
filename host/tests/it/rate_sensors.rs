//! An arm with an encoder and a gyro: what is wrong with the gyro is named, and mended.
//!
//! The logs are of equations written out here.

use crate::common::Bench;
use serde_json::Value;
use std::fmt::Write as _;

const MASS_KG: f64 = 0.4;
const COM_M: f64 = 0.12;
const INERTIA_KG_M2: f64 = 2e-3;
const DRAG_NM_S_RAD: f64 = 0.01;
const GRAVITY_M_S2: f64 = 9.81;
const STEP_RAD: f64 = 0.0015;
const STEP_RAD_S: f64 = 0.01;

/// The arm, with these columns of its joint beside the angle's.
fn model(rate: &str) -> String {
    format!(
        r#"[rig]
name = "arm"
angle_zero = "hanging"
step_s = 0.002
gravity_m_s2 = {GRAVITY_M_S2}

[[link]]
com_m = {COM_M}
mass_kg = {MASS_KG}
inertia_kg_m2 = {INERTIA_KG_M2}

[[joint]]
drive = "torque"

[[effect]]
kind = "viscous"
joint = 1
coefficient_nm_s_rad = {DRAG_NM_S_RAD}

[log]
time = {{ column = "time_s", unit = "s" }}

[[log.joint]]
position = {{ column = "angle_rad", unit = "rad", resolution_rad = {STEP_RAD} }}
{rate}
input = {{ column = "torque_nm", unit = "N m" }}
"#
    )
}

/// Reads the gyro as it is.
const GYRO: &str = "gyro = { column = \"gyro_rad_s\", unit = \"rad/s\", resolution_rad_s = 0.01 }";

/// A gyro that reads scale times the filtered rate, plus a bias.
#[derive(Clone, Copy)]
struct Gyro {
    scale: f64,
    bias_rad_s: f64,
    lag_s: f64,
}

const GOOD: Gyro = Gyro {
    scale: 1.0,
    bias_rad_s: 0.0,
    lag_s: 0.0,
};

/// 4 s at 100 Hz, of an arm that a sum of two sines has driven for a second.
fn log(gyro: Gyro, start_rad: f64, rates: [f64; 2]) -> String {
    let (mut angle, mut speed, mut filtered) = (start_rad, 0.0, 0.0);
    let h = 1e-4;
    let mut text = String::from("time_s,angle_rad,gyro_rad_s,torque_nm\n");
    for sample in -100..400_i32 {
        let time_s = f64::from(sample) * 0.01;
        let torque_nm = 0.35 * (rates[0] * time_s).sin() + 0.2 * (rates[1] * time_s).cos();
        let torque_nm = (torque_nm * 1e6).round() / 1e6;
        let read_rad_s = gyro.scale * filtered + gyro.bias_rad_s;
        if sample >= 0 {
            let _ = writeln!(
                text,
                "{time_s:.2},{:.4},{:.2},{torque_nm}",
                (angle / STEP_RAD).round() * STEP_RAD,
                (read_rad_s / STEP_RAD_S).round() * STEP_RAD_S
            );
        }
        for _ in 0..100 {
            let pull = MASS_KG * GRAVITY_M_S2 * COM_M;
            let about_joint = INERTIA_KG_M2 + MASS_KG * COM_M * COM_M;
            let turns =
                |q: f64, w: f64| (torque_nm - pull * q.sin() - DRAG_NM_S_RAD * w) / about_joint;
            // The midpoint rule, at a step so small that nothing finer shows.
            let (q, w) = (
                angle + 0.5 * h * speed,
                speed + 0.5 * h * turns(angle, speed),
            );
            angle += h * w;
            let before = speed;
            speed += h * turns(q, w);
            filtered = if gyro.lag_s > 0.0 {
                let kept = (-h / gyro.lag_s).exp();
                kept * filtered + (1.0 - kept) * 0.5 * (before + speed)
            } else {
                speed
            };
        }
    }
    text
}

fn bench(rate: &str, gyro: Gyro) -> Bench {
    let bench = Bench::new();
    bench.put("arm.toml", model(rate));
    bench.put("1.csv", log(gyro, 0.6, [3.1, 8.3]));
    bench.put("2.csv", log(gyro, -0.9, [4.3, 9.1]));
    bench.put("3.csv", log(gyro, 0.3, [3.7, 10.1]));
    bench
}

fn diagnosed(bench: &Bench) -> Value {
    bench
        .run("diagnose arm.toml 1.csv 2.csv --holdout 3.csv --json")
        .json()
}

/// Asserts that this effect alone is named, at this value.
#[track_caller]
fn is_named(gyro: Gyro, kind: &str, key: &str, hidden: f64) {
    let bench = bench(GYRO, gyro);
    let found = diagnosed(&bench);
    assert_eq!(found["verdict"], "named", "{found:#}");
    let effects = found["effects"].as_array().unwrap();
    assert_eq!(effects.len(), 1, "{found:#}");
    assert_eq!(effects[0]["kind"], kind, "{found:#}");
    let value = &effects[0]["parameters"][key];
    let at = value["value"].as_f64().unwrap();
    assert!((at / hidden - 1.0).abs() < 0.05, "{value}");
    // With the effect the rate is read to its noise.
    let add = format!("add arm.toml {kind}@1 --fit 1.csv 2.csv --holdout 3.csv -o mended.toml");
    let added = bench.run(&add);
    assert_eq!(added.code, Some(0), "{added:?}");
    let compared = bench.run("compare mended.toml 3.csv --json").json();
    let rate = &compared["comparisons"][0]["signals"][1];
    let (rms, floor) = (&rate["rms_rad_s"], &rate["floor_rad_s"]);
    assert!(
        rms.as_f64().unwrap() < 1.5 * floor.as_f64().unwrap(),
        "{rate}"
    );
}

#[test]
fn a_bias_of_the_gyro_is_named() {
    let gyro = Gyro {
        bias_rad_s: 0.04,
        ..GOOD
    };
    is_named(gyro, "rate_bias", "bias_rad_s", 0.04);
}

#[test]
fn a_scale_of_the_gyro_is_named() {
    let gyro = Gyro {
        scale: 0.96,
        ..GOOD
    };
    is_named(gyro, "rate_scale", "factor", 0.96);
}

#[test]
fn a_lag_of_the_gyro_is_named() {
    let gyro = Gyro {
        lag_s: 0.015,
        ..GOOD
    };
    is_named(gyro, "rate_lag", "time_constant_s", 0.015);
}

#[test]
fn a_good_gyro_is_nothing_wrong_and_a_velocity_no_evidence() {
    let found = diagnosed(&bench(GYRO, GOOD));
    assert_eq!(found["verdict"], "nominal", "{found:#}");
    // The same column as a driver's `velocity` is not compared, however wrong it is.
    let biased = Gyro {
        bias_rad_s: 0.04,
        ..GOOD
    };
    let velocity = "velocity = { column = \"gyro_rad_s\", unit = \"rad/s\" }";
    let found = diagnosed(&bench(velocity, biased));
    assert_eq!(found["verdict"], "nominal", "{found:#}");
}

#[test]
fn a_gyro_that_counts_the_other_way_round_is_no_effect() {
    let bench = bench(&GYRO.replace(" }", ", reversed = true }"), GOOD);
    let said = bench.run("diagnose arm.toml 1.csv 2.csv --holdout 3.csv");
    assert!(said.stdout.contains("gyro_rad_s"), "{}", said.stdout);
    let why = "counts the other way round";
    assert!(said.stdout.contains(why), "{}", said.stdout);
}

#[test]
fn a_check_of_the_log_holds_the_gyro_against_the_angle() {
    let bench = bench(&GYRO.replace("rad/s\"", "deg/s\""), GOOD);
    let said = bench.run("log check arm.toml 1.csv").stdout;
    let factor = "gyro_rad_s is 0.017 times the change of angle_rad";
    assert!(said.contains(factor), "{said}");
    bench.put("arm.toml", model(GYRO));
    let said = bench.run("log check arm.toml 1.csv").stdout;
    assert!(!said.contains("gyro_rad_s is"), "{said}");
}

#[test]
fn a_model_from_a_log_takes_a_gyro_for_a_sensor_of_its_own() {
    let bench = bench(GYRO, GOOD);
    let written = bench.run("init 1.csv -o new.toml");
    assert_eq!(written.code, Some(0), "{written:?}");
    let text = bench.get("new.toml");
    assert!(text.contains("gyro = { column = \"gyro_rad_s\""), "{text}");
}

#[test]
fn a_gyro_can_be_picked_where_there_is_an_angle_and_no_tachometer() {
    let bench = bench(GYRO, GOOD);
    for (rate, said, remedy) in [
        (
            format!("{GYRO}\ntachometer = {{ column = \"gyro_rad_s\", unit = \"rad/s\" }}"),
            "a joint has one rate sensor: `gyro` or `tachometer`",
            "keep the one that reads more finely",
        ),
        (
            GYRO.replace("rad/s\"", "rad\""),
            "measures an angle, and `gyro` is an angular speed",
            "rad/s, deg/s, rpm",
        ),
    ] {
        bench.put("arm.toml", model(&rate));
        let refused = bench.run("compare arm.toml 1.csv");
        assert_eq!(refused.code, Some(3), "{refused:?}");
        for part in [said, remedy, "arm.toml:2"] {
            assert!(refused.stderr.contains(part), "{part}\n{}", refused.stderr);
        }
    }
    let alone = model(GYRO);
    let (before, rest) = alone.split_once("position = ").unwrap();
    let (_, after) = rest.split_once('\n').unwrap();
    bench.put("arm.toml", format!("{before}{after}"));
    let refused = bench.run("compare arm.toml 1.csv").stderr;
    assert!(
        refused.contains("this joint has no `position`"),
        "{refused}"
    );
    assert!(refused.contains("call it `velocity`"), "{refused}");
}
