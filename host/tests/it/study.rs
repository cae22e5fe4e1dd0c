//! `handstand study` from outside: killed, sharded, merged.

use crate::common::Bench;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

/// Ten chunks.
const STUDY: &str = "
[runs]
count = 2500
length_s = 0.5

[[uncertain]]
what = \"mass\"
size = 0.1
";

fn bench() -> Bench {
    let bench = Bench::new();
    bench.put("study.toml", STUDY);
    bench
}

/// Waits until the journal is longer than `bytes`, then kills the program outright; whether it got
/// that far.
fn killed_beyond(bench: &Bench, bytes: u64) -> bool {
    let mut child = Command::new(env!("CARGO_BIN_EXE_handstand"))
        .args(["study", "monte-carlo", "study.toml", "-o", "killed"])
        .current_dir(bench.path(""))
        .env("RAYON_NUM_THREADS", "1")
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    let journal = bench.path("killed/shard-1-of-1.journal");
    let begun = Instant::now();
    let mut reached = false;
    while !reached && child.try_wait().unwrap().is_none() {
        assert!(begun.elapsed() < Duration::from_secs(60), "it stands still");
        reached = std::fs::metadata(&journal).is_ok_and(|file| file.len() > bytes);
        std::thread::sleep(Duration::from_millis(2));
    }
    child.kill().unwrap(); // SIGKILL
    child.wait().unwrap();
    reached
}

#[test]
fn a_killed_study_goes_on_and_ends_in_the_same_bytes() {
    let bench = bench();
    let whole = bench.run("study monte-carlo study.toml -o whole");
    assert_eq!(whole.code, Some(0), "{whole:?}");
    assert!(
        whole.stdout.contains("of 2500 runs are stabilised"),
        "{whole:?}"
    );
    let length = std::fs::metadata(bench.path("whole/shard-1-of-1.journal"))
        .unwrap()
        .len();
    let mut kills = 0;
    for share in [1, 3, 5, 7] {
        kills += usize::from(killed_beyond(&bench, length * share / 10));
    }
    assert!(kills >= 2, "it was killed on its way {kills} times only");
    assert!(!bench.path("killed/runs.csv").exists());
    let rest = bench.run("study monte-carlo study.toml -o killed");
    assert_eq!(rest.code, Some(0), "{rest:?}");
    assert!(rest.stderr.contains("are done already"), "{rest:?}");
    for file in ["runs.csv", "summary.json", "stabilised.svg"] {
        let (one, other) = (format!("whole/{file}"), format!("killed/{file}"));
        assert_eq!(bench.get(&one), bench.get(&other), "{file}");
    }
    // Once more is no work and no harm.
    let again = bench.run("study monte-carlo study.toml -o killed");
    assert_eq!(again.code, Some(0), "{again:?}");
    assert!(
        again.stderr.contains("10 of 10 chunks are done already"),
        "{again:?}"
    );
}

#[test]
fn shards_are_merged_and_what_is_missing_is_listed() {
    let bench = bench();
    for shard in ["3/3", "1/3"] {
        let ran = bench.run(&format!(
            "study monte-carlo study.toml -o shards --shard {shard}"
        ));
        assert_eq!(ran.code, Some(0), "{ran:?}");
    }
    let lacking = bench.run("study merge shards -o merged");
    assert_eq!(lacking.code, Some(1), "{lacking:?}");
    assert!(lacking.stdout.contains("runs 256 to 511"), "{lacking:?}");
    assert!(!bench.path("merged").exists());
    let lacking = bench.run("study merge shards -o merged --json");
    assert_eq!(lacking.json()["missing"][0]["first_run"], 256);
    assert_eq!(lacking.json()["complete"], false);

    bench.run("study monte-carlo study.toml -o shards --shard 2/3");
    let merged = bench.run("study merge shards -o merged --json");
    assert_eq!(merged.code, Some(0), "{merged:?}");
    assert_eq!(merged.json()["summary"]["runs"], 2500);
    bench.run("study monte-carlo study.toml -o whole");
    assert_eq!(bench.get("merged/runs.csv"), bench.get("whole/runs.csv"));

    let other = bench.run("study monte-carlo study.toml -o shards --shard 2/3 --seed 5");
    assert_eq!(other.code, Some(3), "{other:?}");
    assert!(other.stderr.contains("another study"), "{other:?}");
    let nothing = bench.run("study merge whole/runs.csv -o elsewhere");
    assert_eq!(nothing.code, Some(3), "{nothing:?}");
    let wrong = bench.run("study monte-carlo study.toml -o shards --shard 4/3");
    assert_eq!(wrong.code, Some(2), "{wrong:?}");
}

#[test]
fn a_sweep_leaves_a_table_and_a_plot_and_overwrites_nothing() {
    let bench = bench();
    let line = "study sweep delay --levels 0,8,20 --runs 12 -o plots";
    let ran = bench.run(line);
    assert_eq!(ran.code, Some(0), "{ran:?}");
    let table = bench.get("plots/delay.csv");
    let stabilised: Vec<&str> = table
        .lines()
        .skip(1)
        .map(|row| row.split(',').nth(3).unwrap())
        .collect();
    assert_eq!(stabilised, ["12", "12", "0"], "{table}");
    assert!(bench.get("plots/delay.svg").starts_with("<svg"));
    assert_eq!(bench.run(line).code, Some(2));
    let forced = bench.run(&format!("{line} --force --json"));
    assert_eq!(forced.json()[0]["levels"][2]["figures"]["stabilised"], 0);
    assert_eq!(bench.get("plots/delay.csv"), table);
    assert_eq!(bench.run("study sweep delai").code, Some(2));
    let listed = bench.run("study sweep --json").json();
    assert_eq!(listed.as_array().unwrap().len(), 10);
}

#[test]
fn a_sweep_without_any_controller_is_an_error() {
    let bench = bench();
    bench.put("unfit.toml", "[robot]\nmodel = \"model.toml\"\n");
    let ran = bench.run("study sweep delay --study unfit.toml --levels 0,5 --runs 2");
    assert_eq!(ran.code, Some(3), "{ran:?}");
    let said = "no level of delay has a controller: no joint of `pendulum` is driven";
    assert!(ran.stderr.contains(said), "{}", ran.stderr);
}
