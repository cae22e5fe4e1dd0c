//! Which crate knows which, and what a user of one pulls in.

use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};
use std::process::Command;
use std::sync::LazyLock;

/// What cargo knows of the workspace's own crates: each crate's direct dependencies, those that
/// only tests have left out.
static DIRECT: LazyLock<BTreeMap<String, BTreeSet<String>>> = LazyLock::new(|| {
    let output = Command::new(env!("CARGO"))
        .args([
            "metadata",
            "--offline",
            "--no-deps",
            "--format-version",
            "1",
        ])
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .output()
        .unwrap();
    let metadata: Value = serde_json::from_slice(&output.stdout).unwrap();
    let text = |value: &Value| value.as_str().unwrap().to_string();
    let packages = metadata["packages"].as_array().unwrap().iter();
    let direct = packages.map(|package| {
        let dependencies = package["dependencies"].as_array().unwrap().iter();
        let built = dependencies.filter(|dependency| dependency["kind"].is_null());
        let names = built.map(|dependency| text(&dependency["name"]));
        (text(&package["name"]), names.collect())
    });
    direct.collect()
});

/// The crates of the PC, and those of them that each may know directly.
const CRATES: [(&str, &[&str]); 16] = [
    ("physics", &[]),
    ("model", &["physics"]),
    ("logs", &["model"]),
    ("challenge", &["model"]),
    ("sim", &["model"]),
    ("fit", &["model", "sim"]),
    ("diagnose", &["fit", "logs", "model"]),
    ("experiment", &["diagnose", "fit", "logs", "model", "sim"]),
    ("control", &["fit", "model", "sim"]),
    ("study", &["control", "fit", "model", "sim"]),
    ("link", &["logs", "model", "sim"]),
    (
        "robot",
        &[
            "challenge",
            "control",
            "diagnose",
            "experiment",
            "fit",
            "link",
            "logs",
            "model",
            "report",
            "study",
        ],
    ),
    (
        "report",
        &[
            "control",
            "diagnose",
            "experiment",
            "fit",
            "logs",
            "model",
            "study",
        ],
    ),
    ("paper", &["control", "model", "report", "sim", "study"]),
    (
        "lab",
        &[
            "challenge",
            "control",
            "diagnose",
            "experiment",
            "fit",
            "link",
            "logs",
            "model",
            "report",
            "robot",
            "study",
        ],
    ),
    ("cm5-sim", &["firmware"]),
];

/// A library, and the crates of the PC that alone may depend on it.
const ALONE: [(&str, &[&str]); 8] = [
    ("parquet", &["handstand-logs"]),
    ("hdf5-reader", &["handstand-logs"]),
    // A recording is written as MCAP where it is made.
    ("mcap", &["handstand-link", "handstand-logs"]),
    ("serialport", &["handstand-link"]),
    ("axum", &["handstand-lab"]),
    ("tokio", &["handstand-lab"]),
    ("clap", &["handstand"]),
    ("miette", &["handstand"]),
];

#[test]
fn crates_know_what_the_architecture_says() {
    for (name, may) in CRATES {
        let direct = &DIRECT[&format!("handstand-{name}")];
        let own = direct
            .iter()
            .filter_map(|known| known.strip_prefix("handstand-"));
        let others: Vec<&str> = own
            .filter(|known| *known != "shared" && *known != "cm5-sim" && !may.contains(known))
            .collect();
        assert!(others.is_empty(), "{name} knows {others:?}");
    }
    let of_the_pc = |name: &&String| {
        let own = name.strip_prefix("handstand-");
        **name == "handstand" || own.is_some_and(|own| CRATES.iter().any(|(it, _)| *it == own))
    };
    for (library, alone) in ALONE {
        let users = DIRECT.iter().filter(|(_, direct)| direct.contains(library));
        let users: Vec<&String> = users.map(|(name, _)| name).filter(of_the_pc).collect();
        assert!(!users.is_empty(), "{library} is used by nobody");
        let others: Vec<_> = users
            .iter()
            .filter(|user| !alone.contains(&user.as_str()))
            .collect();
        assert!(others.is_empty(), "{others:?} use {library}");
    }
}

/// Packages that a package pulls in, with these arguments.
fn closure(package: &str, arguments: &[&str]) -> BTreeSet<String> {
    let output = Command::new(env!("CARGO"))
        .args([
            "tree",
            "--offline",
            "--package",
            package,
            "--edges",
            "normal",
        ])
        .args(["--prefix", "none", "--format", "{p}"])
        .args(arguments)
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .output()
        .unwrap();
    let text = String::from_utf8(output.stdout).unwrap();
    let ids = text.lines().filter_map(|line| {
        let mut words = line.split(' ');
        Some(format!("{} {}", words.next()?, words.next()?))
    });
    ids.collect()
}

fn holds(closure: &BTreeSet<String>, name: &str) -> bool {
    closure.iter().any(|id| id.split(' ').next() == Some(name))
}

#[test]
fn whoever_simulates_or_fits_pulls_in_no_more_than_that() {
    for (package, under) in [
        ("handstand-sim", "handstand-model"),
        ("handstand-fit", "handstand-sim"),
    ] {
        let closure = closure(package, &[]);
        let count = closure.len();
        assert!(holds(&closure, under), "{package}");
        assert!(count <= 120, "{package} pulls in {count}");
        for heavy in ["axum", "clap", "parquet", "serialport", "handstand-logs"] {
            assert!(!holds(&closure, heavy), "{package} pulls in {heavy}");
        }
    }
}

#[test]
fn without_its_features_the_library_pulls_neither_lab_nor_firmware() {
    let (bare, full) = (
        closure("handstand", &["--no-default-features"]),
        closure("handstand", &[]),
    );
    for name in [
        "handstand-cm5-sim",
        "handstand-firmware",
        "handstand-lab",
        "handstand-robot",
        "axum",
        "parquet",
        "hdf5-reader",
        "mcap",
    ] {
        assert!(holds(&full, name), "{name} is not there");
        assert!(!holds(&bare, name), "{name} is there");
    }
}
