//! A diagnosis that is ended before it is done says so, and answers.

use crate::common::Bench;

#[test]
fn a_limit_of_time_is_in_the_answer() {
    let bench = Bench::new();
    let ended = bench.run("diagnose model.toml a.csv --holdout b.csv --within 1ms");
    assert_eq!(ended.code, Some(2), "{ended:?}");
    assert!(ended.stderr.contains("give seconds (60s)"), "{ended:?}");

    // Less than the model itself takes: nothing is searched.
    let ended = bench.run("diagnose model.toml a.csv --holdout b.csv --within 0.001s --json");
    assert_eq!(ended.code, Some(0), "{ended:?}");
    let said = ended.json();
    assert_eq!(said["search_ended"], "time");
    assert_eq!(said["verdict"], "unexplained");
    let summary = said["summary"][1].as_str().unwrap();
    assert!(summary.contains("at its limit of time"), "{summary}");
    assert_eq!(said["left_out"][0], "part of the single effects");

    let whole = bench.run("diagnose model.toml a.csv --holdout b.csv --within 1h --json");
    assert_eq!(whole.json()["search_ended"], "complete");
    assert_eq!(whole.json()["left_out"].as_array().unwrap().len(), 0);
}
