//! The C header: compilers take it without a warning, several stand in one file, and it computes
//! what the law does.

use crate::common::Bench;
use handstand::Model;
use handstand::sim::closed_loop::{Controller as _, Measurement};
use handstand::synth::controllers::FixedPointFeedback;
use handstand::synth::export::{Provenance, c_header, rust_file};
use handstand::synth::{CostWeights, Design, FixedDesign, Request, Time, Weight};
use std::fmt::Write as _;
use std::path::Path;
use std::process::Command;

const MODEL: &str = include_str!("../../models/handstand.toml");

/// Random designs and the states of each.
const DESIGNS: usize = 50;
const STATES: u32 = 2000;

/// Numerical Recipes' generator, as in the C program.
struct Random(u32);

impl Random {
    fn next(&mut self) -> u32 {
        self.0 = self.0.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        self.0 >> 16
    }

    fn uniform(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * f64::from(self.next()) / 65536.0
    }
}

fn made() -> Provenance {
    Provenance {
        model: "handstand.toml".into(),
        sha256: "of a test".into(),
        command: "a test */ with an end of comment".into(),
    }
}

fn designed(model: &Model, random: &mut Random) -> Option<(Design, FixedDesign)> {
    let mut decade = |low, high| 10f64.powf(random.uniform(low, high));
    let diagonal = (0..6).map(|_| decade(-2.0, 2.0)).collect();
    let request = Request {
        weights: CostWeights::Given {
            q: Weight::Diagonal(diagonal),
            r: Weight::Scalar(decade(-2.0, 2.0)),
        },
        time: Time::Sampled {
            ts_s: decade(-2.3, -1.8),
            delay_s: Some([0.0, 0.01, 0.013, 0.024][random.next() as usize % 4]),
        },
        ..Request::standard(model)
    };
    let design = Design::of(model, &request).ok()?;
    let fixed = design.fixed.clone()?;
    Some((design, fixed))
}

/// Ends with what the compiler says, if it says anything.
fn silent(command: &mut Command) {
    let ran = command.output().unwrap();
    let said = String::from_utf8_lossy(&ran.stderr);
    assert!(
        ran.status.success() && said.is_empty(),
        "{command:?}: {said}"
    );
}

