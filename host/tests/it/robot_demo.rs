//! The whole circle on a virtual robot: it falls as believed, and stands as learned.

use crate::common::Bench;
use handstand::challenge::unseal;
use handstand::robot_demo::{HiddenRobot, LIMIT_OPTIONS, RobotAnswer, run};

/// Lag and a dead zone, found in the recordings, carried into the plan. One robot: a diagnosis is
/// most of a minute. `cargo xtask robot-demo` runs ten.
#[test]
fn a_robot_that_falls_as_believed_stands_as_learned() {
    const SEED: u64 = 1;
    let folder = tempfile::tempdir().unwrap();
    let demo = run(SEED, folder.path(), &|_| {}).unwrap();
    assert!(!demo.nominal.stands, "{:?}", demo.nominal.end);
    assert!(demo.learned.stands, "{:?}", demo.learned.end);
    assert!(demo.learned.stood_s >= 9.9);
    assert!(demo.named, "{:?} of {:?}", demo.added, demo.effects);
    // Width and punch of a dead zone are told together only; the lag stands alone.
    let lag = &demo.effects[0];
    let off = (lag.estimate.expect("found") - lag.true_value).abs();
    assert!(off < 0.25 * lag.true_value, "{lag:?}");
    let read = |name: &str| std::fs::read_to_string(folder.path().join(name)).unwrap();
    let answer: RobotAnswer = unseal(&read("answer.sealed")).unwrap();
    assert_eq!(answer, HiddenRobot::draw(SEED).unwrap().answer);
    // Nothing of the truth lies about but the seal.
    for name in ["nominal.toml", "goals_a.csv", "a.csv", "b.csv", "c.csv"] {
        assert!(!read(name).contains("delay"), "{name}");
    }
    assert!(read("learned.toml").contains("kind = \"delay\""));
    let page = read("page.html");
    assert!(
        page.contains("Model as believed: falls"),
        "the first attempt"
    );
    assert!(page.contains("Model as learned: stands"), "the second");
    // The command that it prints makes the plan that stood, and says so beforehand.
    let bench = Bench::new();
    bench.put("learned.toml", read("learned.toml"));
    let line = format!("deploy learned.toml --dry-run --states 1 --json {LIMIT_OPTIONS}");
    let ran = bench.run(&line);
    assert_eq!(ran.code, Some(0), "{ran:?}");
    assert_eq!(ran.json()["fingerprint"], demo.learned.fingerprint);
}
