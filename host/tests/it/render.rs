//! Pages as a browser shows them: they are drawn, and nothing is loaded from elsewhere.
//!
//! Needs a Chromium on the path; without one the picture is left out, and the test says so.

use crate::common::Bench;
use handstand::sim::closed_loop::{ClosedLoop, Commands, InitialState, StateFeedback, stream};
use std::f64::consts::FRAC_PI_2;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

const WIDTH: u32 = 1100;
const HEIGHT: u32 = 1600;
/// A picture of one colour is far smaller than this.
const LEAST_BYTES: usize = 20_000;
/// A browser without a window that asks the network for nothing.
const HEADLESS: [&str; 8] = [
    "--headless",
    "--no-sandbox",
    "--disable-gpu",
    "--no-first-run",
    "--hide-scrollbars",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
];
/// Longer than any browser takes to draw a page.
const PATIENCE: Duration = Duration::from_secs(60);

#[test]
fn a_report_is_drawn_and_loads_nothing() {
    let bench = Bench::new();
    let ran = bench.run("compare model.toml a.csv b.csv --report report.html");
    assert_eq!(ran.code, Some(0), "{ran:?}");
    is_drawn(&bench, "report");
}

#[test]
fn the_paper_s_page_is_drawn_and_loads_nothing() {
    let bench = Bench::new();
    let ran = bench.run("paper --report paper.html");
    assert_eq!(ran.code, Some(0), "{ran:?}");
    let page = bench.get("paper.html");
    for part in [
        "Figure 4:",
        "Figure 14 b,d,f:",
        "misprint: sign lost",
        "An animation",
    ] {
        assert!(page.contains(part), "the page lacks {part}");
    }
    is_drawn(&bench, "paper");
}

/// The page's own script has run: the clock stands at the time that the address asks for.
#[test]
fn a_view_plays_the_handstand() {
    let bench = Bench::new();
    bench.put("handstand.toml", HANDSTAND);
    bench.put("run.csv", balanced(0.02));
    bench.put("other.csv", balanced(-0.01));
    let ran = bench.run(
        "view handstand.toml run.csv --model handstand.toml --overlay other.csv -o view.html \
         --horizon 0.2",
    );
    assert_eq!(ran.code, Some(0), "{ran:?}");
    is_drawn(&bench, "view");
    let again = bench.run("view handstand.toml run.csv -o view.html");
    assert_eq!(again.code, Some(2), "{again:?}");
    let Some(chromium) = chromium() else { return };
    let shown = Command::new(&chromium)
        .args(HEADLESS)
        .arg(format!("--user-data-dir={}", bench.path("dom").display()))
        .args(["--timeout=20000", "--dump-dom"])
        .arg(format!(
            "file://{}#t=0.5",
            bench.path("view.html").display()
        ))
        .stderr(Stdio::null())
        .output()
        .unwrap();
    let dom = String::from_utf8_lossy(&shown.stdout);
    assert!(dom.contains("0.50 / 2.00 s"), "{}", dom.len());
    for part in [
        "joint 2, torque",
        "handstand.toml</label>",
        "other.csv</label>",
    ] {
        assert!(dom.contains(part), "the page lacks {part}");
    }
}

const HANDSTAND: &str = include_str!("../../models/handstand.toml");

/// Two seconds of the handstand under the paper's sampled gains, from this lean of the arms.
fn balanced(lean_rad: f64) -> String {
    let model = handstand::Model::parse(HANDSTAND, Path::new("handstand.toml")).unwrap();
    let pose = [FRAC_PI_2, 0.0, 0.0];
    let closed = ClosedLoop::new(&model, &pose, Commands::Torque, 0.01).unwrap();
    let controller = StateFeedback::new(
        3,
        vec![
            vec![
                -75.758443, -32.187228, -11.454290, -13.004784, -6.2134254, -2.3441985,
            ],
            vec![
                -62.056988, -26.928273, -9.0350845, -10.653945, -5.1619377, -1.8225471,
            ],
        ],
    );
    let mut text = String::from(
        "time_s,q1_rad,dq1_rad_s,q2_rad,dq2_rad_s,torque2_nm,q3_rad,dq3_rad_s,torque3_nm\n",
    );
    let start = InitialState::at([lean_rad, 0.0, 0.0]);
    closed.watch(&controller, &start, 2.0, stream(1, 0), |sample| {
        let (q, w, u) = (sample.angle_rad, sample.speed_rad_s, sample.command);
        let _ = writeln!(
            text,
            "{:.2},{},{},{},{},{},{},{},{}",
            sample.time_s,
            q[0] + FRAC_PI_2,
            w[0],
            q[1],
            w[1],
            u[0],
            q[2],
            w[2],
            u[1]
        );
    });
    text
}

/// `NAME.html` asks for nothing from elsewhere, and a browser makes a picture of it that is not
/// blank.
fn is_drawn(bench: &Bench, name: &str) {
    let page = bench.get(&format!("{name}.html"));
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
        // What an address within the page names is there.
        let page = page.replace("url(#", "");
        assert!(!page.contains(loaded), "the page holds {loaded}");
    }
    let Some(chromium) = chromium() else {
        println!("skipped: there is no chromium on the path, so {name} is not drawn");
        return;
    };
    let picture = bench.path(&format!("{name}.png"));
    draw(
        &chromium,
        &bench.path(&format!("{name}.html")),
        &picture,
        &bench.path(&format!("{name}-profile")),
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
        .args(HEADLESS)
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
