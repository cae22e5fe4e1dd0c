//! What LeRobot's code read, in tables that are none of its data sets.

use super::dataset::{Dataset, Written, calibration, simulated};
use super::{assert_right, done, names};
use crate::common::Bench;

/// What LeRobot's code read may stand in any table: its owner says in which unit.
#[test]
fn per_cent_in_a_plain_table_are_angles() {
    let bench = Bench::new();
    let angles = simulated(&bench.path(""));
    let table = |unit| Dataset::of("v3.0", names(), &angles, unit).table();
    bench.put("percent.csv", table(Written::Percent));
    bench.put("deg.csv", table(Written::Degrees));
    let calibrated = serde_json::to_vec(&calibration()).unwrap();
    bench.put("c.json", calibrated);
    let init = "init percent.csv --robot robot.urdf --unit percent --calibration c.json";
    let told = done(bench.run(&format!("{init} -o percent.toml"))).stderr;
    assert!(
        told.contains("per cent of each joint's calibrated range (as you say)"),
        "{told}"
    );
    assert_right(&bench, "percent.toml", "percent.csv");
    let of_deg = "init deg.csv --robot robot.urdf --unit deg --calibration c.json -o deg.toml";
    done(bench.run(of_deg));
    assert_right(&bench, "deg.toml", "deg.csv");
    // Degrees of all joints, a gripper's too.
    let told = done(bench.run("init deg.csv --robot robot.urdf --unit deg -o own.toml")).stderr;
    assert!(told.contains("angles: in deg (as you say)"), "{told}");
    assert_eq!(bench.get("own.toml").matches("unit = \"deg\"").count(), 6);

    let ran = bench.run("init percent.csv --robot robot.urdf --unit percent");
    assert_eq!(ran.code, Some(2), "{ran:?}");
    assert!(ran.stderr.contains("--calibration FILE.json"), "{ran:?}");
    let table = table(Written::Percent).replacen("\n0,", "\n0,1", 1);
    bench.put("percent.csv", table);
    let ran = bench.run(&format!("{init} -o p.toml"));
    assert_eq!(ran.code, Some(3), "{ran:?}");
    assert!(
        ran.stderr.contains("percent.csv") && ran.stderr.contains("beyond the -100 to 100"),
        "{ran:?}"
    );
}
