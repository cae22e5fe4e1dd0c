//! `handstand gains` seen from outside: its files compile and compute what the shared law computes,
//! and what cannot be designed is refused.

use crate::common::Bench;
use handstand_shared::gains::GainTable;
use handstand_shared::law::control;
use serde_json::Value;
use std::fmt::Write as _;
use std::path::Path;
use std::process::Command;

fn bench() -> Bench {
    let bench = Bench::new();
    bench.put(
        "handstand.toml",
        include_str!("../../models/handstand.toml"),
    );
    bench
}

/// Numerical Recipes' generator, the same in Rust, C and here.
fn states() -> impl Iterator<Item = [i16; 6]> {
    let mut seed = 1_u32;
    let mut next = move || {
        seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (seed >> 16) as u16 as i16
    };
    (0..2000).map(move |k| std::array::from_fn(|_| next() >> (k % 12)))
}

const RUST_MAIN: &str = r#"
fn main() {
    assert!(check(control));
    let mut seed = 1_u32;
    for k in 0..2000 {
        let mut x = [0_i16; 6];
        for x in &mut x {
            seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            *x = ((seed >> 16) as u16 as i16) >> (k % 12);
        }
        let u = control(&x);
        println!("{} {}", u[0], u[1]);
    }
    println!("{FINGERPRINT}");
}
"#;

const C_MAIN: &str = r#"
#define GAINS_TEST
#include "gains.h"
#include <stdio.h>
int main(void)
{
    int16_t x[GAINS_STATES], u[GAINS_INPUTS];
    if (gains_check() != 0) return 1;
    uint32_t seed = 1;
    for (int k = 0; k < 2000; k++) {
        for (int j = 0; j < GAINS_STATES; j++) {
            seed = seed * 1664525u + 1013904223u;
            x[j] = (int16_t)((int16_t)(uint16_t)(seed >> 16) >> (k % 12));
        }
        gains_control(x, u);
        printf("%d %d\n", u[0], u[1]);
    }
    printf("%lu\n", (unsigned long)GAINS_FINGERPRINT);
    return 0;
}
"#;

fn output(command: &mut Command) -> String {
    let ran = command.output().unwrap();
    assert!(
        ran.status.success(),
        "{}",
        String::from_utf8_lossy(&ran.stderr)
    );
    String::from_utf8(ran.stdout).unwrap().replace("\r\n", "\n")
}

/// The table that `--json` prints.
fn table(fixed: &Value) -> GainTable<2, 6> {
    fn array<T: TryFrom<i64>, const N: usize>(value: &Value) -> [T; N] {
        std::array::from_fn(|i| T::try_from(value[i].as_i64().unwrap()).ok().unwrap())
    }
    let table = GainTable::new(
        std::array::from_fn(|i| array(&fixed["k"][i])),
        array(&fixed["bias"]),
        array(&fixed["shift"]),
        std::array::from_fn(|i| array(&fixed["limits"][i])),
        array(&fixed["x0"]),
    );
    assert_eq!(
        u64::from(table.fingerprint()),
        fixed["fingerprint"].as_u64().unwrap()
    );
    assert!(table.is_safe());
    table
}

#[test]
fn rust_and_c_files_compile_as_they_are_and_compute_what_the_shared_law_does() {
    let bench = bench();
    let ran = bench.run("gains handstand.toml --rust gains.rs --c gains.h --json");
    assert_eq!(ran.code, Some(0), "{}", ran.stderr);
    let json: Value = serde_json::from_str(&ran.stdout).unwrap();
    let table = table(&json["fixed"]);
    let mut expected = String::new();
    for x in states() {
        let [a, b] = control(&table, &x);
        let _ = writeln!(expected, "{a} {b}");
    }
    let _ = writeln!(expected, "{}", table.fingerprint());

    bench.put("main.rs", bench.get("gains.rs") + RUST_MAIN);
    let rustc = std::env::var_os("RUSTC").unwrap_or_else(|| "rustc".into());
    let built = bench.path("rust_main");
    output(
        Command::new(rustc)
            .args(["--edition", "2024", "-D", "warnings", "-o"])
            .args([&built, &bench.path("main.rs")]),
    );
    assert_eq!(output(&mut Command::new(built)), expected);

    // Rust's own linker: wherever rustc works, it is there.
    bench.put("main.c", C_MAIN);
    let built = bench.path("c_main");
    output(
        Command::new("cc")
            .args(["-std=c99", "-Wall", "-Wextra", "-Werror", "-O2", "-o"])
            .args([&built, &bench.path("main.c")]),
    );
    assert_eq!(output(&mut Command::new(built)), expected);
}