/// 0 differences in 100 000 states of 50 random designs, all headers in one file: wide integers,
/// the compiled header, and the controller of the simulated loop.
#[test]
fn random_designs_compute_what_the_law_does() {
    let model = Model::parse(MODEL, Path::new("handstand.toml")).unwrap();
    let (bench, mut random) = (Bench::new(), Random(7));
    let (mut main, mut expected) = (String::from("#define GAINS_TEST\n"), String::new());
    let mut calls = String::new();
    let (mut count, mut looped) = (0, 0);
    while count < DESIGNS {
        let Some((design, fixed)) = designed(&model, &mut random) else {
            continue;
        };
        let name = format!("law_{count}");
        bench.put(
            &format!("{name}.h"),
            c_header(&design, &fixed, &made(), &name),
        );
        let _ = writeln!(main, "#include \"{name}.h\"");
        let (n, m) = (design.states.len(), design.inputs.len());
        let _ = write!(
            calls,
            "    if ({name}_check() != 0) return 1;
    for (unsigned k = 0; k < {STATES}; k++) {{
        int16_t x[{n}], u[{m}];
        for (int j = 0; j < {n}; j++) x[j] = (int16_t)((int16_t)next() >> (k % 12));
        {name}_control(x, u);
        for (int i = 0; i < {m}; i++) printf(\"%d\\n\", u[i]);
    }}
"
        );
        let mut states = Random(seed(count));
        let _ = writeln!(calls, "    seed = {}u;", seed(count + 1));
        for k in 0..STATES {
            let word = |word: u32| i64::from((word as u16).cast_signed() >> (k % 12));
            let x: Vec<i64> = (0..n).map(|_| word(states.next())).collect();
            let raw = fixed.law.raw(&x);
            for u in &raw {
                let _ = writeln!(expected, "{u}");
            }
            looped += usize::from(in_the_loop(&design, &fixed, &x) != raw);
        }
        count += 1;
    }
    let _ = write!(
        main,
        "#include <stdio.h>
static uint32_t seed = {}u;
static uint16_t next(void)
{{
    seed = seed * 1664525u + 1013904223u;
    return (uint16_t)(seed >> 16);
}}
int main(void)
{{
{calls}    return 0;
}}
",
        seed(0)
    );
    bench.put("main.c", main);
    let built = bench.path("laws");
    silent(
        Command::new("cc")
            .args(["-std=c99", "-Wall", "-Wextra", "-Werror", "-O1", "-o"])
            .args([&built, &bench.path("main.c")]),
    );
    let ran = Command::new(built).output().unwrap();
    assert!(ran.status.success(), "a golden vector is not met");
    let said = String::from_utf8(ran.stdout).unwrap();
    assert_eq!(said.lines().count(), expected.lines().count());
    let differences = said.lines().zip(expected.lines()).filter(|(a, b)| a != b);
    assert_eq!([differences.count(), looped], [0, 0]);
}

/// Inputs in steps of the controller that a verification puts into the loop, given the states of
/// these steps in SI.
fn in_the_loop(design: &Design, fixed: &FixedDesign, x: &[i64]) -> Vec<i64> {
    let law = FixedPointFeedback::new(fixed.law.clone(), None, &design.x0, 3);
    let steps = x.iter().zip(&fixed.law.state_step);
    let si: Vec<f64> = steps.map(|(x, step)| *x as f64 * step).collect();
    let off = |place: usize| si[place] - design.x0[place];
    let (angle_rad, speed_rad_s): ([f64; 3], [f64; 3]) = (
        std::array::from_fn(off),
        std::array::from_fn(|j| off(3 + j)),
    );
    let (mut memory, mut command) = (si[6..].to_vec(), vec![0.0; design.inputs.len()]);
    let measured = Measurement {
        angle_rad: &angle_rad,
        speed_rad_s: &speed_rad_s,
    };
    law.control(&mut memory, measured, &mut command);
    let steps = command.iter().zip(&fixed.law.input_step);
    steps.map(|(u, step)| (u / step).round() as i64).collect()
}

fn seed(design: usize) -> u32 {
    1 + 7919 * design as u32
}

/// A run of the law with integral action, limits and saturated sums among it: the
/// compiled headers of C and Rust and the controller of the simulated loop, step by step.
#[test]
fn sums_are_kept_as_in_the_simulated_loop() {
    let model = Model::parse(MODEL, Path::new("handstand.toml")).unwrap();
    let request = Request {
        integral: Some(Weight::Diagonal(vec![100.0, 30.0])),
        time: Time::Sampled {
            ts_s: 0.01,
            delay_s: Some(0.0),
        },
        ..Request::standard(&model)
    };
    let design = Design::of(&model, &request).unwrap();
    let fixed = design.fixed.as_ref().unwrap();
    let bench = Bench::new();
    bench.put("law.h", c_header(&design, fixed, &made(), "law"));
    bench.put("law.rs", rust_file(&design, fixed, &made()));
    bench.put("sums.c", SUMS_C);
    bench.put("sums.rs", SUMS_RS);
    let (c, rust) = (bench.path("sums"), bench.path("sums_rs"));
    silent(
        Command::new("cc")
            .args(STRICT)
            .args(["-std=c99", "-O1", "-o"])
            .args([&c, &bench.path("sums.c")]),
    );
    let rustc = std::env::var_os("RUSTC").unwrap_or_else(|| "rustc".into());
    silent(
        Command::new(rustc)
            .args(["--edition", "2024", "-O", "-A", "dead_code", "-o"])
            .args([&rust, &bench.path("sums.rs")]),
    );
    let loops = FixedPointFeedback::new(fixed.law.clone(), fixed.sums.clone(), &design.x0, 3);
    let mut memory = vec![0.0; loops.memory_len()];
    loops.reset(&mut memory);
    let (mut random, mut expected) = (Random(1), String::new());
    let (mut limited, mut largest) = (0, 0.0_f64);
    for k in 0..STEPS {
        // Small departures for long, one way and the other, then large ones: limits act.
        let shift = if k % 500 < 450 { 12 } else { 2 };
        let mut word = || {
            let word = i32::from((random.next() as u16).cast_signed()) >> shift;
            word + if k % 200 < 100 { 6 } else { -6 }
        };
        let raw: [i32; 6] = std::array::from_fn(|i| word() + fixed.law.x0[i] as i32);
        let si = |i: usize| f64::from(raw[i]) * fixed.law.state_step[i] - design.x0[i];
        let (angle_rad, speed_rad_s): ([f64; 3], [f64; 3]) =
            (std::array::from_fn(si), std::array::from_fn(|i| si(3 + i)));
        let measured = Measurement {
            angle_rad: &angle_rad,
            speed_rad_s: &speed_rad_s,
        };
        let mut command = [0.0; 2];
        loops.control(&mut memory, measured, &mut command);
        let u: [i64; 2] =
            std::array::from_fn(|i| (command[i] / fixed.law.input_step[i]).round() as i64);
        limited += usize::from((0..2).any(|i| fixed.law.limits[i].contains(&u[i])));
        largest = largest.max(memory[0].abs());
        let _ = writeln!(expected, "{} {} {} {}", u[0], u[1], memory[0], memory[1]);
    }
    assert!(
        (50..STEPS / 2).contains(&limited) && largest > 500.0,
        "{limited} {largest}"
    );
    for program in [c, rust] {
        let ran = Command::new(&program).output().unwrap();
        let said = String::from_utf8(ran.stdout).unwrap();
        assert!(said == expected, "{program:?}: {said:.300} {expected:.300}");
    }
}

const STEPS: usize = 4000;

const SUMS_C: &str = r#"
#include "law.h"
#include <stdio.h>
static uint32_t seed = 1u;
static uint16_t next(void)
{
    seed = seed * 1664525u + 1013904223u;
    return (uint16_t)(seed >> 16);
}
int main(void)
{
    int16_t x[LAW_STATES] = {0}, u[LAW_INPUTS];
    int32_t sums[LAW_SUMS] = {0};
    for (int k = 0; k < 4000; k++) {
        for (int j = 0; j < 6; j++)
            x[j] = (int16_t)(((int16_t)next() >> (k % 500 < 450 ? 12 : 2)) + (k % 200 < 100 ? 6 : -6)
                             + law_x0[j]);
        law_control(x, u);
        law_integrate(sums, x, u);
        printf("%d %d %ld %ld\n", u[0], u[1], (long)sums[0], (long)sums[1]);
    }
    return 0;
}
"#;

const SUMS_RS: &str = r#"
mod law { include!("law.rs"); }
fn main() {
    let (mut seed, mut x, mut sums) = (1_u32, [0_i16; 8], [0_i32; 2]);
    for k in 0..4000 {
        for (x, x0) in x[..6].iter_mut().zip(law::X0) {
            seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            *x = ((seed >> 16) as u16 as i16) >> if k % 500 < 450 { 12 } else { 2 };
            *x += x0 + if k % 200 < 100 { 6 } else { -6 };
        }
        let u = law::control(&x);
        law::integrate(&mut sums, &mut x, &u);
        println!("{} {} {} {}", u[0], u[1], sums[0], sums[1]);
    }
}
"#;

const TWO: &str = r#"
#define GAINS_TEST
#include "stand.h"
#include "lean.h"
static const float state_steps[STAND_STATES] = STAND_STATE_STEPS;
static const float input_steps[LEAN_INPUTS] = LEAN_INPUT_STEPS;
int main(void)
{
    int16_t x[LEAN_STATES] = {0}, u[LEAN_INPUTS];
    if (STAND_LAYOUT != 1 || STAND_PERIOD_US != 10000UL || STAND_PAST_INPUTS != 0) return 1;
    if (LEAN_PAST_INPUTS != 2 || LEAN_STATES != STAND_STATES + 4) return 2;
    if (!(LEAN_DELAY_S > 0.0129f && LEAN_DELAY_S < 0.0131f && LEAN_PERIOD_S > 0.0f)) return 3;
    if (stand_steps(3.0f * STAND_STATE_STEP_Q1, state_steps[0]) != 3) return 4;
    if (stand_steps(-1e9f, STAND_STATE_STEP_DQ3) != INT16_MIN) return 5;
    if (stand_steps(1e9f, LEAN_STATE_STEP_U2_K1) != INT16_MAX) return 6;
    if (stand_steps(-2.5f * LEAN_INPUT_STEP_U3, input_steps[1]) != -3) return 7;
    u[0] = 11; u[1] = 12;
    lean_remember(x, u);
    u[0] = 21; u[1] = 22;
    lean_remember(x, u);
    if (x[5] != 0 || x[6] != 21 || x[7] != 22 || x[8] != 11 || x[9] != 12) return 8;
    if (STAND_FINGERPRINT == LEAN_FINGERPRINT) return 9;
    return stand_check() != 0 || lean_check() != 0 ? 10 : 0;
}
"#;

fn two_headers() -> Bench {
    let bench = Bench::new();
    bench.put("handstand.toml", MODEL);
    for line in [
        "--name stand --c stand.h",
        "--name lean --delay 0.013 --c lean.h",
    ] {
        let ran = bench.run(&format!("gains handstand.toml {line}"));
        assert_eq!(ran.code, Some(0), "{}", ran.stderr);
    }
    bench.put("two.c", TWO);
    bench.put("two.cpp", TWO);
    bench
}

const STRICT: [&str; 7] = [
    "-Wall",
    "-Wextra",
    "-Wconversion",
    "-Wsign-conversion",
    "-Wundef",
    "-pedantic",
    "-Werror",
];

#[test]
fn two_headers_in_one_file_compile_as_c_and_c_plus_plus_without_a_warning() {
    let bench = two_headers();
    for (compiler, standard, file) in [
        ("cc", "-std=c99", "two.c"),
        ("cc", "-std=c11", "two.c"),
        ("c++", "-std=c++17", "two.cpp"),
    ] {
        let built = bench.path("two");
        silent(
            Command::new(compiler)
                .args(STRICT)
                // The AVR's compiler is often too old for it.
                .arg("-Wunused-const-variable=2")
                .args([standard, "-O2", "-o"])
                .args([&built, &bench.path(file)]),
        );
        let ran = Command::new(&built).status().unwrap();
        assert_eq!(ran.code(), Some(0), "{compiler} {standard}");
    }
}

/// With the tables in flash. What is not there is said on stderr: the AVR's compiler is optional.
#[test]
fn the_avr_s_compiler_takes_it_with_its_tables_in_flash() {
    if Command::new("avr-gcc").arg("--version").output().is_err() {
        eprintln!("skipped: no avr-gcc (`cargo xtask install`)");
        return;
    }
    let bench = two_headers();
    let object = bench.path("two.o");
    for flags in [&["-DGAINS_PROGMEM"][..], &[]] {
        silent(
            Command::new("avr-gcc")
                .args(STRICT)
                .args(["-mmcu=atmega2561", "-std=c99", "-Os", "-c"])
                .args(flags)
                .arg("-o")
                .args([&object, &bench.path("two.c")]),
        );
    }
}

#[test]
fn a_name_that_c_does_not_take_is_refused() {
    let bench = Bench::new();
    bench.put("handstand.toml", MODEL);
    for name in ["2gains", "Gains", "my-gains", "''"] {
        let ran = bench.run(&format!("gains handstand.toml --c a.h --name {name}"));
        assert_eq!(ran.code, Some(2), "{name}: {}", ran.stderr);
        assert!(ran.stderr.contains("a letter first"), "{}", ran.stderr);
    }
}
