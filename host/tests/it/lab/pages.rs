//! A person with a log, from bringing it to a better model; keyboard alone.

use super::browser;
use crate::common::Bench;
use handstand_browser::Browser;
use serde_json::json;
use std::path::PathBuf;

/// The error in force, rad.
fn error_now(browser: &mut Browser) -> f64 {
    browser.number("Number(document.getElementById('error-now').dataset.error)")
}

#[test]
fn from_a_log_to_a_better_model_and_back() {
    let bench = Bench::new();
    let Some(mut browser) = browser() else {
        return;
    };
    let server = bench.lab_alone("");
    browser.open(&server.address);
    browser.until("location.pathname === '/s/1/data' && document.getElementById('drop')");
    browser.pictures("1-empty");

    // The log is brought, and drawn before any model reads it.
    let logs = ["a.csv", "b.csv"].map(|name| bench.path(name));
    let paths: Vec<&std::path::Path> = logs.iter().map(PathBuf::as_path).collect();
    browser.choose_files("#files", &paths);
    browser.until("document.querySelector('#raw[data-drawn]')");
    assert!(browser.text("#raw figcaption").contains("angle_rad"));
    browser.pictures("2-log");
    let model = json!(bench.get("model.toml")).to_string();
    browser.value(&format!("document.getElementById('toml').value = {model}"));
    browser.press_on("form[data-send=model] button", "Enter");
    browser.until("document.getElementById('error-now')");
    browser.until("document.getElementById('findings')");
    assert!(browser.text("#findings").contains("note"));
    browser.value(
        "window.before = true; document.querySelectorAll('[data-submit]')[1].value = 'hold_out'; \
                   document.querySelectorAll('[data-submit]')[1].form.requestSubmit()",
    );
    browser.until(
        "!window.before && document.querySelectorAll('[data-submit]')[1]?.value === 'hold_out' \
                   && document.getElementById('error-now')",
    );
    browser.pictures("3-model");

    // Compared, zoomed and shaded.
    browser.open(&format!("http://127.0.0.1:{}/s/1/compare", server.port));
    browser.until(
        "document.querySelector('#curves[data-drawn]') \
                   && document.querySelector('#scatters canvas') \
                   && document.getElementById('horizons')",
    );
    zooms_all_curves(&mut browser);
    browser.press_on("canvas.plot", "+");
    browser.press_on("[data-condition]", "Enter");
    browser.until("document.querySelector('[aria-pressed=true]')");
    browser.pictures("4-compare");
    let before = error_now(&mut browser);

    // Diagnosed; the effect added; the number falls.
    browser.open(&format!("http://127.0.0.1:{}/s/1/learn", server.port));
    browser.press_on("#diagnose", "Enter");
    browser.until("document.getElementById('verdict')");
    assert_eq!(
        browser.value("document.getElementById('verdict').dataset.verdict"),
        json!("named")
    );
    browser.pictures("5-diagnosed");
    browser.press_on(".card.found button", "Enter");
    browser.until("document.querySelector('[data-step-error=\"1\"]')");
    let after = error_now(&mut browser);
    assert!(after < 0.2 * before, "{before} -> {after}");
    browser.pictures("6-added");

    // Undone, done again, and there after the page is loaded again.
    browser.press_on("#undo", "Enter");
    browser.until("document.getElementById('redo')");
    assert_eq!(error_now(&mut browser), before);
    browser.press_on("#redo", "Enter");
    browser.until("document.getElementById('undo')");
    browser.call("Page.reload", json!({}));
    browser.until("document.readyState === 'complete' && document.getElementById('undo')");
    assert_eq!(error_now(&mut browser), after);

    // A slider is moved, and the error answers.
    browser.open(&format!("http://127.0.0.1:{}/s/1/what-if", server.port));
    browser.until("document.querySelector('#curves[data-answered]')");
    let shown = browser.text("#error-if");
    browser.press_on("[data-path=\"link1.com_m\"]", "ArrowRight");
    for _ in 0..30 {
        browser.press("ArrowRight");
    }
    let moved = format!(
        "document.getElementById('error-if').textContent !== {}",
        json!(shown)
    );
    browser.until(&moved);
    browser.press_on("#add-effect", "Enter");
    browser.until("document.querySelector('#sliders fieldset')");
    browser.pictures("7-what-if");

    for page in ["robot", "gains", "challenge"] {
        browser.open(&format!("http://127.0.0.1:{}/s/1/{page}", server.port));
        std::thread::sleep(std::time::Duration::from_millis(500));
        browser.pictures(&format!("8-{page}"));
    }
    // A challenge is played.
    browser.press_on("form[data-send=round] button", "Enter");
    browser.until(
        "location.pathname === '/s/2/compare' \
                   && document.querySelector('#curves[data-drawn]')",
    );
    browser.pictures("9-round");
    browser.open(&format!("http://127.0.0.1:{}/s/2/challenge", server.port));
    browser.press_on("#hand-in", "Enter");
    browser.until("document.getElementById('score')");
    browser.pictures("9-score");
    assert_eq!(browser.complaints, Vec::<String>::new());
}

/// One chart is zoomed and panned: all follow, and go back to what they were.
fn zooms_all_curves(browser: &mut Browser) {
    let drawn = "Array.from(document.querySelectorAll('#curves canvas'), (c) => c.toDataURL())";
    let all = |test: &str| format!("{drawn}.every((picture, i) => {test})");
    assert!(browser.number(&format!("{drawn}.length")) >= 2.0);
    browser.value(&format!("{{ window.whole = {drawn}; }}"));
    browser.press_on("#curves canvas", "+");
    browser.until(&all("picture !== whole[i]"));
    browser.value(&format!("{{ window.zoomed = {drawn}; }}"));
    browser.press("ArrowRight");
    browser.until(&all("picture !== zoomed[i] && picture !== whole[i]"));
    browser.press("0");
    browser.until(&all("picture === whole[i]"));
}

