//! A robot in space, animated in the lab as `handstand view` does.

use super::browser;
use crate::common::Bench;
use std::fmt::Write as _;

/// A turret with an arm: axes that are not parallel.
const TURRET: &str = r#"<robot name="turret">
<link name="base"><visual><geometry><box size="0.1 0.1 0.02"/></geometry></visual></link>
<link name="turret"><inertial><origin xyz="0 0 0.05"/><mass value="0.5"/>
<inertia ixx="1e-3" iyy="1e-3" izz="1e-3"/></inertial></link>
<link name="arm"><visual><geometry><mesh filename="arm.stl"/></geometry></visual>
<inertial><origin xyz="0.1 0 0"/><mass value="0.2"/>
<inertia ixx="1e-4" iyy="1e-3" izz="1e-3"/></inertial></link>
<joint name="slew" type="continuous"><parent link="base"/><child link="turret"/>
<axis xyz="0 0 1"/></joint>
<joint name="lift" type="continuous"><parent link="turret"/><child link="arm"/>
<origin xyz="0 0 0.1"/><axis xyz="0 1 0"/></joint></robot>"#;

/// It swings by its own weight, or nearly so.
fn log() -> String {
    let mut text = String::from("time_s,slew.position,slew.effort,lift.position,lift.effort\n");
    for k in 0..200 {
        let t = f64::from(k) * 0.01;
        let _ = writeln!(
            text,
            "{t:.2},{:.4},0,{:.4},0",
            0.1 * t,
            1.5 - 0.3 * (7.0 * t).cos()
        );
    }
    text
}

#[test]
fn the_page_of_the_robot_shows_one_in_space() {
    let bench = Bench::new();
    bench.put("turret.urdf", TURRET);
    bench.put("log.csv", log());
    let ran = bench.run("import turret.urdf --driven -o turret.toml");
    assert_eq!(ran.code, Some(0), "{ran:?}");
    let server = bench.lab("turret.toml log.csv");
    let stage = server.get("/s/1/stage");
    assert_eq!(stage.status, 200, "{}", stage.text());
    for part in [
        "\"name\":\"lift\"",
        "/assets/view-space.js",
        "id=\"surfaces\"",
        "arm (arm.stl: no such file)",
        "model 0",
    ] {
        assert!(stage.text().contains(part), "the page lacks {part}");
    }
    // Meshes lie beside the file that the session's copy is of.
    let mesh = include_str!("../../../../tests/fuzz/corpus/mesh/ascii.stl");
    bench.put("arm.stl", mesh);
    let stage = server.get("/s/1/stage").text();
    assert!(!stage.contains("no such file"), "{stage}");
    let script = server.get("/assets/view-space.js").text();
    assert!(script.contains("const linkPoses"));
    let Some(mut browser) = browser() else { return };
    browser.open(&server.address);
    browser.open(&format!("http://127.0.0.1:{}/s/1/robot", server.port));
    let stage = "document.querySelector('iframe.stage')?.contentDocument";
    browser.until(&format!(
        "{stage}?.getElementById('clock')?.textContent.startsWith('0.00 /')"
    ));
    let names = browser.value(&format!("{stage}.getElementById('angles').textContent"));
    let names = names.as_str().unwrap_or_default();
    assert!(names.contains("slew") && names.contains("lift"), "{names}");
    browser.pictures("robot-in-space");
    assert!(browser.complaints.is_empty(), "{:?}", browser.complaints);
}
