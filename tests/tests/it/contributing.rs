//! The worked examples of CONTRIBUTING.md, done word for word in a copy of the tree, compile;
//! ARCHITECTURE.md names files that exist.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::process::Command;

fn root() -> PathBuf {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    root.canonicalize().unwrap()
}

/// A block of a Markdown page whose fence names a file:
/// ```` ```rust host/physics/src/effects/new.rs ````.
struct Block {
    /// `rust` is a new file, `diff` a change of one.
    kind: String,
    file: String,
    lines: Vec<String>,
}

fn blocks(page: &str) -> Vec<Block> {
    let mut blocks = Vec::new();
    let mut lines = page.lines();
    while let Some(line) = lines.next() {
        let Some(fence) = line.strip_prefix("```") else {
            continue;
        };
        let content = lines
            .by_ref()
            .take_while(|line| *line != "```")
            .map(String::from);
        let lines: Vec<String> = content.collect();
        if let Some((kind, file)) = fence.split_once(' ') {
            let (kind, file) = (kind.to_string(), file.to_string());
            blocks.push(Block { kind, file, lines });
        }
    }
    blocks
}

/// The text after a change: lines that begin with a space stand in it one below the other, exactly
/// once; those with `-` go, those with `+` come.
fn changed(text: &str, block: &Block) -> String {
    let side = |signs: [char; 2]| -> Vec<&str> {
        let wanted = block.lines.iter().filter(|line| line.starts_with(signs));
        wanted.map(|line| &line[1..]).collect()
    };
    let (old, new) = (side([' ', '-']), side([' ', '+']));
    let lines: Vec<&str> = text.lines().collect();
    let places: Vec<usize> = (0..lines.len())
        .filter(|at| lines[*at..].starts_with(&old))
        .collect();
    let [place] = places[..] else {
        panic!(
            "{}: {old:#?} stands there {} times",
            block.file,
            places.len()
        );
    };
    let after = [&lines[..place], &new, &lines[place + old.len()..]].concat();
    after.join("\n") + "\n"
}

fn copy(from: &Path, to: &Path) {
    if from.is_dir() {
        std::fs::create_dir_all(to).unwrap();
        for entry in std::fs::read_dir(from).unwrap() {
            let name = entry.unwrap().file_name();
            copy(&from.join(&name), &to.join(&name));
        }
    } else {
        std::fs::copy(from, to).unwrap();
    }
}

/// All that cargo looks at.
const SOURCES: [&str; 6] = [
    "Cargo.toml",
    "Cargo.lock",
    "firmware",
    "host",
    "shared",
    "tests",
];

#[test]
fn the_worked_examples_of_contributing_compile() {
    let page = std::fs::read_to_string(root().join("CONTRIBUTING.md")).unwrap();
    let blocks = blocks(&page);
    let files: BTreeSet<&str> = blocks.iter().map(|block| block.file.as_str()).collect();
    for list in [
        "host/physics/src/effects/mod.rs",
        "host/control/src/synth/controllers/mod.rs",
    ] {
        assert!(files.contains(list), "no example changes {list}: {files:?}");
    }
    let copied = tempfile::tempdir().unwrap();
    for source in SOURCES {
        copy(&root().join(source), &copied.path().join(source));
    }
    for block in &blocks {
        let file = copied.path().join(&block.file);
        let text = match block.kind.as_str() {
            "diff" => changed(&std::fs::read_to_string(&file).unwrap(), block),
            _ => {
                assert!(!file.exists(), "{} is there already", block.file);
                block.lines.join("\n") + "\n"
            }
        };
        std::fs::write(file, text).unwrap();
    }
    // The dependencies that this test was built with serve the copy too.
    let beside = std::env::current_exe().unwrap();
    let target = beside.ancestors().nth(3).unwrap();
    let ran = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()))
        .args(["check", "--quiet", "--offline", "--lib"])
        .args(["--package", "handstand", "--package", "handstand-firmware"])
        .env("CARGO_TARGET_DIR", target)
        .current_dir(copied.path())
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&ran.stderr);
    assert!(ran.status.success() && !said.contains("warning"), "{said}");
}

/// What stands between back quotes and looks like a file or folder of the project.
fn named_files(page: &str) -> impl Iterator<Item = &str> {
    let quoted = page.split('`').skip(1).step_by(2);
    let tops = ["host/", "shared/", "firmware/", "tests/", "docs/"];
    quoted.filter(move |name| tops.iter().any(|top| name.starts_with(top)) && !name.contains(' '))
}

#[test]
fn files_that_the_guides_name_exist() {
    let mut seen = 0;
    for page in ["ARCHITECTURE.md", "CONTRIBUTING.md", "README.md"] {
        let text = std::fs::read_to_string(root().join(page)).unwrap();
        // New files of the worked examples are only in them.
        let new: Vec<String> = blocks(&text).into_iter().map(|block| block.file).collect();
        for name in named_files(&text).filter(|name| !new.iter().any(|new| new == name)) {
            assert!(
                root().join(name).exists(),
                "{page} names {name}, which is not there"
            );
            seen += 1;
        }
    }
    assert!(seen > 40, "only {seen} files are named");
}

#[test]
fn a_change_is_made_at_its_place_and_refused_without_one() {
    let block = |lines: [&str; 3]| Block {
        kind: "diff".into(),
        file: "list.rs".into(),
        lines: lines.map(String::from).to_vec(),
    };
    assert_eq!(
        changed("a\nb\nc\n", &block([" b", "+new", " c"])),
        "a\nb\nnew\nc\n"
    );
    assert_eq!(
        changed("a\nb\nc\n", &block([" a", "-b", "+d"])),
        "a\nd\nc\n"
    );
    for text in ["a\nc\n", "b\nc\nb\nc\n"] {
        let refused = std::panic::catch_unwind(|| changed(text, &block([" b", "+new", " c"])));
        assert!(refused.is_err(), "{text}");
    }
}
