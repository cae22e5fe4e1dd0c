//! A person with a log alone: a model made of it, a stretch cut out, a slider left and found again.

use super::browser;
use super::models::duty_log;
use crate::common::Bench;
use handstand_browser::Browser;
use serde_json::json;

#[test]
fn a_model_is_made_of_a_log_and_the_log_is_cut() {
    let bench = Bench::new();
    bench.put("arm.csv", duty_log());
    let Some(mut browser) = browser() else {
        return;
    };
    let server = bench.lab_alone("");
    browser.open(&server.address);
    browser.until("location.pathname === '/s/1/data' && document.getElementById('drop')");
    browser.choose_files("#files", &[bench.path("arm.csv").as_path()]);
    browser.until("document.querySelector('#raw[data-drawn]')");

    // The form is filled: the drive by the columns, friction and speed limit by what servos have.
    let value = |browser: &mut Browser, field: &str| {
        let text = format!("document.querySelector('#links [data-field={field}]').value");
        browser.value(&text).as_str().unwrap().to_string()
    };
    assert_eq!(value(&mut browser, "drive"), "duty");
    for field in ["no_load_speed_rad_s", "viscous_nm_s_rad", "coulomb_nm"] {
        let number: f64 = value(&mut browser, field).parse().unwrap();
        assert!(number > 0.0, "{field}");
    }
    browser.pictures("12-form");
    // A wrong figure is marked where it stands.
    browser.value("document.querySelector('#links [data-field=mass_kg]').value = '-1'");
    browser.press_on("#new-model button", "Enter");
    browser.until("document.querySelector('#links [data-field=mass_kg][aria-invalid=true]')");
    assert_eq!(
        browser.number("document.querySelectorAll('[aria-invalid]').length"),
        1.0
    );
    browser.complaints.retain(|said| !said.contains("422"));
    browser.value("document.querySelector('#links [data-field=mass_kg]').value = '0.2'");
    browser.press_on("#new-model button", "Enter");
    browser.until(
        "location.pathname === '/s/1/compare' && document.querySelector('#curves[data-drawn]')",
    );
    assert!(browser.text(".status").contains("deg over whole motions"));

    // A slider that was moved is where it was left, and nothing of it is kept.
    let lab = format!("http://127.0.0.1:{}/s/1", server.port);
    browser.open(&format!("{lab}/what-if"));
    browser.until("document.querySelector('#curves[data-answered]')");
    let place = "document.querySelector('[data-path=\"link1.mass_kg\"]').value";
    for _ in 0..20 {
        browser.press_on("[data-path=\"link1.mass_kg\"]", "ArrowRight");
    }
    let moved = browser.value(place);
    browser.until("Object.keys(sessionStorage).some((key) => key.startsWith('what-if'))");
    browser.pictures("13-what-if-deg");
    browser.open(&format!("{lab}/data"));
    browser.open(&format!("{lab}/what-if"));
    browser
        .until("document.getElementById('message').textContent.includes('nothing of it is kept')");
    assert_eq!(browser.value(place), moved);

    // A stretch of the log, by the keys alone.
    browser.open(&format!("{lab}/data"));
    browser.until("document.querySelector('#raw[data-drawn]')");
    assert_eq!(
        browser.value("document.getElementById('cut-keep').disabled"),
        json!(true)
    );
    browser.press_on("#raw canvas", "+");
    browser.press_on("#cut-hold-out", "Enter");
    browser.until("document.querySelectorAll('[data-submit]').length === 3");
    let roles = "[...document.querySelectorAll('[data-submit]')].map((role) => role.value).join()";
    assert_eq!(browser.value(roles), json!("fit,hold_out,fit"));
    browser.until("document.querySelector('#raw[data-drawn]')");
    browser.pictures("14-cut");
    browser.press_on("#cut-whole", "Enter");
    browser.until("document.querySelectorAll('[data-submit]').length === 1");
    assert_eq!(browser.complaints, Vec::<String>::new());
}
