//! The built program, seen from outside.

use crate::common::{Bench, MODEL};

#[test]
fn help_lists_every_command() {
    let help = Bench::new().run("help");
    assert_eq!(help.code, Some(0));
    for command in [
        "compare",
        "diagnose",
        "effects",
        "log",
        "fit",
        "add",
        "gains",
        "challenge",
        "demo",
        "bus",
        "record",
        "replay",
        "latency",
        "deploy",
        "flash",
        "virtual",
    ] {
        assert!(
            help.stdout.contains(&format!("\n  {command} ")),
            "{command}: {}",
            help.stdout
        );
    }
}

#[test]
fn there_is_a_page_for_every_command_and_nothing_is_written_over() {
    let bench = Bench::new();
    let wrote = bench.run("man pages --json");
    assert_eq!(wrote.code, Some(0), "{wrote:?}");
    let pages = wrote.json()["pages"].as_array().unwrap().len();
    assert_eq!(
        std::fs::read_dir(bench.path("pages")).unwrap().count(),
        pages
    );
    let page = std::fs::read_to_string(bench.path("pages/handstand-log-check.1")).unwrap();
    assert!(
        page.contains("handstand\\-log\\-check") || page.contains("log check"),
        "{page}"
    );
    assert_eq!(bench.run("man pages").code, Some(2));
    assert_eq!(bench.run("man pages --force").code, Some(0));
}

#[test]
fn shells_are_told_every_command() {
    let bench = Bench::new();
    for shell in ["bash", "zsh", "fish", "elvish", "powershell"] {
        let script = bench.run(&format!("completions {shell}"));
        assert_eq!(script.code, Some(0), "{script:?}");
        for word in ["diagnose", "holdout", "virtual"] {
            assert!(script.stdout.contains(word), "{shell} {word}");
        }
    }
    assert_eq!(bench.run("completions tcsh").code, Some(2));
}

#[test]
fn the_doctor_lists_ports_and_tools() {
    let ran = Bench::new().run_with("doctor --json", &[("PATH", "/nowhere".into())]);
    let found = ran.json();
    let ports = found["ports"].as_array().unwrap();
    let all_open = ports.iter().all(|port| port["may_open"] == true);
    assert_eq!(ran.code, Some(i32::from(!all_open)), "{ran:?}");
    let tools = found["tools"].as_array().unwrap();
    let missing = |name: &str| {
        tools
            .iter()
            .any(|t| t["name"] == name && t["path"].is_null())
    };
    assert!(missing("avr-gcc") && missing("Slurm"), "{ran:?}");
}

#[test]
fn the_demo_leaves_nothing_where_it_is_run() {
    let bench = Bench::new();
    std::fs::create_dir(bench.path("temporary")).unwrap();
    let before = files(&bench);
    let place = bench.path("temporary").display().to_string();
    let ran = bench.run_with("demo --effect viscous --json", &[("TMPDIR", place.clone())]);
    assert_eq!(ran.code, Some(0), "{ran:?}");
    assert_eq!(ran.json()["solved"], true, "{ran:?}");
    let said = format!("Everything is written to {place}");
    assert!(ran.stderr.contains(&said), "{ran:?}");
    assert_eq!(files(&bench), before);
}

fn files(bench: &Bench) -> Vec<std::ffi::OsString> {
    let entries = std::fs::read_dir(bench.path(".")).unwrap();
    let mut names: Vec<_> = entries.map(|entry| entry.unwrap().file_name()).collect();
    names.sort();
    names
}