#[test]
fn what_cannot_be_designed_ends_in_3_and_says_why() {
    let bench = bench();
    let model = include_str!("../../models/handstand.toml");
    bench.put(
        "passive.toml",
        model
            .replace("drive = \"torque\"", "drive = \"passive\"")
            .replace("input = {", "# {"),
    );
    bench.put("skew.csv", "1,0.5\n0,1\n");
    bench.put("words.csv", "1,0\n0,one\n");
    bench.put("ragged.csv", "1,0\n0\n");
    bench.put(
        "weightless.toml",
        model.replace("gravity_m_s2 = 9.81", "gravity_m_s2 = 0.0"),
    );
    for (line, said) in [
        (
            "handstand.toml --q 100 --r skew.csv",
            "R is not symmetric: entry (2, 1) is 0, entry (1, 2) is 0.5",
        ),
        (
            "handstand.toml --q 100 --r words.csv",
            "words.csv:2:2: `one` is no number",
        ),
        (
            "handstand.toml --q 100 --r ragged.csv",
            "ragged.csv:2:1: 1 numbers where",
        ),
        ("handstand.toml --pose 1,0,0", "joint 1 is passive"),
        ("handstand.toml --ts 3", "sample faster: within one sample"),
        (
            "handstand.toml --state-step 1e-5,1e-5,1e-5,1,1,1",
            "but a word holds 32767",
        ),
        (
            "handstand.toml --input-step 1e-4 --range 1e5",
            "the gains of input 1 overflow 16 bits",
        ),
        ("passive.toml", "no joint of `handstand` is driven"),
        ("nowhere.toml", "nowhere.toml"),
        // Without gravity the whole robot turns freely on the bar, and torques inside it cannot
        // stop that.
        (
            "weightless.toml",
            "no input reaches it: the plant cannot be stabilised",
        ),
    ] {
        let ran = bench.run(&format!("gains {line}"));
        assert_eq!(ran.code, Some(3), "{line}: {}{}", ran.stdout, ran.stderr);
        assert!(
            ran.stderr.to_lowercase().contains(&said.to_lowercase()),
            "{line}: {}",
            ran.stderr
        );
        assert!(ran.stdout.is_empty(), "{line}");
    }
}

/// The robot as `add` leaves it: servos that regulate positions, viscous and Coulomb friction.
#[test]
fn effects_without_a_derivative_are_left_out_and_listed() {
    let bench = bench();
    bench.put("robot.toml", include_str!("../../models/robot.toml"));
    // Whether the servos hold the robot with their friction is the verification's answer.
    let ended = |line: &str| {
        let ran = bench.run(line);
        assert!(matches!(ran.code, Some(0 | 1)), "{line}: {}", ran.stderr);
        ran
    };
    let ran = ended("gains robot.toml --rust gains.rs");
    let said =
        "The design leaves out Coulomb friction at joints 2, 3: its torque jumps at standstill";
    assert!(ran.stdout.contains(said), "{}", ran.stdout);
    assert!(bench.get("gains.rs").contains(said));
    let json = |line: &str| -> Value {
        let ran = ended(line);
        let found: Value = serde_json::from_str(&ran.stdout).unwrap();
        let stabilised = found["verification"]["stabilised"].as_bool().unwrap();
        assert_eq!(ran.code, Some(i32::from(!stabilised)), "{line}");
        found
    };
    let with = json("gains robot.toml --json");
    let omitted = with["omitted_effects"].as_array().unwrap();
    assert_eq!(omitted.len(), 2);
    assert_eq!(
        (&omitted[1]["effect"], &omitted[1]["joint"]),
        (&"coulomb".into(), &3.into())
    );
    let without = json("gains robot.toml --without coulomb --json");
    assert_eq!(without["omitted_effects"].as_array().unwrap().len(), 0);
    assert_eq!(with["k"], without["k"]);
    let smooth = json("gains robot.toml --without coulomb --without viscous --json");
    assert_ne!(with["k"], smooth["k"]);
}

#[test]
fn requests_that_make_no_sense_end_in_2() {
    let bench = bench();
    for (line, said) in [
        ("handstand.toml --q nowhere.csv", "a CSV file that exists"),
        (
            "handstand.toml --continuous --rust gains.rs",
            "cannot be used with",
        ),
        ("handstand.toml --state-space plant.txt", ".json"),
        ("handstand.toml --without coulomb", "it holds none at all"),
        ("handstand.toml --csv a.csv", "exists"),
        ("handstand.toml --q -1", "Q is not positive semidefinite"),
        (
            "handstand.toml --q 1,2,3",
            "Q has 3 values, but there are 6 states",
        ),
        ("handstand.toml --q nan", "Q has an entry of NaN"),
        ("handstand.toml --q 100 --r 0", "R is not positive definite"),
        ("handstand.toml --ts 0", "a sampling time of 0 s"),
        ("handstand.toml --ts nan", "a sampling time of NaN s"),
        ("handstand.toml --delay -0.1", "a delay of -0.1 s"),
        ("handstand.toml --delay 5", "a delay of 5 s"),
        ("handstand.toml --pose 1.5", "the pose has 1 angles"),
        ("handstand.toml --range 0", "the range of state 1 is 0"),
        ("handstand.toml --range 1,2,3", "the range of states has 3"),
        ("handstand.toml --state-step 1,2,3", "--state-step has 3"),
    ] {
        let ran = bench.run(&format!("gains {line}"));
        assert_eq!(ran.code, Some(2), "{line}: {}{}", ran.stdout, ran.stderr);
        assert!(ran.stderr.contains(said), "{line}: {}", ran.stderr);
    }
}

