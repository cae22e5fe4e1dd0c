//! Plots of the residual, in a browser: what a known signal must look like.

use super::browser;
use crate::common::Bench;
use serde_json::Value;

/// 40.96 s of a sine of 7 Hz and amplitude 2 on an offset, read at 100 Hz; and as many draws of a
/// generator that is known, evenly from -1 to 1.
const SIGNALS: &str = "\
const sine = Array.from({ length: 4096 }, (_, k) => 5 + 2 * Math.sin(2 * Math.PI * 7 * k / 100));
let state = 12345;
const noise = Array.from({ length: 4096 }, () => {
  state = (1103515245 * state + 12345) % 2147483648;
  return state / 1073741824 - 1;
});";

/// Dots of a canvas, by their colour, which lines and text have not: how x and y go together.
const DOTS: &str = "\
(() => {
  const canvas = document.querySelector('#xy'), pen = canvas.getContext('2d');
  const { data, width, height } = pen.getImageData(0, 0, canvas.width, canvas.height);
  let n = 0, x = 0, y = 0, xx = 0, yy = 0, xy = 0;
  for (let row = 0; row < height; row++) for (let column = 0; column < width; column++) {
    const [r, g, b, a] = data.slice(4 * (row * width + column), 4 * (row * width + column) + 4);
    if (a === 0 || b - r < 60) continue;
    const up = height - row;
    n++; x += column; y += up; xx += column * column; yy += up * up; xy += column * up;
  }
  return [n, (n * xy - x * y) / Math.sqrt((n * xx - x * x) * (n * yy - y * y))];
})()";

#[test]
fn a_sine_stands_where_it_belongs_and_noise_is_white() {
    let bench = Bench::new();
    let Some(mut browser) = browser() else {
        return;
    };
    let server = bench.lab_alone("model.toml a.csv");
    browser.open(&server.address);
    browser.until("document.getElementById('drop')");
    browser.open(&server.page("compare"));
    browser.until("document.querySelector('#curves[data-drawn]') && document.querySelector('#xy')");

    let found = browser.value(&format!(
        "import('/assets/residual.js').then(({{ autocorrelation, spectrum }}) => {{ {SIGNALS}
           const [hz, density] = spectrum(sine, 0.01);
           const [, white] = spectrum(noise, 0.01);
           const power = (density) => density.reduce((sum, d) => sum + d * d, 0) * (hz[1] - hz[0]);
           const lags = autocorrelation(noise), band = 1.96 / Math.sqrt(noise.length);
           return {{ peak: hz[density.indexOf(Math.max(...density))], power: power(density),
             white: power(white), memory: autocorrelation(sine),
             within: lags.filter((r) => Math.abs(r) < band).length / lags.length }};
         }})"
    ));
    let number = |key: &str| {
        found[key]
            .as_f64()
            .unwrap_or_else(|| panic!("{key}: {found}"))
    };
    // A bin is 0.1 Hz wide; the power of a sine is half its amplitude's square.
    assert!((number("peak") - 7.0).abs() < 0.06, "{}", number("peak"));
    assert!((number("power") - 2.0).abs() < 0.02, "{}", number("power"));
    assert!(
        (number("white") - 1.0 / 3.0).abs() < 0.02,
        "{}",
        number("white")
    );
    assert!(number("within") > 0.9, "{}", number("within"));
    // Seven periods are 100 samples; half a period later it is the other way round.
    let memory = |lag: usize| found["memory"][lag - 1].as_f64().unwrap();
    assert!((memory(100) - 1.0).abs() < 0.03, "{}", memory(100));
    assert!(memory(50) < -0.9, "{}", memory(50));

    // Any quantity over any other: over itself it is a straight line, over another one it is not.
    let choose = |x: &str, y: &str| {
        format!(
            "(() => {{ for (const [id, name] of [['xy-x', '{x}'], ['xy-y', '{y}']]) {{
               const select = document.getElementById(id);
               select.value = name;
               select.dispatchEvent(new Event('change'));
             }} return document.getElementById('xy-name').textContent; }})()"
        )
    };
    browser.until("document.getElementById('xy-x').options.length > 2");
    browser.value(&choose("angle", "angle"));
    let [dots, together] = numbers(&browser.value(DOTS));
    assert!(dots > 100.0 && together > 0.99, "{dots} dots, {together}");
    let name = browser.value(&choose("speed", "angle"));
    let name = name.as_str().unwrap();
    assert!(
        name.starts_with("angle") && name.contains(" over speed"),
        "{name}"
    );
    let [dots, together] = numbers(&browser.value(DOTS));
    assert!(
        dots > 100.0 && together.abs() < 0.5,
        "{dots} dots, {together}"
    );
    assert_eq!(browser.complaints, Vec::<String>::new());
}

fn numbers(list: &Value) -> [f64; 2] {
    [0, 1].map(|at| list[at].as_f64().unwrap_or_else(|| panic!("{list}")))
}
