//! The pages of `docs/measured` are those that are listed, and say what is measured today: a sample
//! of one row of each that has one.

use handstand_measure::pages::{Cost, PAGES, command, same_row};
use handstand_xtask::root;
use std::collections::BTreeSet;
use std::process::Command;

fn page(name: &str) -> String {
    let file = root().join("docs/measured").join(name).with_extension("md");
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
fn a_row_of_a_page_is_what_is_measured_today() {
    let rows = PAGES
        .iter()
        .filter_map(|page| Some((page.name, page.row.as_ref()?)));
    let mut measured = 0;
    for (name, row) in rows {
        let output = Command::new(env!("CARGO_BIN_EXE_measure"))
            .args(row.words)
            .output()
            .unwrap();
        let printed = String::from_utf8_lossy(&output.stdout);
        if let Err(why) = same_row(&page(name), &printed, row) {
            panic!("docs/measured/{name}.md: {why}");
        }
        measured += 1;
    }
    assert!(measured > 0, "no page has a row that can be measured again");
}