#[test]
fn files_carry_every_digit() {
    let bench = bench();
    let ran = bench.run("gains handstand.toml --lqg --csv k.csv --state-space plant.json --json");
    assert_eq!(ran.code, Some(0), "{}", ran.stderr);
    let said: Value = serde_json::from_str(&ran.stdout).unwrap();
    let kept: Value = serde_json::from_str(&bench.get("plant.json")).unwrap();
    assert_eq!(said, kept);
    let csv = bench.get("k.csv");
    let rows = csv.lines().skip(1).map(|line| line.split(',').skip(1));
    for (i, row) in rows.enumerate() {
        for (j, text) in row.enumerate() {
            let kept = kept["k"][i][j].as_f64().unwrap();
            // JSON's reader may miss the last digit.
            assert!((text.parse::<f64>().unwrap() / kept - 1.0).abs() < 1e-15);
        }
    }
    let radius = |poles: &Value| {
        let poles = poles.as_array().unwrap().iter();
        poles.fold(0.0_f64, |most, z| {
            most.max(z[0].as_f64().unwrap().hypot(z[1].as_f64().unwrap()))
        })
    };
    assert!(radius(&kept["loop_poles"]) < 1.0);
    assert!(radius(&kept["estimator"]["loop_poles"]) < 1.0);
    assert!(Path::new(&bench.path("plant.json")).is_file());
}

#[test]
fn the_model_s_own_delay_and_eccentric_masses_are_designed_for() {
    let bench = bench();
    let model = include_str!("../../models/handstand.toml");
    let late = |joint: u8, seconds: f64| {
        format!("[[effect]]\nkind = \"delay\"\njoint = {joint}\ndelay_s = {seconds}\n")
    };
    bench.put(
        "late.toml",
        format!("{model}\n{}{}", late(2, 0.02), late(3, 0.02)),
    );
    bench.put(
        "uneven.toml",
        format!("{model}\n{}{}", late(2, 0.02), late(3, 0.01)),
    );
    let tilted = "[[effect]]\nkind = \"com_angle\"\njoint = 3\nangle_rad = 0.05\n";
    bench.put("tilted.toml", format!("{model}\n{tilted}"));
    let json = |line: &str| -> Value {
        let ran = bench.run(&format!("gains {line} --json"));
        assert_eq!(ran.code, Some(0), "{line}: {}", ran.stderr);
        serde_json::from_str(&ran.stdout).unwrap()
    };
    let late = json("late.toml");
    assert_eq!(late["sampled"]["delay_s"], 0.02);
    assert_eq!(late["sampled"]["delayed_inputs"], 2);
    assert_eq!(late["states"][6]["name"], "u2(k-1)");
    assert_eq!(json("uneven.toml --delay 0.02")["k"], late["k"]);
    let uneven = bench.run("gains uneven.toml");
    assert_eq!(uneven.code, Some(3));
    assert!(
        uneven.stderr.contains("the drives differ in delay"),
        "{}",
        uneven.stderr
    );

    let upright = bench.run("gains tilted.toml");
    assert_eq!(upright.code, Some(3));
    assert!(upright.stderr.contains("--balance"), "{}", upright.stderr);
    let balanced = json("tilted.toml --balance");
    let q1 = balanced["x0"][0].as_f64().unwrap() - std::f64::consts::FRAC_PI_2;
    // The hips' torque holds the legs; the whole leans the other way.
    assert!((-0.05..-0.005).contains(&q1), "{q1}");
    assert!(balanced["u0"][1].as_f64().unwrap().abs() > 0.01);
}

#[test]
fn gains_for_continuous_time_are_verified_fast_enough_for_their_poles() {
    let bench = bench();
    let ran = bench.run("gains handstand.toml --continuous --json");
    assert_eq!(ran.code, Some(0), "{}", ran.stderr);
    assert_eq!(ran.json()["verification"]["stabilised"], true);
}

#[test]
fn gains_that_rounding_makes_unstable_are_the_answer_no() {
    let bench = bench();
    let ran = bench.run("gains handstand.toml --delay 0.4");
    assert_eq!(ran.code, Some(1), "{ran:?}");
    let said = "the gains no longer stabilise";
    assert!(ran.stderr.contains(said), "{}", ran.stderr);
}
