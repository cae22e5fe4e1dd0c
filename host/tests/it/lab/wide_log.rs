//! A log as long and wide as they come is drawn.

use super::browser;
use crate::common::Bench;
use serde_json::json;
use std::fmt::Write as _;

/// Joints of the long log.
const JOINTS: usize = 18;

/// A minute of 18 joints at 100 Hz.
fn eighteen(bench: &Bench) {
    let mut log = String::from("time_s");
    for joint in 1..=JOINTS {
        let _ = write!(log, ",q{joint}");
    }
    for sample in 0..6000 {
        let time = f64::from(sample) / 100.0;
        let _ = write!(log, "\n{time:.2}");
        for joint in 1..=JOINTS {
            let angle = 0.3 * (time * (1.0 + 0.1 * joint as f64)).sin();
            let _ = write!(log, ",{angle:.4}");
        }
    }
    bench.put("minute.csv", log);
}

/// How soon is measured by `cargo xtask bench-lab`.
#[test]
fn a_minute_of_eighteen_joints_is_drawn() {
    let bench = Bench::new();
    eighteen(&bench);
    let Some(mut browser) = browser() else {
        return;
    };
    let server = bench.lab_alone("");
    // So tall that every chart is in sight: what is not is not drawn.
    let tall = json!({ "width": 1280, "height": 5000, "deviceScaleFactor": 1, "mobile": false });
    browser.call("Emulation.setDeviceMetricsOverride", tall);
    browser.open(&server.address);
    browser.until("document.getElementById('drop')");
    let minute = bench.path("minute.csv");
    browser.choose_files("#files", &[&minute]);
    browser.until(
        "document.querySelectorAll('#raw canvas').length === 18 \
                   && document.querySelector('#raw[data-drawn]')",
    );
    let shown = browser.value("document.querySelectorAll('#raw figcaption')[17].textContent");
    assert!(shown.as_str().unwrap().contains("q18"), "{shown}");
    // Something stands on the first canvas: not all of its pixels are alike.
    let alike = browser.value(
        "(() => { const canvas = document.querySelector('#raw canvas'); \
         const pixels = new Uint32Array(canvas.getContext('2d').getImageData(0, 0, canvas.width, \
         canvas.height).data.buffer); return pixels.every((pixel) => pixel === pixels[0]); })()",
    );
    assert_eq!(alike, json!(false));
    assert_eq!(browser.complaints, Vec::<String>::new());
}
