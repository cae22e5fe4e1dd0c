//! Logs that are broken, and one that is not.

use crate::common::Bench;

/// What is done to a log, and what a fit has to say of it.
type Harm = (&'static str, fn(&str) -> Vec<u8>, &'static str);

const HARMS: &[Harm] = &[
    (
        "a column is missing",
        |log| log.replace("angle_rad", "angle").into(),
        "bad.csv:1",
    ),
    (
        "not a number",
        |log| log.replacen("0.03,", "0.03,nan", 1).into(),
        "bad.csv:5:2: ",
    ),
    (
        "words",
        |log| log.replacen("0.03,", "0.03,x", 1).into(),
        "bad.csv:5:2: ",
    ),
    (
        "time goes backwards",
        |log| log.replacen("\n0.03,", "\n0.01,", 1).into(),
        "bad.csv:5:1: time",
    ),
    (
        "time jumps",
        |log| log.replacen("\n0.03,", "\n0.03,0\n1e9,", 1).into(),
        "bad.csv:6:1: time jumps",
    ),
    (
        "ragged",
        |log| log.replacen("\n0.03,", "\n0.03,1,", 1).into(),
        "bad.csv:5",
    ),
    (
        "no header",
        |log| log.replacen("time_s,angle_rad\n", "", 1).into(),
        "bad.csv:1",
    ),
    ("empty", |_| Vec::new(), "bad.csv"),
    (
        "header only",
        |_| b"time_s,angle_rad\n".to_vec(),
        "bad.csv: the log holds no sample",
    ),
    (
        "too short",
        |log| log.lines().take(5).collect::<Vec<_>>().join("\n").into(),
        "10 are the least",
    ),
    (
        "not UTF-8",
        |log| [log.as_bytes(), b"4.00,\xff\n"].concat(),
        "bad.csv:402",
    ),
];

#[test]
fn a_bad_log_is_named_by_line_and_column_and_nothing_is_written() {
    let bench = Bench::new();
    for (name, harm, said) in HARMS {
        bench.put("bad.csv", harm(&bench.get("a.csv")));
        let ran = bench.run("fit model.toml bad.csv --free link1.com_m -o new.toml");
        assert_eq!(ran.code, Some(3), "{name}: {ran:?}");
        assert!(ran.stderr.contains(said), "{name}: {}", ran.stderr);
        assert!(ran.stderr.contains("help:"), "{name}: {}", ran.stderr);
        assert!(!bench.path("new.toml").exists(), "{name}");
        let check = bench.run("log check model.toml bad.csv --json");
        assert_eq!(check.code, Some(1), "{name}: {check:?}");
        assert_eq!(check.json()["verdict"], "refused", "{name}");
    }
}

#[test]
fn one_remedy_of_many_rows_is_said_once() {
    let bench = Bench::new();
    let broken = bench.get("a.csv").replace(",0.", ",x");
    bench.put("bad.csv", broken);
    let found = bench.run("diagnose model.toml bad.csv --json").json();
    assert_eq!(found["verdict"], "unfit", "{found}");
    let next = found["next"].as_array().unwrap();
    let cell = |next: &&serde_json::Value| next.as_str().unwrap().contains("delete the line");
    assert_eq!(next.iter().filter(cell).count(), 1, "{next:#?}");
}

#[test]
fn a_number_that_no_sensor_gives_is_refused_by_every_command() {
    let bench = Bench::new();
    let mut lines: Vec<String> = bench.get("a.csv").lines().map(str::to_string).collect();
    lines[200] = "1.99,1e200".into();
    bench.put("huge.csv", lines.join("\n"));
    let driven = lines.iter().enumerate().map(|(k, line)| match k {
        0 => format!("{line},u\n"),
        _ => format!("{line},{}\n", k % 7),
    });
    bench.put("driven.csv", driven.collect::<String>());
    let identify = "identify driven.csv --time time_s=s --input u=1 --output angle_rad=rad";
    for line in [
        "fit model.toml huge.csv --free link1.com_m -o new.toml",
        "compare model.toml huge.csv",
        identify,
        "init huge.csv -o new.toml",
        "log plot huge.csv",
        "log merge huge.csv b.csv --offset 0 -o merged.csv",
    ] {
        let ran = bench.run(line);
        assert_eq!(ran.code, Some(3), "{line}: {ran:?}");
        let said = ".csv:201:2: angle_rad: '1e200' is 1.000e200 rad, beyond the 1000000 rad";
        assert!(ran.stderr.contains(said), "{line}: {}", ran.stderr);
    }
    assert_eq!(bench.run("log check model.toml huge.csv").code, Some(1));
}

#[test]
fn a_good_log_passes_its_check() {
    let bench = Bench::new();
    let check = bench.run("log check model.toml a.csv b.csv");
    assert_eq!(check.code, Some(0), "{check:?}");
    assert!(check.stdout.contains("fit for use"), "{check:?}");
    let findings = bench.run("log check model.toml a.csv --json").json();
    assert_ne!(findings["verdict"], "refused");
    let found = findings["findings"].as_array().unwrap();
    assert!(found.iter().any(|finding| finding["kind"] == "excitation"));
}

#[test]
fn a_model_and_a_log_that_are_swapped_are_told_so() {
    let bench = Bench::new();
    for (line, code) in [
        ("compare a.csv model.toml", 2),
        ("fit a.csv model.toml --free link1.com_m -o new.toml", 2),
        ("log check a.csv model.toml", 2),
        ("compare a.csv b.csv", 3),
        ("fit a.csv b.csv --free link1.com_m -o new.toml", 3),
    ] {
        let ran = bench.run(line);
        assert_eq!(ran.code, Some(code), "{line}: {ran:?}");
        assert!(
            ran.stderr.contains("are the two swapped?"),
            "{line}: {}",
            ran.stderr
        );
    }
}

#[test]
fn a_log_that_cannot_be_read_is_refused_alike_with_and_without_a_model() {
    let bench = Bench::new();
    let good = bench.get("a.csv");
    let (header, rows) = good.split_once('\n').unwrap();
    bench.put(
        "commas.csv",
        format!("{header}\n{}", rows.replace('.', ",")),
    );
    bench.put(
        "wide.csv",
        format!("{header}\n{}", rows.replace('\n', ",1.5,2.5\n")),
    );
    bench.put("scope.csv", format!("Model,A1\nSamples,400\n\n{good}"));
    bench.put("headless.csv", rows);
    bench.put("packed.csv.gz", b"\x1f\x8b\x08\0");
    for (file, said) in [
        ("commas.csv", "decimal commas"),
        (
            "wide.csv",
            "the line of column names has 2, the rows have 4 fields",
        ),
        ("scope.csv", "line 4 looks like the line of column names"),
        ("headless.csv", "numbers where the column names should be"),
        ("packed.csv.gz", "packed by gzip"),
    ] {
        let read = [format!("init {file}"), format!("log plot {file}")];
        for line in read {
            let ran = bench.run(&line);
            assert_eq!(ran.code, Some(3), "{line}: {ran:?}");
            assert!(ran.stderr.contains(said), "{line}: {}", ran.stderr);
        }
        let check = bench.run(&format!("log check model.toml {file} --json"));
        let findings = check.json()["findings"].as_array().unwrap().clone();
        let refused = findings
            .iter()
            .filter(|f| f["severity"] == "refused")
            .count();
        assert_eq!((check.code, refused), (Some(1), 1), "{file}: {findings:#?}");
    }
}
