//! Weights that `handstand gains` takes by itself, and those that it looks for.

use crate::common::Bench;
use serde_json::Value;
use std::path::Path;

fn model(name: &str) -> String {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("models");
    file.join(name).display().to_string()
}

/// Servos with friction: weights that leave no margin do not hold the robot behind them.
#[test]
fn weights_by_the_ranges_hold_what_the_paper_s_do_not() {
    let bench = Bench::new();
    let robot = model("robot.toml");
    let own = bench.run(&format!("gains {robot} --json"));
    assert_eq!(own.code, Some(0), "{own:?}");
    let own = own.json();
    let weights = |which: &str, at: usize| own[which][at][at].as_f64().unwrap();
    assert_eq!((weights("q", 0), weights("q", 5)), (4.0, 0.01));
    let limit_rad = own["fixed"]["input_range"][1].as_f64().unwrap();
    assert_eq!(weights("r", 1), 1.0 / limit_rad.powi(2));

    let paper = bench.run(&format!("gains {robot} --q 100 --json"));
    assert_eq!(paper.code, Some(1), "{paper:?}");
    assert!(paper.stderr.contains("--tune"), "{}", paper.stderr);
    let paper = paper.json();
    assert_eq!(
        (&paper["q"][5][5], &paper["r"][1][1]),
        (&100.0.into(), &1.0.into())
    );
    let disk = |of: &Value| of["margins"]["inputs"]["disk"]["alpha"].as_f64().unwrap();
    assert!(disk(&own) > 0.8 && disk(&paper) < 0.05);

    let both = bench.run(&format!("gains {robot} --q 100 --r 1 --json"));
    assert_eq!(both.json()["k"], paper["k"]);
    let ranges = bench.run(&format!("gains {robot} --range 1,1,1,10,10,10 --json"));
    assert_eq!(ranges.json()["q"][0][0], 1.0);
}

#[test]
fn tuned_weights_are_no_worse_than_plain_ones() {
    let bench = Bench::new();
    let robot = model("handstand.toml");
    let tuned = bench.run(&format!("gains {robot} --tune --json"));
    assert_eq!(tuned.code, Some(0), "{tuned:?}");
    let found = tuned.json();
    let tried = &found["tuned"]["tried"];
    let figures =
        |place: usize| ["region_rad", "disk_margin"].map(|key| tried[place][key].as_f64().unwrap());
    let chosen = found["tuned"]["chosen"].as_u64().unwrap() as usize;
    let ([by_range, paper], chosen) = ([figures(0), figures(1)], figures(chosen));
    // The paper's weights have the larger region and the smaller margin.
    assert!(paper[0] > by_range[0] && paper[1] < by_range[1]);
    assert!(
        chosen[0] >= paper[0] && chosen[1] > paper[1] + 0.3,
        "{chosen:?}"
    );
    assert_eq!(found["verification"]["region_rad"], chosen[0]);

    // The options that it names are the design.
    let said = tuned
        .stderr
        .split(" weights: ")
        .nth(1)
        .expect("a line of weights");
    let options = said.split(": ").next().unwrap();
    let again = bench.run(&format!("gains {robot} {options} --json"));
    assert_eq!(again.json()["k"], found["k"]);
}

#[test]
fn weights_that_are_none_are_refused() {
    let bench = Bench::new();
    let robot = model("handstand.toml");
    for (options, said) in [
        ("--r 4", "--q <WEIGHT>"),
        ("--range 0,1,1,1,1,1", "range"),
        ("--range 1,1", "6 are needed"),
        ("--limit -2", "range"),
        ("--tune --q 100", "cannot be used with"),
    ] {
        let refused = bench.run(&format!("gains {robot} {options}"));
        assert_eq!(refused.code, Some(2), "{options}: {refused:?}");
        assert!(
            refused.stderr.contains(said),
            "{options}: {}",
            refused.stderr
        );
    }
}
