//! Data sets that are not as LeRobot writes them: refused with file, key, what was found, remedy.

use super::dataset::{Written, calibration, list};
use super::{bench, done, names};
use crate::common::Bench;
use handstand::log::{LogRequest, RawLog, unfolded};
use serde_json::{Value, json};

const INIT: &str = "init d --robot robot.urdf --unit rad";
const COMPARE: &str = "compare m.toml d";

/// A data set in rad, and a model of it.
fn good(version: &'static str) -> Bench {
    let bench = bench(version, names(), Written::Rad);
    done(bench.run("init d --robot robot.urdf -o m.toml"));
    bench
}

/// What the commands say of a data set whose description was changed so.
fn refused(bench: &Bench, key: &str, value: Option<Value>, command: &str, words: &[&str]) {
    let info = bench.get("d/meta/info.json");
    let mut changed: Value = serde_json::from_str(&info).unwrap();
    let mut place = &mut changed;
    let (inner, last) = key.rsplit_once('/').unwrap_or(("", key));
    for step in inner.split('/').filter(|step| !step.is_empty()) {
        place = &mut place[step];
    }
    match value.clone() {
        Some(value) => place[last] = value,
        None => drop(place.as_object_mut().unwrap().remove(last)),
    }
    bench.put("d/meta/info.json", changed.to_string());
    let ran = bench.run(command);
    bench.put("d/meta/info.json", info);
    let what = format!("{key} = {value:?}");
    assert_eq!(ran.code, Some(3), "{what}: {ran:?}");
    assert!(ran.stderr.contains("d/meta/info.json"), "{what}: {ran:?}");
    assert!(ran.stderr.contains("help: "), "{what}: {ran:?}");
    for word in words {
        assert!(ran.stderr.contains(word), "{what}: {word}: {ran:?}");
    }
}

#[test]
fn a_description_that_is_none_is_refused() {
    let bench = good("v2.1");
    let info = bench.get("d/meta/info.json");
    for (text, words) in [
        ("", "no JSON"),
        ("{\"codebase_version\": ", "no JSON"),
        ("\u{feff}{}", "no JSON"),
        ("[1, 2]", "codebase_version: nothing"),
        ("null", "codebase_version: nothing"),
        ("{}", "codebase_version: nothing"),
    ] {
        bench.put("d/meta/info.json", text);
        for command in [COMPARE, INIT, "log check m.toml d", "log plot d", "init d"] {
            let ran = bench.run(command);
            assert_eq!(ran.code, Some(3), "{command}: {text}: {ran:?}");
            assert!(
                ran.stderr.contains("d/meta/info.json"),
                "{command}: {text}: {ran:?}"
            );
            assert!(ran.stderr.contains(words), "{command}: {text}: {ran:?}");
        }
    }
    // Nested as deep as no description is.
    bench.put("d/meta/info.json", "[".repeat(100_000));
    assert_eq!(bench.run(COMPARE).code, Some(3));
    bench.put("d/meta/info.json", info);
    done(bench.run(COMPARE));
}

/// Key, value, and what is said of it.
type Case<'a> = (&'a str, Option<Value>, &'a [&'a str]);

/// What must not stand in place of where the episodes are.
const PATHS: [(&str, &str); 7] = [
    (
        "../d/data/chunk-000/episode_{episode_index:06d}.parquet",
        "leads out of the folder",
    ),
    ("/etc/{episode_index}.parquet", "leads out of the folder"),
    ("data/{episode_index.a}.parquet", "a field"),
    ("data/{episode_index:9999d}.parquet", "a field"),
    ("data/{episode_index", "not closed"),
    ("data/all.parquet", "one file for all"),
    ("data/{episode_index}.csv", "another ending"),
];

#[test]
fn paths_must_stay_within_the_folder() {
    let bench = good("v2.1");
    let usual = "usually data/chunk-";
    for (path, why) in PATHS {
        refused(
            &bench,
            "data_path",
            Some(json!(path)),
            COMPARE,
            &["data_path: ", why, usual],
        );
    }
    for (value, found) in [(None, "nothing"), (Some(json!(["data"])), "a list of 1")] {
        refused(
            &bench,
            "data_path",
            value,
            COMPARE,
            &["data_path: ", found, usual],
        );
    }
}

