//! A report as a browser shows it: it is drawn, and nothing is loaded from elsewhere.
//!
//! Needs a Chromium on the path; without one the picture is left out, and the test says so.

#[allow(dead_code)] // each test file needs a part of it
mod common;

use common::Bench;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

const WIDTH: u32 = 1100;
const HEIGHT: u32 = 1600;
/// A picture of one colour is far smaller than this.
const LEAST_BYTES: usize = 20_000;
/// Longer than any browser takes to draw a page.
const PATIENCE: Duration = Duration::from_secs(60);

#[test]
fn a_report_is_drawn_and_loads_nothing() {
    let bench = Bench::new();
    let ran = bench.run("compare model.toml a.csv b.csv --report report.html");
    assert_eq!(ran.code, Some(0), "{ran:?}");
    let page = bench.get("report.html");
    for loaded in [
        "src=\"http",
        "href=\"http",
        "src=\"//",
        "href=\"//",
        "url(",
        "@import",
        "<script src",
        "<link",
    ] {
        assert!(!page.contains(loaded), "the page holds {loaded}");
    }
    let Some(chromium) = chromium() else {
        println!("skipped: there is no chromium on the path, so the report is not drawn");
        return;
    };
    let picture = bench.path("report.png");
    draw(
        &chromium,
        &bench.path("report.html"),
        &picture,
        &bench.path("profile"),
    );
    let png = std::fs::read(&picture).unwrap();
    assert_eq!(&png[..8], b"\x89PNG\r\n\x1a\n");
    let number = |at: usize| u32::from_be_bytes(png[at..at + 4].try_into().unwrap());
    assert_eq!((number(16), number(20)), (WIDTH, HEIGHT));
    assert!(png.len() > LEAST_BYTES, "blank: {} bytes", png.len());
}

fn chromium() -> Option<PathBuf> {
    let path = std::env::var_os("PATH")?;
    let folders: Vec<PathBuf> = std::env::split_paths(&path).collect();
    ["chromium", "chromium-browser", "google-chrome"]
        .iter()
        .flat_map(|name| folders.iter().map(move |folder| folder.join(name)))
        .find(|program| program.is_file())
}

fn draw(chromium: &Path, page: &Path, picture: &Path, profile: &Path) {
    let mut child = Command::new(chromium)
        .args([
            "--headless",
            "--no-sandbox",
            "--disable-gpu",
            "--no-first-run",
            "--hide-scrollbars",
        ])
        .args([
            "--disable-background-networking",
            "--disable-component-update",
            "--disable-sync",
        ])
        .arg(format!("--user-data-dir={}", profile.display()))
        .arg(format!("--window-size={WIDTH},{HEIGHT}"))
        .arg(format!("--screenshot={}", picture.display()))
        .arg(format!("file://{}", page.display()))
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    let begun = Instant::now();
    while child.try_wait().unwrap().is_none() {
        if begun.elapsed() > PATIENCE {
            // It may be over before it is ended.
            let _ = child.kill();
            let _ = child.wait();
            panic!("the browser drew nothing in {PATIENCE:?}");
        }
        std::thread::sleep(Duration::from_millis(50));
    }
}
