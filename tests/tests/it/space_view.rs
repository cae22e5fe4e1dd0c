//! The animation of a robot in space: its frames in a browser are those of the equations.

use crate::import::Draws;
use crate::space::{CRANE, import_crane, mjcf, model, run, swung, urdf};
use handstand::Model;
use handstand::report::playback::Scene;
use handstand_browser::Browser;
use serde_json::{Value, json};
use std::path::{Path, PathBuf};
use tempfile::TempDir;

const TREES: u64 = 60;
/// Of a page's own rounding, m and parts of axes.
const NEAR: f64 = 1e-7;

/// A browser whose pictures go into the target folder.
fn browser() -> Option<Browser> {
    Browser::start(&Path::new(env!("CARGO_TARGET_TMPDIR")).join("view"))
}

/// A folder with the crane, its model, that with friction at a joint, two logs, and a mesh of the
/// boom.
fn crane() -> (TempDir, Model) {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    let seen = "<link name=\"boom\"><visual><origin xyz=\"0 0 -0.15\"/><geometry>\
                <mesh filename=\"boom.stl\" scale=\"0.001 0.001 0.001\"/></geometry></visual>";
    let lost = "<link name=\"head\"><visual><geometry><mesh filename=\"lost.stl\"/></geometry>\
                </visual>";
    let text = CRANE.replace("<link name=\"boom\">", seen);
    let text = text.replace("<link name=\"head\">", lost);
    std::fs::write(at.join("boom.stl"), wedge()).unwrap();
    import_crane(at, &text);
    let model = Model::load(&at.join("crane.toml")).unwrap();
    let text = std::fs::read_to_string(at.join("crane.toml")).unwrap()
        + "\n[[effect]]\nkind = \"viscous\"\njoint = \"luff\"\ncoefficient_nm_s_rad = 0.06\n";
    std::fs::write(at.join("better.toml"), text).unwrap();
    for (number, name) in ["a.csv", "b.csv"].into_iter().enumerate() {
        std::fs::write(at.join(name), swung(&model, number)).unwrap();
    }
    (folder, model)
}

/// A wedge of 40 x 40 x 300 mm about its centre, in ASCII.
fn wedge() -> String {
    let [a, b, c] = [[-20, -20], [20, -20], [0, 20]];
    let corner = |[x, y]: [i32; 2], z: i32| format!("vertex {x} {y} {z}\n");
    let mut text = String::from("solid wedge\n");
    let mut facet = |corners: [String; 3]| {
        text += "facet normal 0 0 0\nouter loop\n";
        text += &corners.concat();
        text += "endloop\nendfacet\n";
    };
    facet([corner(c, -150), corner(b, -150), corner(a, -150)]);
    facet([corner(a, 150), corner(b, 150), corner(c, 150)]);
    for (from, to) in [(a, b), (b, c), (c, a)] {
        facet([corner(from, -150), corner(to, -150), corner(to, 150)]);
        facet([corner(from, -150), corner(to, 150), corner(from, 150)]);
    }
    text + "endsolid wedge\n"
}

/// Something that a hand does to a page.
type Act<'a> = &'a dyn Fn(&mut Browser);

/// Drags over the picture with a button, 8 for Shift.
fn drag(browser: &mut Browser, buttons: u32, modifiers: u32) {
    let (button, end) = if buttons == 1 {
        ("left", 350)
    } else {
        ("right", 370)
    };
    for (kind, x) in [
        ("mousePressed", 300),
        ("mouseMoved", end),
        ("mouseReleased", end),
    ] {
        let event = json!({
            "type": kind, "x": x, "y": 300, "button": button, "buttons": buttons,
            "modifiers": modifiers, "clickCount": 1,
        });
        browser.call("Input.dispatchMouseEvent", event);
    }
}

/// Two fingers that part.
fn pinch(browser: &mut Browser) {
    for (kind, apart) in [("touchStart", 60), ("touchMove", 160), ("touchEnd", 0)] {
        let finger = |id: i32, x: i32| json!({ "id": id, "x": x, "y": 300 });
        let fingers = match apart {
            0 => json!([]),
            _ => json!([finger(1, 400 - apart), finger(2, 400 + apart)]),
        };
        let event = json!({ "type": kind, "touchPoints": fingers });
        browser.call("Input.dispatchTouchEvent", event);
    }
}

fn address(page: &Path, fragment: &str) -> String {
    format!("file://{}#{fragment}", page.display())
}