#[test]
fn as_many_episodes_must_be_there_as_are_declared() {
    let bench = good("v2.1");
    let cases: [Case; 10] = [
        (
            "codebase_version",
            Some(json!("v1.6")),
            &["\"v1.6\"", "v2.0, v2.1, v3.0"],
        ),
        (
            "codebase_version",
            Some(json!(2.1)),
            &["codebase_version: 2.1"],
        ),
        ("total_episodes", None, &["total_episodes: nothing"]),
        ("total_episodes", Some(json!(0)), &["total_episodes: 0"]),
        ("total_episodes", Some(json!(-3)), &["total_episodes: -3"]),
        (
            "total_episodes",
            Some(json!("3")),
            &["total_episodes: \"3\""],
        ),
        (
            "total_episodes",
            Some(json!(5_000_000)),
            &["5000000", "at most 10000"],
        ),
        (
            "total_episodes",
            Some(json!(1e300)),
            &["total_episodes: 1e"],
        ),
        (
            "total_episodes",
            Some(json!(4)),
            &["episode_000003.parquet", "is not there"],
        ),
        ("chunks_size", Some(json!(0)), &["chunks_size: 0"]),
    ];
    for (key, value, words) in cases {
        refused(&bench, key, value, COMPARE, words);
    }
    std::fs::remove_file(bench.path("d/data/chunk-000/episode_000001.parquet")).unwrap();
    let ran = bench.run(COMPARE);
    assert_eq!(ran.code, Some(3), "{ran:?}");
    assert!(
        ran.stderr
            .contains("episode_000001.parquet, which is not there"),
        "{ran:?}"
    );
    bench.put("d/data/chunk-000/episode_000001.parquet", "PAR1");
    assert_eq!(bench.run(COMPARE).code, Some(3));
}

#[test]
fn files_of_several_episodes_must_be_listed() {
    let bench = good("v3.0");
    let listed = bench.path("d/meta/episodes/chunk-000/file-000.parquet");
    refused(
        &bench,
        "total_episodes",
        Some(json!(7)),
        COMPARE,
        &["7, but meta/episodes lists 3"],
    );
    for (files, name, words) in [
        (&[0, 1, 1][..], "data/file", "no column \"data/file_index\""),
        (
            &[0, 0, 2],
            "data/file_index",
            "file-002.parquet, which is not there",
        ),
        (&[0, 0, 2_000_000], "data/file_index", "no number of a file"),
        (&[0, 0, -1], "data/file_index", "no number of a file"),
    ] {
        list(&listed, files, name).unwrap();
        let ran = bench.run(COMPARE);
        assert_eq!(ran.code, Some(3), "{words}: {ran:?}");
        assert!(ran.stderr.contains(words), "{words}: {ran:?}");
    }
    std::fs::write(&listed, "PAR1").unwrap();
    assert_eq!(bench.run(COMPARE).code, Some(3));
    std::fs::remove_file(&listed).unwrap();
    let ran = bench.run(COMPARE);
    assert_eq!(ran.code, Some(3), "{ran:?}");
    assert!(
        ran.stderr
            .contains("meta/episodes/chunk-000/file-000.parquet"),
        "{ran:?}"
    );
}

