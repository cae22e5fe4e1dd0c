//! Joints that slide, in model files.

use super::*;
use crate::model::ParameterPath;

fn parse(text: &str) -> Result<Model> {
    Model::parse(text, Path::new("rig.toml"))
}

/// A cart on a level rail, and a pole on it.
const CART_POLE: &str = r#"
[rig]
name = "cart-pole"
angle_zero = "upright"
[[link]]
length_m = 0.0
com_m = 0.0
mass_kg = 0.8
inertia_kg_m2 = 1e-3
[[link]]
com_m = 0.2
mass_kg = 0.15
inertia_kg_m2 = 2e-3
[[joint]]
axis = "slide"
slide_rad = 1.5707963267948966
drive = "duty"
stall_force_n = 12.0
no_load_speed_m_s = 1.5
[[joint]]
drive = "passive"
[[effect]]
kind = "coulomb"
joint = 1
force_n = 0.4
[[effect]]
kind = "delay"
joint = 1
delay_s = 0.01
[log]
time = { column = "t", unit = "s" }
[[log.joint]]
position = { column = "x", unit = "mm", offset_m = 0.1 }
velocity = { column = "v", unit = "m/s" }
input = { column = "u", unit = "1" }
[[log.joint]]
position = { column = "q", unit = "rad" }
"#;

#[test]
fn a_joint_that_slides_is_said_in_metres_and_newtons() {
    let mut model = parse(CART_POLE).unwrap();
    let slide = model.joints[0].slide.unwrap();
    assert_eq!((slide.link_rad, model.joints[1].slide), (0.0, None));
    assert!((slide.direction_rad - std::f64::consts::FRAC_PI_2).abs() < 1e-15);
    let position = model.log.joints[0].position.clone().unwrap();
    assert!((position.columns()[0].to_si(250.0) - 0.35).abs() < 1e-12);
    // The zero is that of the first joint that turns.
    assert_eq!(model.relative_rad(&[0.3, 0.0]), [0.3, std::f64::consts::PI]);
    assert_eq!(
        model.convention_rad(&[0.3, std::f64::consts::PI]),
        [0.3, 0.0]
    );
    assert_eq!(crate::model::hanging(&model)[0], 0.0);
    for (path, value, unit) in [
        ("joint1.stall_force_n", 12.0, "N"),
        ("joint1.no_load_speed_m_s", 1.5, "m/s"),
        ("coulomb@1.force_n", 0.4, "N"),
        ("delay@1.delay_s", 0.01, "s"),
    ] {
        let found: ParameterPath = path.parse().unwrap();
        assert_eq!((found.to_string(), found.unit()), (path.to_string(), unit));
        assert_eq!(found.get(&model), Some(value), "{path}");
        assert!(found.set(&mut model, 2.0 * value), "{path}");
    }
    for path in [
        "joint1.stall_torque_nm",
        "coulomb@1.torque_nm",
        "joint2.stall_force_n",
    ] {
        let found: ParameterPath = path.parse().unwrap();
        assert_eq!(found.get(&model), None, "{path}");
        assert!(!found.set(&mut model, 1.0), "{path}");
    }
    let free: Vec<String> = model.free.iter().map(ToString::to_string).collect();
    assert_eq!(free, ["coulomb@1.force_n", "delay@1.delay_s"]);
}

#[test]
fn what_a_slide_cannot_have_is_refused() {
    for (from, to, what) in [
        (
            "slide_rad = 1.5707963267948966\n",
            "",
            "[[joint]] 1 lacks `slide_rad`",
        ),
        ("slide_rad = 1.5", "slide_rad = 90.5", "`slide_rad` = 90.5"),
        (
            "stall_force_n = 12.0",
            "stall_torque_nm = 12.0",
            "unknown key `stall_torque_nm`",
        ),
        (
            "axis = \"slide\"",
            "axis = \"rail\"",
            "`axis` cannot be `rail`",
        ),
        ("axis = \"slide\"\n", "", "unknown key `slide_rad`"),
        (
            "\"x\", unit = \"mm\"",
            "\"x\", unit = \"rad\"",
            "unit `rad` measures an angle",
        ),
        ("offset_m = 0.1", "offset_rad = 0.1", "`offset_rad`"),
        (
            "\"q\", unit = \"rad\"",
            "\"q\", unit = \"mm\"",
            "unit `mm` measures a length",
        ),
        (
            "force_n = 0.4",
            "torque_nm = 0.4",
            "unknown key `torque_nm`",
        ),
        (
            "kind = \"delay\"",
            "kind = \"cogging\"",
            "`cogging` does not act on joints that slide",
        ),
        (
            "angle_zero = \"upright\"",
            "angle_zero = \"upright\"\nangles = \"absolute\"",
            "slide, and angles from the world",
        ),
        (
            "position = { column = \"x\", unit = \"mm\", offset_m = 0.1 }\n",
            "",
            "a joint that slides lacks `position`",
        ),
    ] {
        assert!(CART_POLE.contains(from), "{from}");
        let refused = parse(&CART_POLE.replacen(from, to, 1)).unwrap_err();
        assert!(refused.to_string().contains(what), "{refused}");
        assert!(refused.remedy().is_some(), "{refused}");
    }
}

#[test]
fn a_current_is_a_force_by_its_constant() {
    let text = CART_POLE
        .replace(
            "drive = \"duty\"\nstall_force_n = 12.0\nno_load_speed_m_s = 1.5",
            "drive = \"torque\"",
        )
        .replace("unit = \"1\"", "unit = \"mA\", force_constant_n_a = 20")
        .replace(
            "unit = \"mm\", offset_m = 0.1",
            "unit = \"ticks\", ticks_per_m = 8000",
        );
    let model = parse(&text).unwrap();
    let unit = |mean: &Option<crate::model::ColumnMean>| mean.clone().unwrap().columns()[0].unit;
    let current = unit(&model.log.joints[0].input);
    assert!((current.si - 0.02).abs() < 1e-15, "{current:?}");
    assert!((current.scale().unwrap() - 20.0).abs() < 1e-12);
    let ticks = unit(&model.log.joints[0].position);
    assert!(
        (ticks.si - 1.25e-4).abs() < 1e-18 && ticks.scale() == Some(8000.0),
        "{ticks:?}"
    );
}
