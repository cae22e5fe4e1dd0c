//! A report as a person uses it: charts zoom, commands are copied, and all has room.

use crate::common::Bench;
use handstand_browser::Browser;
use std::path::Path;

/// Places of the labels of a chart's time, and how far its curves are stretched.
const LABELS: &str = "[...document.querySelectorAll('#traces g.ticks text.tick')]\
                      .map((text) => text.textContent).join(' ')";
const STRETCH: &str =
    "document.querySelector('#traces g.course').transform.baseVal[0]?.matrix.a ?? 1";

fn browser() -> Option<Browser> {
    Browser::start(&Path::new(env!("CARGO_TARGET_TMPDIR")).join("report"))
}

/// Smallest width of these elements, px.
fn narrowest(browser: &mut Browser, selector: &str) -> f64 {
    browser.number(&format!(
        "Math.min(...[...document.querySelectorAll('{selector}')]\
         .map((it) => it.getBoundingClientRect().width))"
    ))
}

#[test]
fn a_report_zooms_copies_and_leaves_room_for_words() {
    let bench = Bench::new();
    let ran = bench.run("diagnose model.toml a.csv b.csv --report report.html --json");
    assert_eq!(ran.code, Some(0), "{ran:?}");
    let found = ran.json();
    // Angles of a pendulum do not tell its mass: what was found is relative to it.
    assert!(
        found["warnings"]
            .to_string()
            .contains("--known link1.mass_kg"),
        "{found}"
    );
    let Some(mut browser) = browser() else { return };
    browser.open(&format!("file://{}", bench.path("report.html").display()));

    let whole = browser.value(LABELS);
    assert_eq!(browser.number(STRETCH), 1.0);
    browser.press_on("#traces svg[tabindex]", "+");
    assert_eq!(browser.number(STRETCH), 2.0);
    let half = browser.value(LABELS);
    assert_ne!(half, whole);
    browser.press("ArrowRight");
    assert_ne!(browser.value(LABELS), half);
    browser.press("0");
    assert_eq!(browser.number(STRETCH), 1.0);
    // A stretch that is dragged over fills the chart.
    let side = |share: f64| {
        format!(
            "(() => {{ const box = document.querySelector('#traces svg').getBoundingClientRect(); \
             return box.left + {share} * box.width; }})()"
        )
    };
    let [left, right] = [0.3, 0.5].map(|share| browser.number(&side(share)));
    let up =
        browser.number("document.querySelector('#traces svg').getBoundingClientRect().top + 90");
    for (kind, x) in [
        ("mousePressed", left),
        ("mouseMoved", right),
        ("mouseReleased", right),
    ] {
        let event = serde_json::json!({
            "type": kind, "x": x, "y": up, "button": "left", "clickCount": 1,
        });
        browser.call("Input.dispatchMouseEvent", event);
    }
    let stretch = browser.number(STRETCH);
    assert!((4.0..5.5).contains(&stretch), "{stretch}");
    assert!(browser.text("#traces .readout").starts_with("at "));

    // Every command is code that a button copies.
    let commands = browser.number("document.querySelectorAll('code.command').length");
    let buttons = browser.number(
        "document.querySelectorAll('code.command ~ button.copy, pre > button.copy').length",
    );
    assert!(commands >= 3.0, "{commands}");
    assert_eq!(commands, buttons);
    assert!(
        browser
            .text(".next code.command")
            .starts_with("handstand add model.toml viscous@1")
    );

    browser.pictures("diagnosed");
    for width in [1280, 800] {
        browser.call(
            "Emulation.setDeviceMetricsOverride",
            serde_json::json!({
                "width": width, "height": 900, "deviceScaleFactor": 1, "mobile": false,
            }),
        );
        let bars = narrowest(&mut browser, ".steps svg.bar");
        assert!(bars >= 170.0, "bars of {bars} px at {width} px");
        let reasons = narrowest(&mut browser, "#candidates > .tried td:last-child");
        assert!(reasons >= 150.0, "reasons of {reasons} px at {width} px");
    }
    assert!(browser.complaints.is_empty(), "{:#?}", browser.complaints);
}
