//! What must hold of the sources before anything is run: format, lints, documentation, packages,
//! the oldest compiler.

use handstand_xtask::{cargo, program, root};
use serde_json::Value;

/// A check: its name, and whether it holds. Each says what it finds.
pub type Check = (&'static str, fn() -> bool);

/// Every check, the quick ones first; a new one is one line.
pub const CHECKS: &[Check] = &[
    ("cargo fmt", || runs(&["fmt", "--all", "--check"])),
    ("rust-version", oldest_compiler),
    ("cargo package", packages),
    ("cargo clippy", || {
        runs(&[
            "clippy",
            "--workspace",
            "--all-targets",
            "--",
            "-D",
            "warnings",
        ])
    }),
    ("cargo clippy --no-default-features", || {
        runs(&[
            "clippy",
            "--package",
            "handstand",
            "--no-default-features",
            "--",
            "-D",
            "warnings",
        ])
    }),
    ("cargo doc", || runs(&["doc", "--workspace", "--no-deps"])),
];

fn runs(words: &[&str]) -> bool {
    program::run(cargo(words).env("RUSTDOCFLAGS", "-D warnings"))
}

/// Whether no dependency needs a newer compiler than the workspace promises to build with. Clippy's
/// `incompatible_msrv` looks at what the sources themselves use.
fn oldest_compiler() -> bool {
    let promised = env!("CARGO_PKG_RUST_VERSION");
    let Some(metadata) = metadata() else {
        return false;
    };
    let newer = newer_than(promised, &metadata);
    println!(
        "\nThe oldest compiler is Rust {promised}; {} crates need a newer one",
        newer.len()
    );
    newer.iter().for_each(|name| println!("{name}"));
    newer.is_empty()
}

/// Crates whose `rust-version` is above the promised one, each with its version and what it needs.
fn newer_than(promised: &str, metadata: &Value) -> Vec<String> {
    let packages = metadata["packages"].as_array().into_iter().flatten();
    let needs = packages.filter_map(|package| {
        let needed = package["rust_version"].as_str()?;
        let text = |key: &str| package[key].as_str().unwrap_or("?").to_string();
        (numbers(needed) > numbers(promised))
            .then(|| format!("{} {} needs {needed}", text("name"), text("version")))
    });
    needs.collect()
}

/// `1.88` or `1.88.0` as numbers that compare.
fn numbers(version: &str) -> [u32; 3] {
    let mut parts = version.split('.').map(|part| part.parse().unwrap_or(0));
    [(); 3].map(|()| parts.next().unwrap_or(0))
}

/// Whether cargo accepts every crate that is published: versions on dependencies, files, licence,
/// description. They are not compiled again.
fn packages() -> bool {
    let Some(metadata) = metadata() else {
        return false;
    };
    let mut words = vec![
        "package",
        "--quiet",
        "--no-verify",
        "--allow-dirty",
        "--offline",
    ];
    let published = published(&metadata);
    words.extend(published.iter().flat_map(|name| ["--package", name]));
    runs(&words) && published.iter().all(|name| is_described(name, &metadata))
}

/// Members of the workspace that a registry may get.
fn published(metadata: &Value) -> Vec<String> {
    members(metadata)
        .filter(|package| package["publish"].is_null())
        .filter_map(|package| Some(package["name"].as_str()?.to_string()))
        .collect()
}

/// Whether a reader of the registry learns what the crate is; cargo asks for less.
fn is_described(name: &str, metadata: &Value) -> bool {
    let package = members(metadata).find(|package| package["name"] == *name);
    let lacks = |key: &&str| {
        let value = package.map(|package| &package[*key]);
        value.is_none_or(|value| value.is_null() || value.as_array().is_some_and(Vec::is_empty))
    };
    let keys = [
        "description",
        "license",
        "readme",
        "keywords",
        "categories",
        "rust_version",
    ];
    let missing: Vec<_> = keys.iter().filter(|key| lacks(key)).collect();
    if !missing.is_empty() {
        println!("{name}: its Cargo.toml lacks {missing:?}");
    }
    missing.is_empty()
}

fn members(metadata: &Value) -> impl Iterator<Item = &Value> {
    let packages = metadata["packages"].as_array().into_iter().flatten();
    packages.filter(|package| package["source"].is_null())
}

/// What cargo knows of the workspace and its dependencies.
fn metadata() -> Option<Value> {
    let mut cargo = cargo(&["metadata", "--format-version", "1", "--locked"]);
    let output = cargo.current_dir(root()).output().ok()?;
    let metadata = serde_json::from_slice(&output.stdout).ok();
    if metadata.is_none() {
        println!(
            "cargo metadata: {}",
            String::from_utf8_lossy(&output.stderr)
        );
    }
    metadata
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn a_crate_that_needs_a_newer_compiler_is_named() {
        let package = |name: &str, needs: Option<&str>| json!({"name": name, "version": "1.0.0", "rust_version": needs});
        let metadata = json!({"packages": [
            package("old", Some("1.56")), package("equal", Some("1.88.0")), package("silent", None),
            package("new", Some("1.88.1")), package("newer", Some("1.100")),
        ]});
        assert_eq!(
            newer_than("1.88", &metadata),
            ["new 1.0.0 needs 1.88.1", "newer 1.0.0 needs 1.100"]
        );
    }

    #[test]
    fn a_crate_without_keywords_is_not_described_and_the_published_ones_are() {
        let member = json!({"name": "bare", "source": null, "publish": null, "description": "d", "license": "MIT",
            "readme": "README.md", "keywords": [], "categories": ["simulation"], "rust_version": "1.88"});
        assert!(!is_described("bare", &json!({"packages": [member]})));
        let metadata = metadata().expect("cargo knows its workspace");
        let published = published(&metadata);
        for name in ["handstand", "handstand-firmware", "handstand-shared"] {
            assert!(
                published.iter().any(|published| published == name),
                "{name}: {published:?}"
            );
            assert!(is_described(name, &metadata));
        }
    }
}
