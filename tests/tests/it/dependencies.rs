//! What a user of the library pulls in.

use std::process::Command;

/// Packages of the workspace in a dependency tree of `handstand` with these arguments.
fn own_packages(arguments: &[&str]) -> Vec<String> {
    let tree = [
        "tree",
        "--offline",
        "--package",
        "handstand",
        "--edges",
        "normal",
    ];
    let output = Command::new(env!("CARGO"))
        .args(tree)
        .args(["--prefix", "none", "--format", "{p}"])
        .args(arguments)
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .output()
        .unwrap();
    let text = String::from_utf8(output.stdout).unwrap();
    let names = text.lines().filter_map(|line| line.split(' ').next());
    let own = names.filter(|name| name.starts_with("handstand"));
    own.map(str::to_string).collect()
}

#[test]
fn without_its_features_the_library_pulls_neither_firmware_nor_simulation() {
    let bare = own_packages(&["--no-default-features"]);
    assert_eq!(bare, ["handstand", "handstand-shared"]);
    let full = own_packages(&[]);
    for name in ["handstand-cm5-sim", "handstand-firmware"] {
        assert!(
            full.iter().any(|package| package == name),
            "{name}: {full:?}"
        );
    }
}