#[test]
fn names_must_be_names_of_the_elements() {
    let bench = good("v3.0");
    let (state, path) = (
        "features/observation.state",
        "features[\"observation.state\"]",
    );
    let shape = format!("{path}.shape");
    let names = format!("{path}.names");
    let two_lists = json!({"left": ["a"], "right": ["b", "c"]});
    let cases: [Case; 14] = [
        ("", None, &["features: nothing"]),
        ("", Some(json!([])), &["features: a list of 0"]),
        ("/shape", None, &[&shape, "nothing"]),
        ("/shape", Some(json!([3, 2])), &[&shape, "a list of 2"]),
        ("/shape", Some(json!("3")), &[&shape, "\"3\""]),
        ("/shape", Some(json!([0])), &[&shape]),
        ("/shape", Some(json!([1e12])), &[&shape]),
        ("/shape", Some(json!([5])), &[&shape, "[5]", "3 elements"]),
        (
            "/names",
            Some(json!(["shoulder_pan.pos"])),
            &[&names, "each of 3"],
        ),
        (
            "/names",
            Some(json!(["a", "a", "b"])),
            &[&names, "each of 3"],
        ),
        ("/names", Some(json!({"motors": {"a": ["b"]}})), &[&names]),
        ("/names", Some(two_lists), &[&names, "an object of 2 keys"]),
        ("/names", Some(json!([1, 2, 3])), &[&names, "a list of 3"]),
        ("/names", Some(json!("motors")), &[&names, "\"motors\""]),
    ];
    for (key, value, words) in cases {
        let key = if key.is_empty() {
            "features".into()
        } else {
            format!("{state}{key}")
        };
        refused(&bench, &key, value, INIT, words);
    }
    // A comparison needs no names.
    let info = bench.get("d/meta/info.json");
    let mut changed: Value = serde_json::from_str(&info).unwrap();
    changed["features"] = Value::Null;
    bench.put("d/meta/info.json", changed.to_string());
    done(bench.run(COMPARE));
    // The place of each name is as good as a list.
    let mut places: Value = serde_json::from_str(&info).unwrap();
    let own = json!({"gripper.pos": 2, "shoulder_lift.pos": 1, "shoulder_pan.pos": 0});
    places["features"]["observation.state"]["names"] = own;
    bench.put("d/meta/info.json", places.to_string());
    done(bench.run(INIT));
}

/// How a good calibration is spoiled.
type Change<'a> = &'a dyn Fn(&mut Value);

#[test]
fn a_calibration_must_be_the_robots() {
    let bench = bench("v3.0", names(), Written::Percent);
    let init = "init d --robot robot.urdf --unit percent --calibration c.json";
    let put = |change: &dyn Fn(&mut Value)| {
        let mut own = calibration();
        change(&mut own);
        bench.put("c.json", own.to_string());
        bench.run(init)
    };
    done(put(&|_| ()));
    let pan = |key: &'static str, value: Value| {
        move |own: &mut Value| own["shoulder_pan"][key] = value.clone()
    };
    let cases: [(Change, &str); 7] = [
        (&|own| *own = json!([]), "not an object of servos"),
        (&|own| *own = json!({}), "not an object of servos"),
        (
            &|own| own["shoulder_pan"] = json!(3),
            "shoulder_pan.drive_mode: nothing",
        ),
        (&pan("drive_mode", json!(2)), "shoulder_pan.drive_mode: 2"),
        (&pan("range_min", json!(3300)), "a range from 3300 to 3300"),
        (&pan("range_max", json!(1e9)), "shoulder_pan.range_max: 1"),
        (
            &pan("range_max", json!("3300")),
            "shoulder_pan.range_max: \"3300\"",
        ),
    ];
    for (change, words) in cases {
        let ran = put(change);
        assert_eq!(ran.code, Some(3), "{words}: {ran:?}");
        assert!(
            ran.stderr.contains("c.json") && ran.stderr.contains(words),
            "{words}: {ran:?}"
        );
        assert!(ran.stderr.contains("lerobot-calibrate"), "{ran:?}");
    }
    bench.put("c.json", "{");
    assert_eq!(bench.run(init).code, Some(3));
    let ran = put(&|own| drop(own.as_object_mut().unwrap().remove("gripper")));
    assert_eq!(ran.code, Some(2), "{ran:?}");
    assert!(ran.stderr.contains("no joint named gripper"), "{ran:?}");
}

/// No description makes the program panic, whatever stands at one place of it.
#[test]
fn no_damaged_description_panics() {
    let bench = good("v3.0");
    let info = bench.get("d/meta/info.json").into_bytes();
    for at in 0..info.len() {
        for other in [b'0', b'"', b'}', b'{', 0xff] {
            let mut damaged = info.clone();
            damaged[at] = other;
            bench.put("d/meta/info.json", &damaged);
            let request = LogRequest::whole(bench.path("d"));
            // Either is right: what matters is that it comes back.
            let _ = unfolded(&[request]);
            if other == b'0' && at % 7 == 0 {
                let _ = RawLog::read(&bench.path("d"));
            }
        }
    }
}