#[test]
fn requests_that_make_no_sense_end_in_2_and_name_a_remedy() {
    let bench = Bench::new();
    bench.put("copy.csv", bench.get("a.csv"));
    for (line, said) in [
        ("", "Usage"),
        ("fly", "unrecognized subcommand"),
        ("effects colomb", "did you mean `coulomb`"),
        ("fit model.toml -o new.toml", "LOG"),
        ("fit model.toml a.csv", "--output"),
        ("fit model.toml a.csv -o new.toml", "--free"),
        (
            "fit model.toml a.csv --free link1.mas_kg -o new.toml",
            "mass_kg",
        ),
        (
            "fit model.toml a.csv --free coulomb@1.torque_nm -o new.toml",
            "not in this model",
        ),
        (
            "fit model.toml a.csv:9-3 --free link1.com_m -o new.toml",
            "are not a range",
        ),
        (
            "fit model.toml a.csv --horizon -1 --free link1.com_m -o new.toml",
            "above 0",
        ),
        (
            "fit model.toml a.csv --holdout a.csv --free link1.com_m -o new.toml",
            "held out",
        ),
        (
            "add model.toml viscuos --fit a.csv -o new.toml",
            "did you mean `viscous`",
        ),
        (
            "add model.toml viscous@2 --fit a.csv -o new.toml",
            "count from 1 to 1",
        ),
        (
            "add model.toml delay --fit a.csv -o new.toml",
            "driven joints only",
        ),
        (
            "add model.toml base_tilt@1 --fit a.csv -o new.toml",
            "whole rig",
        ),
        (
            "add model.toml viscous viscous@1 --fit a.csv -o new.toml",
            "`viscous@1` is named twice",
        ),
        (
            "fit model.toml a.csv ./a.csv --free link1.com_m -o new.toml",
            "./a.csv is given twice",
        ),
        ("compare model.toml - -", "- is given twice"),
        (
            "drift model.toml a.csv a.csv --free link1.com_m",
            "a.csv is given twice",
        ),
        ("diagnose model.toml a.csv a.csv", "a.csv is given twice"),
        (
            "diagnose model.toml a.csv b.csv copy.csv",
            "copy.csv is a copy of a.csv; the two files hold the same bytes",
        ),
        (
            "fit model.toml a.csv copy.csv --free link1.com_m -o new.toml",
            "copy.csv is a copy of a.csv",
        ),
        (
            "compare model.toml copy.csv a.csv",
            "a.csv is a copy of copy.csv",
        ),
        (
            "drift model.toml a.csv:0-90 copy.csv:80-200 --free link1.com_m",
            "copy.csv:80-200 shares rows with a.csv:0-90; the two files hold the same bytes",
        ),
        (
            "fit model.toml a.csv --holdout copy.csv --free link1.com_m -o new.toml",
            "copy.csv is held out, and shares rows with a.csv, which is fitted; the two files",
        ),
        (
            "log check model.toml a.csv:0-50 a.csv:40-90",
            "a.csv:40-90 shares rows with a.csv:0-50",
        ),
        ("log check model.toml", "LOG"),
    ] {
        let ran = bench.run(line);
        assert_eq!(ran.code, Some(2), "{line}: {ran:?}");
        assert!(ran.stderr.contains(said), "{line}: {}", ran.stderr);
        assert!(!bench.path("new.toml").exists(), "{line}");
    }
}

#[test]
fn a_bad_model_is_named_by_line_and_column() {
    let bench = Bench::new();
    for (good, bad, said) in [
        (
            "mass_kg = 0.2",
            "mas_kg = 0.2",
            "bad.toml:9:1: unknown key `mas_kg`",
        ),
        ("mass_kg = 0.2", "mas_kg = 0.2", "did you mean `mass_kg`"),
        ("mass_kg = 0.2", "mass = 0.2", "write `mass_kg`, in kg"),
        (
            "mass_kg = 0.2",
            "mass_kg = \"0.2\"",
            "bad.toml:9:11: `mass_kg` is a string",
        ),
        (
            "mass_kg = 0.2",
            "mass_kg = -0.2",
            "bad.toml:9:11: `mass_kg` = -0.2 is impossible",
        ),
        ("mass_kg = 0.2", "mass_kg = nan", "which no rig has"),
        ("mass_kg = 0.2", "mass_kg 0.2", "bad.toml:9:9: not TOML"),
        ("com_m = 0.1\n", "", "lacks `com_m`"),
        (
            "drive = \"passive\"",
            "drive = \"pasive\"",
            "bad.toml:13:9: `drive` cannot be `pasive`",
        ),
        ("unit = \"s\"", "unit = \"sec\"", "bad.toml:16:"),
    ] {
        bench.put("bad.toml", MODEL.replacen(good, bad, 1));
        let ran = bench.run("log check bad.toml a.csv");
        assert_eq!(ran.code, Some(3), "{bad}: {ran:?}");
        assert!(ran.stderr.contains(said), "{bad}: {}", ran.stderr);
    }
    bench.put("bad.toml", [0xff, 0xfe]);
    assert_eq!(bench.run("log check bad.toml a.csv").code, Some(3));
    let absent = bench.run("log check absent.toml a.csv");
    assert_eq!(absent.code, Some(3));
    assert!(absent.stderr.contains("absent.toml: cannot read"));
}

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
fn an_effect_is_added_with_its_value_and_provenance() {
    let bench = Bench::new();
    let ran = bench.run("add model.toml viscous --fit a.csv --holdout b.csv -o new.toml --json");
    assert_eq!(ran.code, Some(0), "{ran:?}");
    let data = ran.json();
    assert_eq!(data["effects"][0], "viscous@1");
    let value = data["values"][0]["value"].as_f64().unwrap();
    assert!((value - 0.001).abs() < 2e-5, "{value}");
    let error = &data["error"];
    assert_eq!(error["held_out"], true);
    assert!(error["after_rad"].as_f64() < error["before_rad"].as_f64());
    let text = bench.get("new.toml");
    assert!(text.starts_with("# A pendulum.\n"), "{text}");
    for part in [
        "kind = \"viscous\"",
        "[effect.fitted]",
        "intervals",
        "name = \"a.csv\", sha256",
    ] {
        assert!(text.contains(part), "{part}: {text}");
    }
    let again = bench.run("fit new.toml b.csv -o newer.toml");
    assert_eq!(again.code, Some(0), "{again:?}");
    assert!(
        again.stdout.contains("viscous@1.coefficient_nm_s_rad"),
        "{again:?}"
    );
}