/// The page is one file, and says what it shows; a robot that is not like it is refused.
#[test]
fn a_log_of_a_robot_in_space_becomes_a_page() {
    let (folder, _) = crane();
    let at = folder.path();
    let view = [
        "view",
        "crane.toml",
        "a.csv",
        "--model",
        "better.toml",
        "--overlay",
        "b.csv",
        "--horizon",
        "0.2",
        "-o",
        "crane.html",
        "--json",
    ];
    let (data, told) = run(at, &view);
    let lost = json!([{ "link": "head", "mesh": "lost.stl", "why": "no such file" }]);
    assert_eq!(data["not_drawn"], lost);
    assert!(told.contains("head (lost.stl: no such file)"), "{told}");
    let page = std::fs::read_to_string(at.join("crane.html")).unwrap();
    for part in ["\"name\":\"luff\"", "id=\"surfaces\"", "\"name\":\"b.csv\""] {
        assert!(page.contains(part), "the page lacks {part}");
    }
    for loaded in [
        "src=\"http",
        "href=\"http",
        "<script src",
        "<link",
        "@import",
    ] {
        assert!(!page.contains(loaded), "the page holds {loaded}");
    }
    assert!(page.len() < 2_000_000, "{}", page.len());
    let Some(mut browser) = browser() else { return };
    browser.open(&address(&at.join("crane.html"), "t=1"));
    browser.until("document.getElementById('clock').textContent.startsWith('1.00 /')");
    let names = browser.text("#angles");
    assert!(names.contains("slew") && names.contains("roll"), "{names}");
    assert!(browser.text("#drives").contains("luff, torque"));
    // What is drawn with the page's own script changes as the view turns, with surfaces or lines.
    let shown = "(() => { dispatchEvent(new Event('resize')); return ['surfaces', 'stage'] \
                 .map((id) => document.getElementById(id).toDataURL()).join(); })()";
    let before = browser.value(shown);
    assert_eq!(browser.value(shown), before);
    for key in ["l", "u", "n", "r"] {
        browser.press(key);
    }
    let named = browser.value(shown);
    assert_ne!(named, before, "names of joints");
    browser.press("n");
    assert_eq!(browser.value(shown), before, "the first view again");
    let wheel = json!({ "type": "mouseWheel", "x": 300, "y": 300, "deltaX": 0, "deltaY": 150 });
    let moves: [(&str, Act); 6] = [
        ("a key", &|browser| browser.press("j")),
        ("a drag", &|browser| drag(browser, 1, 0)),
        ("a drag with Shift", &|browser| drag(browser, 1, 8)),
        ("the right button", &|browser| drag(browser, 2, 0)),
        ("the wheel", &|browser| {
            browser.call("Input.dispatchMouseEvent", wheel.clone());
        }),
        ("two fingers", &pinch),
    ];
    let mut views = vec![before.clone()];
    for (what, act) in moves {
        act(&mut browser);
        let view = browser.value(shown);
        assert!(!views.contains(&view), "{what} changes the view");
        views.push(view);
        browser.press("r");
        assert_eq!(browser.value(shown), before, "the first view after {what}");
    }
    browser.pictures("crane");
    assert!(browser.complaints.is_empty(), "{:?}", browser.complaints);
}

#[test]
fn models_of_other_robots_are_not_drawn_over_each_other() {
    let (folder, _) = crane();
    let at = folder.path();
    let model = std::fs::read_to_string(at.join("crane.toml")).unwrap();
    let urdf = std::fs::read_to_string(at.join("crane.urdf")).unwrap();
    std::fs::write(at.join("other.urdf"), urdf.replace("\"roll\"", "\"turn\"")).unwrap();
    let other = model.replace("crane.urdf", "other.urdf");
    let other: Vec<&str> = (other.lines())
        .filter(|line| !line.starts_with("robot_sha256"))
        .collect();
    let other = other.join("\n").replace("\"roll\"", "\"turn\"");
    std::fs::write(at.join("other.toml"), other).unwrap();
    let view = ["view", "crane.toml", "a.csv", "--model", "other.toml"];
    let output = std::process::Command::new(crate::program())
        .current_dir(at)
        .args(view)
        .args(["-o", "crane.html"])
        .output()
        .unwrap();
    let told = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "{told}");
    assert!(told.contains("slew, luff, turn"), "{told}");
    assert!(!at.join("crane.html").exists());
}

/// A model of a tree drawn at random, its file in a folder.
fn drawn(folder: &Path, number: u64) -> Model {
    let mut draws = Draws(number);
    let ((text, _), ending) = match number % 2 {
        0 => (urdf(&mut draws), "urdf"),
        _ => (mjcf(&mut draws), "xml"),
    };
    let file = folder.join(format!("{number}.{ending}"));
    std::fs::write(&file, &text).unwrap();
    model(&text, &file, &[]).0
}

/// The robots of `HANDSTAND_DATA`, if there are any.
fn owners(folder: &Path) -> Vec<Model> {
    let Ok(data) = std::env::var("HANDSTAND_DATA") else {
        return Vec::new();
    };
    let robots = ["so100", "so101_new_calib"].map(|name| {
        let text = std::fs::read_to_string(format!("{data}/robots/so101/{name}.urdf")).unwrap();
        let file: PathBuf = folder.join(format!("{name}.urdf"));
        std::fs::write(&file, &text).unwrap();
        model(&text, &file, &[]).0
    });
    robots.into()
}

#[test]
fn frames_in_a_browser_are_those_of_the_equations() {
    let Some(mut browser) = browser() else { return };
    let (folder, _) = crane();
    let at = folder.path();
    run(at, &["view", "crane.toml", "a.csv", "-o", "crane.html"]);
    browser.open(&address(&at.join("crane.html"), "t=0"));
    let mut robots: Vec<Model> = (0..TREES).map(|number| drawn(at, number)).collect();
    robots.extend(owners(at));
    let mut draws = Draws(7);
    let mut worst = 0.0f64;
    for model in &robots {
        let tree = model.tree().unwrap();
        let angles: Vec<f64> = tree.links.iter().map(|_| 3.0 * draws.next()).collect();
        let scene = serde_json::to_value(Scene::measured(model, &[])).unwrap();
        let found = browser.value(&format!("linkPoses({}, {})", scene["tree"], json!(angles)));
        let found: Vec<Vec<f64>> = serde_json::from_value(found).unwrap();
        let wanted = tree.poses(&angles);
        assert_eq!(found.len(), wanted.len());
        for (found, wanted) in found.iter().zip(&wanted) {
            let wanted = wanted.to_homogeneous();
            assert_eq!(found.len(), 16);
            for (found, wanted) in found.iter().zip(wanted.as_slice()) {
                worst = worst.max((found - wanted).abs());
            }
        }
    }
    assert!(worst < NEAR, "{worst:.1e}");
    println!("{} robots, largest difference {worst:.1e}", robots.len());
    assert_eq!(
        browser.value("linkPoses({ links: [] }, [])"),
        Value::Array(Vec::new())
    );
}
