//! A cart on a rail with a pole on it: logged, diagnosed, mended, balanced.
//!
//! The logs are of equations written out here, with a rail that rubs and that the model lacks.

use crate::common::Bench;
use std::fmt::Write as _;

const CART_KG: f64 = 0.9;
const POLE_KG: f64 = 0.2;
const COM_M: f64 = 0.25;
const POLE_KG_M2: f64 = 4.5e-3;
const GRAVITY_M_S2: f64 = 9.81;
/// Coulomb friction of the rail, which the model does not know, N.
const RAIL_N: f64 = 1.5;

/// The model of the cart-pole without friction on the rail.
fn model() -> String {
    format!(
        r#"# A cart-pole.
[rig]
name = "cart-pole"
angle_zero = "hanging"
step_s = 0.002
gravity_m_s2 = {GRAVITY_M_S2}

[[link]] # the cart
length_m = 0.0
com_m = 0.0
mass_kg = {CART_KG}
inertia_kg_m2 = 1e-3

[[link]] # the pole
com_m = {COM_M}
mass_kg = {POLE_KG}
inertia_kg_m2 = {POLE_KG_M2}

[[joint]]
axis = "slide"
slide_rad = 1.5707963267948966 # level
drive = "torque"

[[joint]]
drive = "passive"

[[effect]]
kind = "viscous"
joint = 2
coefficient_nm_s_rad = 0.0005

[log]
time = {{ column = "time_s", unit = "s" }}

[[log.joint]]
position = {{ column = "cart_mm", unit = "mm", resolution_m = 0.0005 }}
input = {{ column = "force_n", unit = "N" }}

[[log.joint]]
position = {{ column = "pole_rad", unit = "rad", resolution_rad = 0.003 }}
"#
    )
}

/// Cart, pole and their speeds.
type State = [f64; 4];

/// Derivative of the state where the rail pulls with `rail_n`; the pole alone while the cart is
/// `held`, and the force on the cart that is then left over.
fn derivative([_, angle, v, w]: State, force_n: f64, rail_n: f64, held: bool) -> (State, f64) {
    let (sin, cos) = angle.sin_cos();
    let moment = POLE_KG * COM_M;
    let about_hinge = POLE_KG_M2 + moment * COM_M;
    let on_pole = -moment * GRAVITY_M_S2 * sin - 0.0005 * w;
    if held {
        let turning = on_pole / about_hinge;
        let left_n = force_n - moment * (cos * turning - sin * w * w);
        return ([0.0, w, 0.0, turning], left_n);
    }
    // [M + m, m c cos; m c cos, I + m c^2] [a; turning] = [pushed; on_pole]
    let (mass, coupling) = (CART_KG + POLE_KG, moment * cos);
    let pushed = force_n + rail_n + moment * sin * w * w;
    let determinant = mass * about_hinge - coupling * coupling;
    let a = (pushed * about_hinge - coupling * on_pole) / determinant;
    let turning = (mass * on_pole - coupling * pushed) / determinant;
    ([v, w, a, turning], 0.0)
}

/// A log at 100 Hz: the pole starts at `angle_rad`, the cart is pushed by two sines.
fn log(angle_rad: f64, push_n: f64, rates: [f64; 2]) -> String {
    let mut state: State = [0.0, angle_rad, 0.0, 0.0];
    let (h, steps) = (1e-4, 100);
    let mut text = String::from("time_s,cart_mm,pole_rad,force_n\n");
    for sample in 0..300 {
        let time_s = f64::from(sample) * 0.01;
        let force_n = push_n * ((rates[0] * time_s).sin() + 0.5 * (rates[1] * time_s).cos());
        let cart_mm = (state[0] * 2e3).round() / 2.0;
        let pole_rad = (state[1] / 0.003).round() * 0.003;
        let _ = writeln!(text, "{time_s:.2},{cart_mm:.1},{pole_rad:.3},{force_n:.6}");
        let force_n = format!("{force_n:.6}").parse().unwrap();
        for _ in 0..steps {
            state = stepped(state, force_n, h);
        }
    }
    text
}

/// A step of classical Runge-Kutta; the cart stops where its speed changes sign, and stays while
/// the rail can hold it.
fn stepped(state: State, force_n: f64, h: f64) -> State {
    let (_, left_n) = derivative(state, force_n, 0.0, true);
    let held = state[2] == 0.0 && left_n.abs() <= RAIL_N;
    let direction = if state[2] == 0.0 {
        left_n.signum()
    } else {
        state[2].signum()
    };
    let slope = |at: State| derivative(at, force_n, -direction * RAIL_N, held).0;
    let ahead = |by: f64, slope: State| std::array::from_fn(|i| state[i] + by * slope[i]);
    let k1 = slope(state);
    let k2 = slope(ahead(h / 2.0, k1));
    let k3 = slope(ahead(h / 2.0, k2));
    let k4 = slope(ahead(h, k3));
    let mut next: State =
        std::array::from_fn(|i| state[i] + h / 6.0 * (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i]));
    if next[2] * direction < 0.0 {
        next[2] = 0.0;
    }
    next
}

fn bench() -> Bench {
    let bench = Bench::new();
    bench.put("cart.toml", model());
    bench.put("1.csv", log(0.5, 4.0, [2.9, 8.1]));
    bench.put("2.csv", log(-0.9, 5.0, [3.1, 8.9]));
    bench.put("3.csv", log(0.2, 4.5, [3.4, 9.7]));
    bench
}

