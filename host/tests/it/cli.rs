//! The built program, seen from outside.

use crate::common::Bench;

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
fn models_of_one_file_name_are_told_apart_by_their_folders() {
    let bench = Bench::new();
    let model = bench.get("model.toml");
    for (folder, mass) in [("d1", "0.2"), ("d2", "0.25")] {
        std::fs::create_dir(bench.path(folder)).unwrap();
        let model = model.replace("mass_kg = 0.2", &format!("mass_kg = {mass}"));
        bench.put(&format!("{folder}/model.toml"), model);
    }
    let line = "compare d1/model.toml a.csv --model d2/model.toml";
    let said = bench.run(line).stdout.replace('\\', "/");
    let heads = said.lines().next().unwrap();
    let heads: Vec<&str> = heads.split('|').map(str::trim).collect();
    assert_eq!(heads, ["", "", "d1/model.toml", "d2/model.toml", ""]);
    for bar in ["\n  d1/model.toml  ", "\n  d2/model.toml  "] {
        assert!(said.contains(bar), "{said}");
    }
    let report = bench
        .run(&format!("{line} --json --report report.html"))
        .json();
    let told = |name: &serde_json::Value| name.as_str().unwrap().replace('\\', "/");
    for (index, name) in ["d1/model.toml", "d2/model.toml"].into_iter().enumerate() {
        assert_eq!(told(&report["comparisons"][index]["model"]), name);
        assert_eq!(
            told(&report["provenance"]["model_files"][index]["name"]),
            name
        );
        assert!(
            bench
                .get("report.html")
                .replace('\\', "/")
                .contains(&format!("<td>{name}</td>"))
        );
    }
    let twice = bench
        .run("compare d1/model.toml a.csv --model d1/model.toml --json")
        .json();
    assert_eq!(twice["comparisons"][1]["model"], "model.toml (2)");
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
