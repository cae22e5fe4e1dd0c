use super::*;
use crate::motion::MotionSource;
use std::f64::consts::PI;
use std::path::Path;

const MODEL: &str = include_str!("../../../../models/handstand.toml");

fn motion() -> Motion {
    Motion {
        name: "a.csv".into(),
        source: MotionSource {
            path: "a.csv".into(),
            sha256: String::new(),
            lines: (1, 2),
        },
        time_s: vec![7.0, 7.01],
        position_rad: vec![vec![PI / 2.0, 1.5], vec![0.0, 0.2], vec![0.0, -0.1]],
        velocity_rad_s: vec![None, None, None],
        rate_rad_s: Vec::new(),
        input: vec![None, Some(vec![0.0, 1.0]), Some(vec![0.0, -2.0])],
        supply_v: None,
        torque_on: None,
        payload_kg: 0.0,
        turned: false,
    }
}

fn scene(text: &str) -> Scene {
    let model = Model::parse(text, Path::new("m.toml")).unwrap();
    Scene::measured(&model, &[motion()])
}

#[test]
fn links_stand_where_their_joints_say() {
    let near = |found: &[Vec<f64>], sample: usize, wanted: [f64; 3]| {
        for (row, wanted) in found.iter().zip(wanted) {
            assert!((row[sample] - wanted).abs() < 2e-5, "{found:?} {wanted}");
        }
    };
    let relative = scene(MODEL);
    let track = &relative.motions[0].tracks[0];
    assert_eq!(track.time_s, [0.0, 0.01]);
    near(&track.link_rad, 0, [PI; 3]);
    let first = PI / 2.0 + 1.5;
    near(&track.link_rad, 1, [first, first + 0.2, first + 0.1]);
    let absolute = scene(&MODEL.replace("\"relative\"", "\"absolute\""));
    let track = &absolute.motions[0].tracks[0];
    near(&track.link_rad, 1, [first, PI / 2.0 + 0.2, PI / 2.0 - 0.1]);
}

#[test]
fn the_handstand_hangs_on_a_bar_and_has_a_head_and_two_drives() {
    let scene = scene(MODEL);
    assert!(scene.on_bar && scene.head);
    let drives: Vec<usize> = scene.motions[0].inputs.iter().map(|i| i.joint).collect();
    assert_eq!(drives, [2, 3]);
    assert_eq!(scene.motions[0].inputs[1].values, [0.0, -2.0]);
    assert_eq!(scene.links[0].length_m, 0.1436);
}

/// A name must not end the page's data.
#[test]
fn names_cannot_break_out() {
    let scene = scene(&MODEL.replace("\"handstand\"", "\"</script><u>\""));
    let page = super::super::html(&scene, "handstand view <x>").unwrap();
    assert_eq!(page.matches("</script>").count(), 2, "its own two");
    assert!(!page.contains("<u>") && !page.contains("<x>"));
}
