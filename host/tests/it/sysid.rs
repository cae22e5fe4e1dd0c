//! `identify` and `map` on logs whose truth is known.

use crate::common::{Bench, Ran};
use handstand::sysid::generate::{noise, paper_noise_model, pseudo_random};
use std::fmt::Write as _;

const COLUMNS: &str = "--time t=s --input goal=rad/s --output angle=rad";

/// Angles of the paper's servo, told plus and minus `size` rad/s by lot, and stepped by
/// `resolution_rad`.
fn log(samples: usize, size: f64, resolution_rad: f64, seed: u64) -> String {
    let goal: Vec<f64> = pseudo_random(samples, 12, seed)
        .iter()
        .map(|u| size * u)
        .collect();
    let speed = paper_noise_model().respond(&goal, 0.02, seed);
    let mut text = String::from("t,goal,angle\n");
    let mut angle = 0.0;
    for (t, (speed, goal)) in speed.iter().zip(&goal).enumerate() {
        angle += 0.01 * speed;
        let seen = match resolution_rad {
            0.0 => angle,
            step => (angle / step).round() * step,
        };
        let _ = writeln!(text, "{:.2},{goal},{seen}", 0.01 * t as f64);
    }
    text
}

fn holds(known: &serde_json::Value, truth: f64) -> bool {
    let end = |key: &str| known[key].as_f64().unwrap();
    end("low") <= truth && truth <= end("high")
}

fn done(ran: Ran) -> serde_json::Value {
    assert_eq!(ran.code, Some(0), "{ran:?}");
    ran.json()
}

#[test]
fn identify_finds_the_papers_servo_in_a_position_log() {
    let bench = Bench::new();
    bench.put("a.csv", log(3000, 4.0, 0.0, 1));
    bench.put("b.csv", log(2000, 4.0, 0.0, 2));
    let found = done(bench.run(&format!(
        "identify a.csv --validate b.csv {COLUMNS} --orders bj:1-2,1-2,1,1-3,1 --orders oe:1,2,1 --json"
    )));
    let kept = &found["kept"];
    assert_eq!(kept["orders"], "bj:1,2,1,2,1");
    assert_eq!(found["trials"].as_array().unwrap().len(), 13);
    let truth = [0.06217, -0.6, 0.2, -0.7, -1.469, 0.5544];
    for (coefficient, truth) in kept["coefficients"].as_array().unwrap().iter().zip(truth) {
        assert!(holds(coefficient, truth), "{coefficient} {truth}");
    }
    assert!(holds(&kept["dynamics"]["gain"], 0.06217 / 0.0854));
}

/// Steps of 0.29 degrees at 100 Hz are steps of 0.5 rad/s in the estimated speed.
#[test]
fn identify_bears_a_coarse_encoder() {
    let bench = Bench::new();
    bench.put("a.csv", log(6000, 5.0, 0.00511, 3));
    let found = done(bench.run(&format!(
        "identify a.csv {COLUMNS} --orders bj:1,2,1,2,1 --json"
    )));
    let gain = &found["kept"]["dynamics"]["gain"];
    assert!(holds(gain, 0.06217 / 0.0854), "{gain}");
}

#[test]
fn identify_says_what_it_lacks() {
    let bench = Bench::new();
    bench.put("a.csv", log(300, 4.0, 0.0, 1));
    let gap = log(300, 4.0, 0.0, 1).replacen("\n1.00,", "\n# gone\n#", 1);
    bench.put("gap.csv", gap);
    bench.put("still.csv", log(300, 0.0, 1.0, 1));
    for (line, code, word) in [
        ("identify a.csv".to_string(), 2, "--input"),
        (
            "identify a.csv --model model.toml".to_string(),
            2,
            "0 driven joints",
        ),
        (
            format!("identify a.csv {COLUMNS} --orders bj:1,2"),
            2,
            "2 orders",
        ),
        (
            format!("identify a.csv {COLUMNS} --validate a.csv"),
            2,
            "held out",
        ),
        (
            format!("identify a.csv {COLUMNS} --split 1.5"),
            2,
            "between 0 and 1",
        ),
        (format!("identify gap.csv {COLUMNS}"), 3, "apart"),
        (
            format!("identify still.csv {COLUMNS} --orders oe:1,1,1"),
            1,
            "",
        ),
    ] {
        let ran = bench.run(&line);
        assert_eq!(ran.code, Some(code), "{line}: {ran:?}");
        assert!(ran.stderr.contains(word), "{line}: {ran:?}");
    }
}

/// A slow sine through a dead zone of 8.5 % and on to full speed at 100 %.
#[test]
fn map_finds_the_dead_zone_of_a_ramp() {
    let bench = Bench::new();
    let jitter = noise(8000, 0.0005, 5);
    let mut text = String::from("t,command,angle\n");
    let mut angle: f64 = 0.0;
    for (k, jitter) in jitter.iter().enumerate() {
        let command = 60.0 * (0.00157 * k as f64).sin();
        let seen = ((angle + jitter) / 0.00511).round() * 0.00511;
        let _ = writeln!(text, "{:.2},{command},{seen}", 0.01 * k as f64);
        let beyond = f64::max(command.abs() - 8.5, 0.0) / 91.5;
        angle += 0.01 * (11.9 * beyond).copysign(command);
    }
    bench.put("ramp.csv", text);
    let line = "map dead-zone ramp.csv --time t=s --input command=% --output angle=rad";
    let found = done(bench.run(&format!("{line} --json")));
    for side in ["up", "down"] {
        assert!(holds(&found[side]["edge"], 0.085), "{}", found[side]);
        assert!(
            holds(&found[side]["slope"], 11.9 / 0.915),
            "{}",
            found[side]
        );
    }
    let said = bench.run(line);
    assert!(said.stdout.contains("Turned round"), "{said:?}");
}

#[test]
fn map_finds_the_supply_at_which_the_speed_is_right() {
    let bench = Bench::new();
    let scatter = noise(6000, 0.05, 8);
    let mut text = String::from("t,goal,angle,volts\n");
    let mut angle: f64 = 0.0;
    for (k, scatter) in scatter.iter().enumerate() {
        let volts = 8.0 + 3.5 * k as f64 / 6000.0;
        let goal = [4.0, -4.0, 5.0, -5.0][(k / 300) % 4];
        let _ = writeln!(text, "{:.2},{goal},{angle},{volts}", 0.01 * k as f64);
        angle += 0.01 * goal * (1.0 + 0.1 * (volts - 9.8) + scatter);
    }
    bench.put("volts.csv", text);
    let line = format!("map supply volts.csv {COLUMNS} --supply volts=V --json");
    let found = done(bench.run(&line));
    assert!(holds(&found["error_per_v"], 0.1), "{found}");
    assert!(holds(&found["right_at_v"], 9.8), "{found}");
    let refused = bench.run(&format!("map supply volts.csv {COLUMNS}"));
    assert_eq!(refused.code, Some(1), "{refused:?}");
}