#[test]
fn values_without_effect_are_refused_and_nothing_is_written() {
    let bench = Bench::new();
    // An arm that nobody moves shows no friction.
    let still: String = (0..100)
        .map(|k| format!("{:.2},0\n", f64::from(k) * 0.01))
        .collect();
    bench.put("still.csv", format!("time_s,angle_rad\n{still}"));
    let ran = bench.run("add model.toml air_drag --fit still.csv -o new.toml");
    assert_eq!(ran.code, Some(1), "{ran:?}");
    assert!(ran.stdout.contains("refused"), "{ran:?}");
    assert!(!bench.path("new.toml").exists());
}

#[test]
fn nothing_is_overwritten_unasked() {
    let bench = Bench::new();
    bench.put("kept.toml", "mine");
    let line = "add model.toml viscous --fit a.csv -o kept.toml";
    let ran = bench.run(line);
    assert_eq!(ran.code, Some(2), "{ran:?}");
    assert!(ran.stderr.contains("--force"), "{ran:?}");
    assert_eq!(bench.get("kept.toml"), "mine");
    assert_eq!(bench.run(&format!("{line} --force")).code, Some(0));
    assert_ne!(bench.get("kept.toml"), "mine");
}

#[test]
fn effects_are_explained_to_people_and_programs() {
    let bench = Bench::new();
    let infos = bench.run("effects --json").json();
    for info in infos.as_array().unwrap() {
        let id = info["id"].as_str().unwrap();
        let page = bench.run(&format!("effects {id}"));
        assert_eq!(page.code, Some(0), "{page:?}");
        assert!(
            page.stdout.contains(info["title"].as_str().unwrap()),
            "{id}"
        );
    }
    assert_eq!(bench.run("effects coulomb --json").json()["id"], "coulomb");
}

#[test]
fn quiet_is_quiet_and_no_escape_sequences_reach_a_pipe() {
    let bench = Bench::new();
    let line = "add model.toml viscous --fit a.csv -o new.toml --force";
    let loud = bench.run(line);
    assert!(loud.stderr.contains("wrote new.toml"), "{loud:?}");
    assert!(!format!("{}{}", loud.stdout, loud.stderr).contains('\u{1b}'));
    assert_eq!(bench.run(&format!("--quiet {line}")).stderr, "");
}

#[cfg(unix)]
#[test]
fn a_reader_that_leaves_early_is_no_error() {
    use std::process::{Command, Stdio};
    let mut child = Command::new(env!("CARGO_BIN_EXE_handstand"))
        .args(["effects", "--json"])
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    drop(child.stdout.take());
    let output = child.wait_with_output().unwrap();
    assert!(output.status.success(), "{output:?}");
    assert!(output.stderr.is_empty(), "{output:?}");
}

#[test]
fn what_the_system_refuses_is_said_with_a_remedy() {
    let bench = Bench::new();
    std::fs::create_dir(bench.path("logs")).unwrap();
    bench.put("bytes.toml", b"\xff\xfe\x00");
    for (line, said, remedy) in [
        (
            "add model.toml viscous --fit a.csv -o nowhere/new.toml",
            "nowhere/new.toml: cannot write: No such file",
            "help: create the folder first: mkdir -p nowhere",
        ),
        (
            "compare logs a.csv",
            "logs: cannot read: ",
            "help: this is a folder",
        ),
        (
            "compare bytes.toml a.csv",
            "bytes.toml: cannot read: ",
            "help: this is no text",
        ),
        (
            "compare no.toml a.csv",
            "no.toml: cannot read: ",
            "help: check the name",
        ),
    ] {
        let ran = bench.run(line);
        assert_eq!(ran.code, Some(3), "{line}: {ran:?}");
        assert!(ran.stderr.contains(said), "{line}: {}", ran.stderr);
        assert!(ran.stderr.contains(remedy), "{line}: {}", ran.stderr);
        assert!(
            !ran.stderr.contains(".handstand-"),
            "{line}: {}",
            ran.stderr
        );
    }
}
