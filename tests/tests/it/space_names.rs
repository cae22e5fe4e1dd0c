//! A robot in space is spoken of by the names of its file.

use crate::space::{CRANE, printed, run, swung};
use handstand::Model;
use std::path::Path;

/// What a command prints for people, by names alone.
fn named(folder: &Path, arguments: &[&str]) -> String {
    let [text, _] = printed(folder, arguments);
    for number in 1..=3 {
        for numbered in [
            format!("joint {number}"),
            format!("@{number}"),
            format!("link{number}."),
            format!("joint{number}"),
        ] {
            assert!(!text.contains(&numbered), "{numbered}: {text}");
        }
    }
    text
}

/// A folder with the crane, its model with friction that is too low, and three logs.
fn crane() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    std::fs::write(at.join("crane.urdf"), CRANE).unwrap();
    run(
        at,
        &[
            "import",
            "crane.urdf",
            "--space",
            "--driven",
            "-o",
            "bare.toml",
        ],
    );
    let model = Model::load(&at.join("bare.toml")).unwrap();
    for (number, name) in ["a.csv", "b.csv", "c.csv"].into_iter().enumerate() {
        std::fs::write(at.join(name), swung(&model, number)).unwrap();
    }
    let text = std::fs::read_to_string(at.join("bare.toml")).unwrap()
        + "\n[[effect]]\nkind = \"viscous\"\njoint = \"luff\"\ncoefficient_nm_s_rad = 0.02\n\
           [fit]\nfree = [\"viscous@luff.coefficient_nm_s_rad\", \"link.head.mass_kg\"]\n";
    std::fs::write(at.join("crane.toml"), text).unwrap();
    folder
}

#[test]
fn commands_take_and_print_the_names_of_links_and_joints() {
    let folder = crane();
    let at = folder.path();
    let text = named(at, &["compare", "crane.toml", "c.csv"]);
    assert!(text.contains("| joint luff: rms, mrad"), "{text}");
    let report = ["compare", "crane.toml", "c.csv", "--report", "page.html"];
    run(at, &report);
    let page = std::fs::read_to_string(at.join("page.html")).unwrap();
    assert!(page.contains(">joint luff"), "{page}");
    assert!(page.contains(r#"aria-label="motion c.csv, joint luff""#));
    let numbered = ["joint 2", "Joint 2"].map(|numbered| page.find(numbered));
    assert_eq!(numbered, [None, None], "{page}");
    let widths: Vec<usize> = (text.lines())
        .filter(|line| line.starts_with('|'))
        .map(|line| line.chars().count())
        .collect();
    assert!(widths.iter().all(|width| *width == widths[0]), "{text}");
    let logs = ["a.csv", "b.csv", "c.csv"];
    let fit = [
        "fit",
        "crane.toml",
        "-o",
        "fitted.toml",
        "--bounds",
        "link.head.mass_kg=0.1..0.3",
    ];
    let text = named(at, &[&fit[..], &logs].concat());
    for wanted in ["viscous@luff.coefficient_nm_s_rad", "link.head.mass_kg"] {
        assert!(text.contains(wanted), "{text}");
    }
    let fitted = std::fs::read_to_string(at.join("fitted.toml")).unwrap();
    assert!(
        fitted.contains("joint = \"luff\"\ncoefficient_nm_s_rad = 0.0"),
        "{fitted}"
    );
    let found = Model::load(&at.join("fitted.toml")).unwrap().effects[0].values[0];
    assert!((found / 0.06 - 1.0).abs() < 0.02, "{found}");
    let text = named(at, &[&["drift", "crane.toml"][..], &logs].concat());
    assert!(text.contains("viscous@luff.coefficient_nm_s_rad"), "{text}");
    let add = [
        "add",
        "bare.toml",
        "viscous@luff",
        "-o",
        "added.toml",
        "--fit",
    ];
    let text = named(at, &[&add[..], &logs].concat());
    assert!(text.contains("viscous@luff.coefficient_nm_s_rad"), "{text}");
}

#[test]
fn a_verdict_names_the_joint() {
    let folder = crane();
    let diagnose = [
        "diagnose",
        "crane.toml",
        "a.csv",
        "b.csv",
        "--holdout",
        "c.csv",
    ];
    let text = named(
        folder.path(),
        &[&diagnose[..], &["--within", "20s"]].concat(),
    );
    assert!(text.starts_with("Verdict: "), "{text}");
    let wanted = ["at joint luff", "viscous@luff", "link.boom", "@roll"];
    assert!(wanted.iter().any(|wanted| text.contains(wanted)), "{text}");
}
