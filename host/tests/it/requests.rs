//! Requests, models and files that are refused, each with its remedy.

use crate::common::{Bench, MODEL};

#[test]
fn requests_that_make_no_sense_end_in_2_and_name_a_remedy() {
    let bench = Bench::new();
    bench.put("copy.csv", bench.get("a.csv"));
    for (line, said) in [
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

/// Whatever a model says fits windows that hold no more than their own start.
#[test]
fn windows_of_too_few_samples_are_refused() {
    let bench = Bench::new();
    let driven =
        MODEL.replace("passive", "torque") + "input = { column = \"u_nm\", unit = \"N m\" }\n";
    bench.put("driven.toml", driven);
    let header = |row: usize| if row == 0 { "u_nm" } else { "0.01" };
    let swing = bench.get("a.csv");
    let rows = swing.lines().enumerate();
    let rows: Vec<String> = rows
        .map(|(k, row)| format!("{row},{}\n", header(k)))
        .collect();
    bench.put("driven_a.csv", rows.concat());
    for line in [
        "compare model.toml a.csv",
        "fit model.toml a.csv --free link1.com_m -o new.toml",
        "add model.toml viscous --fit a.csv -o new.toml",
        "diagnose model.toml a.csv b.csv",
        "next driven.toml driven_a.csv --value link1.com_m",
        "drift model.toml a.csv b.csv --free link1.com_m",
        "view model.toml a.csv --model model.toml -o new.html",
    ] {
        let ran = bench.run(&format!("{line} --horizon 0.0001"));
        assert_eq!(ran.code, Some(2), "{line}: {ran:?}");
        for said in ["--horizon 0.0001", "a.csv", "--horizon 0.06 or more"] {
            assert!(ran.stderr.contains(said), "{line}: {ran:?}");
        }
    }
    let least = bench.run("compare model.toml a.csv --horizon 0.06");
    assert_eq!(least.code, Some(0), "{least:?}");
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
