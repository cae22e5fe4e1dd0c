//! The pages of `docs/measured` are those that are listed, and say what is measured today: a sample
//! of one row of each that has one.

use handstand_measure::pages::{Answer, Cost, PAGES, Programs, Sample, command};
use handstand_xtask::root;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

fn file(name: &str) -> PathBuf {
    root().join("docs/measured").join(name).with_extension("md")
}

fn page(name: &str) -> String {
    let file = file(name);
    std::fs::read_to_string(&file).unwrap_or_else(|why| panic!("{}: {why}", file.display()))
}

#[test]
fn every_page_is_listed_and_explained() {
    let listed: BTreeSet<String> = PAGES.iter().map(|page| page.name.to_string()).collect();
    assert_eq!(listed.len(), PAGES.len(), "a page is listed twice");
    let files = std::fs::read_dir(root().join("docs/measured")).unwrap();
    let files = files.map(|file| file.unwrap().file_name().into_string().unwrap());
    let written = files.filter_map(|file| file.strip_suffix(".md").map(String::from));
    let written: BTreeSet<String> = written.filter(|name| name != "README").collect();
    let unlisted: Vec<_> = written.difference(&listed).collect();
    assert!(unlisted.is_empty(), "not in PAGES: {unlisted:?}");
    let readme = page("README");
    for name in &listed {
        assert!(
            readme.contains(&format!("`{name}.md`")),
            "README.md lacks {name}"
        );
    }
    for page in PAGES.iter().filter(|page| written.contains(page.name)) {
        let typed = command(&self::page(page.name));
        assert!(
            typed.is_ok() || matches!(page.cost, Cost::Script(..)),
            "{}: {typed:?}",
            page.name
        );
    }
}

#[test]
fn every_page_has_a_row_or_says_why_not() {
    for page in PAGES {
        match &page.sample {
            Sample::Nothing(why) => {
                let words = why.split_whitespace().count();
                assert!(words >= 5, "{}: `{why}` is no reason", page.name);
            }
            // A page that is missing was not measured with this version.
            _ if !file(page.name).exists() => {}
            Sample::Seconds(row) | Sample::Longer(_, row) => {
                let (name, begins) = (page.name, row.begins);
                assert!(
                    row.find(&self::page(name)).is_some(),
                    "{name}.md: no row begins `{begins}`"
                );
            }
        }
    }
}

/// The program that the workspace's build left beside the one that measures.
fn handstand(measure: &Path) -> PathBuf {
    let program = measure.with_file_name("handstand");
    assert!(program.exists(), "build it first: cargo build -p handstand");
    program
}

#[test]
fn a_row_of_a_page_is_what_is_measured_today() {
    let measure = Path::new(env!("CARGO_BIN_EXE_measure"));
    let handstand = &handstand(measure);
    let programs = Programs { measure, handstand };
    let mut wrong = Vec::new();
    for page in PAGES {
        let Sample::Seconds(row) = &page.sample else {
            continue;
        };
        match row.measured_again(&self::page(page.name), &programs) {
            Ok(Answer::Same) => {}
            Ok(Answer::LeftOut(why)) => println!("left out: {}, for {why}", page.name),
            Err(why) => wrong.push(format!("docs/measured/{}.md: {why}", page.name)),
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n\n"));
}
