//! How soon the lab answers: a start, 18 joints over a minute, a slider.

use super::browser;
use super::server::Server;
use crate::common::Bench;
use serde_json::json;
use std::fmt::Write as _;
use std::time::{Duration, Instant};

/// A chain of 18 links that swing freely in air so thick that they hardly move, and a log of it: a
/// minute at 100 Hz.
fn eighteen(bench: &Bench) {
    let mut model =
        String::from("[rig]\nname = \"chain\"\nangle_zero = \"hanging\"\nstep_s = 0.01\n");
    let mut log = String::from("time_s");
    for joint in 1..=18 {
        model += "\n[[link]]\nlength_m = 0.1\ncom_m = 0.05\nmass_kg = 0.1\ninertia_kg_m2 = 1e-4\n";
        model += "\n[[joint]]\ndrive = \"passive\"\n";
        let _ = write!(log, ",q{joint}");
    }
    model += "\n[log]\ntime = { column = \"time_s\", unit = \"s\" }\n";
    for joint in 1..=18 {
        let _ = writeln!(
            model,
            "\n[[log.joint]]\nposition = {{ column = \"q{joint}\", unit = \"rad\" }}"
        );
    }
    for sample in 0..6000 {
        let time = f64::from(sample) / 100.0;
        let _ = write!(log, "\n{time:.2}");
        for joint in 1..=18 {
            let angle = 0.3 * (time * (1.0 + 0.1 * f64::from(joint))).sin();
            let _ = write!(log, ",{angle:.4}");
        }
    }
    bench.put("chain.toml", model);
    bench.put("minute.csv", log);
}

#[test]
fn a_start_takes_less_than_a_second() {
    let bench = Bench::new();
    let server = Server::start(&bench, "model.toml a.csv b.csv");
    assert!(
        server.started_in < Duration::from_secs(1),
        "{:?}",
        server.started_in
    );
}

/// The promise is a second; what is drawn here is the file as it stands, while other tests run.
#[test]
#[ignore = "a time of a browser: cargo test -p handstand --test it lab::speed -- --ignored"]
fn a_minute_of_eighteen_joints_is_drawn_at_once() {
    let bench = Bench::new();
    eighteen(&bench);
    let Some(mut browser) = browser() else {
        return;
    };
    let server = Server::start_alone(&bench, "");
    browser.open(&server.address);
    browser.until("document.getElementById('drop')");
    let minute = bench.path("minute.csv");
    let begun = Instant::now();
    browser.choose_files("#files", &[&minute]);
    browser.until(
        "document.querySelectorAll('#raw canvas').length === 18 \
                   && document.querySelector('#raw[data-drawn]')",
    );
    let took = begun.elapsed();
    println!("18 joints x 60 s x 100 Hz brought and drawn in {took:?}");
    assert!(took < Duration::from_secs(5), "{took:?}");
}

/// The promise is 50 ms for one arm; the machine may be busy with other tests.
#[test]
fn a_slider_of_one_arm_answers_at_once() {
    let bench = Bench::new();
    let server = Server::start(&bench, "model.toml a.csv b.csv");
    let tried = |mass: f64| {
        let values = json!([["link1.mass_kg", mass]]);
        json!({ "effects": [], "values": values, "moving": true })
    };
    server.post("/s/1/what-if", &tried(0.2)).curves();
    let mut times: Vec<Duration> = (1..10)
        .map(|k| {
            let begun = Instant::now();
            server
                .post("/s/1/what-if", &tried(0.2 + 0.01 * f64::from(k)))
                .curves();
            begun.elapsed()
        })
        .collect();
    times.sort();
    println!("a slider of one arm answers in {:?}", times[4]);
    assert!(times[0] < Duration::from_millis(500), "{times:?}");
}