/// A cart's path is in mm, the pole's angle in degrees, in the responses and on the map of starts.
#[test]
fn a_page_of_gains_shows_slides_in_mm() {
    let bench = bench();
    let ran = bench.run("gains cart.toml --report page.html");
    assert_eq!(ran.code, Some(0), "{ran:?}");
    let page = bench.get("page.html");
    for said in [
        "From a departure of 17.5 mm of the first joint",
        "Under a lasting force of 0.001 N on the first joint",
        "Departure of each slide",
        "path, mm",
        "angle, deg",
        "joint 1, mm",
        "joint 2, deg",
    ] {
        assert!(page.contains(said), "{said}");
    }
    assert!(!page.contains("joint 1, deg"));
}

#[test]
fn friction_of_the_rail_is_found_and_mended() {
    let bench = bench();
    let before = bench.run("compare cart.toml 3.csv --json").json();
    let cart = &before["comparisons"][0]["signals"][0];
    let missed_m = cart["rms_m"].as_f64().unwrap_or_else(|| panic!("{before}"));
    assert!(missed_m > 0.01, "{before}");
    let said = bench.run("compare cart.toml 3.csv").stdout;
    assert!(said.contains("joint 1: rms, mm"), "{said}");
    assert!(
        said.contains("1 mm of a joint that slides counts as 1 mrad"),
        "{said}"
    );

    let found = bench.run("diagnose cart.toml 1.csv 2.csv --holdout 3.csv --json");
    let found = found.json();
    assert_eq!(found["verdict"], "named", "{found}");
    let effects = found["effects"].as_array().unwrap();
    assert_eq!(effects.len(), 1, "{found}");
    assert_eq!(
        (&effects[0]["kind"], &effects[0]["joint"]),
        (&"coulomb".into(), &1.into())
    );
    let force = &effects[0]["parameters"]["force_n"];
    assert_eq!(force["unit"], "N", "{found}");
    let at = |key: &str| force[key].as_f64().unwrap();
    assert!(at("low") <= RAIL_N && RAIL_N <= at("high"), "{force}");
    assert!(at("high") - at("low") < 0.05, "{force}");

    let added = bench
        .run("add cart.toml coulomb@1 --fit 1.csv 2.csv --holdout 3.csv -o mended.toml --json");
    assert_eq!(added.code, Some(0), "{added:?}");
    assert!(
        bench.get("mended.toml").contains("force_n = 1."),
        "{}",
        bench.get("mended.toml")
    );
    let after = bench.run("compare mended.toml 3.csv --json").json();
    let left_m = after["comparisons"][0]["signals"][0]["rms_m"]
        .as_f64()
        .unwrap();
    assert!(left_m < 0.001 * missed_m, "{left_m} of {missed_m}");
}

#[test]
fn gains_stand_the_pole_up() {
    let bench = bench();
    bench.put(
        "rubs.toml",
        model() + "\n[[effect]]\nkind = \"coulomb\"\njoint = 1\nforce_n = 0.02\n",
    );
    let designed = bench.run("gains cart.toml --json");
    assert_eq!(designed.code, Some(0), "{designed:?}");
    let json = designed.json();
    let states: Vec<&str> = json["states"]
        .as_array()
        .unwrap()
        .iter()
        .map(|s| s["unit"].as_str().unwrap())
        .collect();
    assert_eq!(states, ["m", "rad", "m/s", "rad/s"], "{json}");
    assert_eq!(json["inputs"][0]["unit"], "N", "{json}");
    let said = bench.run("gains rubs.toml");
    assert_eq!(said.code, Some(0), "{said:?}");
    assert!(
        said.stdout.contains(" m, rad, held by u"),
        "{}",
        said.stdout
    );
    assert!(
        said.stdout
            .contains("within 0.5 deg and 8.7 mm: stabilised"),
        "{}",
        said.stdout
    );
}

#[test]
fn what_is_for_hinges_alone_is_refused() {
    let bench = bench();
    for line in [
        "view cart.toml 1.csv -o page.html",
        "next cart.toml 1.csv 2.csv",
        "gains cart.toml --lqg",
        "robust cart.toml",
    ] {
        let refused = bench.run(line);
        assert_ne!(refused.code, Some(0), "{line}");
        assert!(
            refused.stderr.contains("joint 1") && refused.stderr.contains("slides"),
            "{refused:?}"
        );
    }
}

#[test]
fn an_exported_cart_pole_comes_back() {
    let bench = bench();
    for (format, file) in [("mjcf", "cart.xml"), ("urdf", "cart.urdf")] {
        let exported = bench.run(&format!("model export cart.toml --to {format} -o {file}"));
        assert_eq!(exported.code, Some(0), "{exported:?}");
        let imported = bench.run(&format!("import {file} -o back-{format}.toml"));
        assert_eq!(imported.code, Some(0), "{imported:?}");
        let back = bench.get(&format!("back-{format}.toml"));
        assert!(
            back.contains("axis = \"slide\"\nslide_rad = 1.5707963267"),
            "{back}"
        );
        assert!(back.contains("unit = \"m\""), "{back}");
    }
}