/// The robot at a port as a person sees it: the press, the questions, charts, stop; and the gains
/// of the same model.
#[test]
fn a_robot_is_balanced_and_stopped_from_its_page() {
    const MODEL: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/models/handstand.toml");
    let bench = Bench::new();
    let Some(mut browser) = browser() else {
        return;
    };
    let robot = format!("--robot sim-cm5:robot={MODEL},start=held,lean=1/-1/1");
    let words = format!("{MODEL} {robot}");
    let server = bench.lab_alone(&words);
    browser.open(&server.address);
    browser.until("document.getElementById('drop')");
    browser.open(&format!("http://127.0.0.1:{}/s/1/robot", server.port));
    let phase =
        |phase: &str| format!("document.getElementById('phase').dataset.phase === '{phase}'");
    browser.until(&phase("idle"));
    browser.press_on("#begin-balance", "Enter");
    browser.until(&phase("asking"));
    assert!(browser.text("#question").contains("without power"));
    assert_eq!(
        browser.value("document.getElementById('live-view').hidden"),
        json!(true)
    );
    browser.press_on("#agree", "Enter");
    browser.until(
        "document.getElementById('question').textContent.includes('upright') \
                   && !document.getElementById('asked').hidden",
    );
    browser.pictures("8-robot-asked");
    browser.press_on("#agree", "Enter");
    browser.until("document.getElementById('phase').textContent === 'balancing'");
    browser.until(
        "document.querySelector('#live-charts[data-drawn]') \
         && document.querySelector('#live-shape[data-drawn]')",
    );
    browser.pictures("8-robot-live");
    browser.press_on("#stop-live", "Enter");
    browser.until(&phase("ended"));
    let said = browser.text("#phase");
    assert!(
        said.contains("balanced for") && said.contains("robot.csv"),
        "{said}"
    );

    browser.open(&format!("http://127.0.0.1:{}/s/1/gains", server.port));
    browser.until("document.querySelector('#response[data-drawn]')");
    browser.press_on("#states", "ArrowRight");
    browser.until("document.getElementById('figures').textContent.includes('fixed point')");
    browser.pictures("8-gains-robot");
    assert_eq!(browser.complaints, Vec::<String>::new());
}

/// The swings of a public pendulum, thinned to 50 Hz, the first 2 s of them, where they are here.
fn public_swings() -> Option<String> {
    let Some(data) = std::env::var_os("HANDSTAND_DATA") else {
        println!("left out: HANDSTAND_DATA is not set");
        return None;
    };
    let file = PathBuf::from(data).join("multiarm/single_id.csv");
    let log = std::fs::read_to_string(file).unwrap();
    let early = |line: &&str| {
        let time = line
            .split(',')
            .nth(1)
            .and_then(|cell| cell.parse::<f64>().ok());
        time.is_none_or(|time_s| time_s < 2.0)
    };
    let mut lines = log.lines();
    let head = lines.next().unwrap();
    let rows = lines.step_by(10).filter(early);
    Some(
        std::iter::once(head)
            .chain(rows)
            .map(|line| format!("{line}\n"))
            .collect(),
    )
}

#[test]
fn a_public_log_becomes_a_better_model_by_the_pages_alone() {
    let Some(log) = public_swings() else {
        return;
    };
    let bench = Bench::new();
    bench.put("single.csv", log);
    let Some(mut browser) = browser() else {
        return;
    };
    let server = bench.lab_alone("");
    browser.open(&server.address);
    browser.until("location.pathname === '/s/1/data' && document.getElementById('drop')");
    browser.choose_files("#files", &[bench.path("single.csv").as_path()]);
    browser.until("document.querySelector('#raw[data-drawn]')");
    // What is written on the rig: zero upright, a link of this length and mass.
    for (field, value) in [
        ("angle_zero", "upright"),
        ("length_m", "0.3"),
        ("com_m", "0.14775"),
        ("mass_kg", "0.14758"),
        ("inertia_kg_m2", "1.0912e-4"),
    ] {
        browser.value(&format!(
            "{{ const field = document.querySelector('#new-model [name={field}], \
             #new-model [data-field={field}]'); field.value = '{value}'; \
             field.dispatchEvent(new Event('input', {{ bubbles: true }})); }}"
        ));
    }
    browser.press_on("#new-model button", "Enter");
    // The form leads to the curves.
    let before = error_now(&mut browser);
    browser.open(&format!("http://127.0.0.1:{}/s/1/data", server.port));
    browser.until("document.getElementById('findings')");
    browser.pictures("10-public-model");

    browser.open(&format!("http://127.0.0.1:{}/s/1/learn", server.port));
    browser.press_on("#diagnose", "Enter");
    browser.until("document.getElementById('verdict')");
    browser.pictures("11-public-diagnosed");
    browser.press_on(".card button", "Enter");
    browser.until("document.querySelector('[data-step-error=\"1\"]')");
    let after = error_now(&mut browser);
    assert!(after < 0.5 * before, "{before} -> {after}");
    browser.press_on("#undo", "Enter");
    browser.until("document.getElementById('redo')");
    assert_eq!(error_now(&mut browser), before);
    let toml = browser.value("fetch('/s/1/download/model.toml').then((file) => file.text())");
    assert!(toml.as_str().unwrap().contains("theta1"), "{toml}");
}
