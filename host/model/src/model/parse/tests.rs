mod refusals;

use super::*;
use crate::model::{ParameterPath, Robot};
use proptest::prelude::*;

const GOOD: &str = include_str!("../testdata/full.toml");

fn parse(text: &str) -> Result<Model> {
    Model::parse(text, Path::new("rig.toml"))
}

#[test]
fn everything_is_read() {
    let model = parse(GOOD).unwrap();
    assert_eq!(model.name, "everything");
    assert_eq!(model.angle_zero, AngleZero::Upright);
    assert_eq!(model.angles, Angles::Absolute);
    assert_eq!((model.gravity_m_s2, model.step_s), (9.80665, 0.001));
    assert_eq!(model.links[0].length_m, 0.15);
    assert_eq!(model.links[1].length_m, 0.12, "defaults to com_m");
    let Drive::Position {
        gain_per_rad,
        motor,
    } = &model.joints[1].drive
    else {
        panic!("joint 2 is a position drive");
    };
    assert_eq!((*gain_per_rad, motor.stall_torque_nm), (8.0, 1.5));
    assert_eq!(motor.nominal_supply_v, Some(12.0));
    assert_eq!(model.effects[1].joint, Some(1));
    assert_eq!(model.effects[1].values, [0.02]);
    let free: Vec<String> = model.free.iter().map(ToString::to_string).collect();
    assert_eq!(
        free,
        [
            "link1.inertia_kg_m2",
            "joint2.gain_per_rad",
            "coulomb@1.torque_nm"
        ]
    );
    let log = &model.log;
    assert_eq!(log.time.to_si(250.0), 0.25);
    assert_eq!(log.payload.as_ref().map(|c| c.to_si(20.0)), Some(0.02));
    assert_eq!((log.payload_at_m, log.split_at_gap_s), (0.12, Some(0.5)));
    let tick = std::f64::consts::TAU / 4096.0;
    let position = &log.joints[0].position.as_ref().unwrap().columns()[0];
    assert!((position.to_si(1024.0) - (0.1 - std::f64::consts::FRAC_PI_2)).abs() < 1e-12);
    assert_eq!(position.resolution, Some(tick), "one tick");
    let second = log.joints[1].position.as_ref().unwrap();
    assert_eq!(second.resolution(), Some(0.005));
    assert_eq!(
        log.joints[0]
            .velocity
            .as_ref()
            .map(|c| c.columns()[0].unit.name),
        Some("deg/s")
    );
}

#[test]
fn what_is_left_out_takes_its_default() {
    let text = GOOD
        .replace("gravity_m_s2 = 9.80665\nstep_s = 0.001\n", "")
        .replace("angles = \"absolute\"\n", "")
        .replace("no_load_speed_rad_s = 6.0\nnominal_supply_v = 12\n", "");
    let start = text.find("[fit]").unwrap();
    let end = text.find("[log]").unwrap();
    let model = parse(&format!("{}{}", &text[..start], &text[end..])).unwrap();
    assert_eq!((model.gravity_m_s2, model.step_s), (9.81, 0.005));
    assert_eq!(model.angles, Angles::Relative);
    let motor = model.joints[1].drive.motor().unwrap();
    assert!(motor.no_load_speed_rad_s.is_infinite());
    let free: Vec<String> = model.free.iter().map(ToString::to_string).collect();
    assert_eq!(free, ["coulomb@1.torque_nm", "delay@2.delay_s"]);
}

#[test]
fn an_error_says_place_what_was_found_and_the_remedy() {
    for (this, that, said, remedy) in [
        (
            "mass_kg = 0.2",
            "mass_kg = -1",
            "rig.toml:12:11: `mass_kg` = -1 is impossible",
            "give a number above 0, up to 1000",
        ),
        (
            "joint = 2\ndelay",
            "joint = 1\ndelay",
            "rig.toml:37:9: `delay` acts on driven joints only, and joint 1 is `passive`",
            "name a driven joint, or another effect",
        ),
        (
            "link1.inertia_kg_m2",
            "mass_kg",
            "rig.toml:44:9: `mass_kg` names no parameter",
            "write it as `link1.mass_kg`, `joint1.gain_per_rad` or `coulomb@1.torque_nm`",
        ),
    ] {
        let error = parse(&GOOD.replacen(this, that, 1)).unwrap_err();
        assert!(matches!(error, crate::error::Error::Data { .. }));
        assert_eq!(error.to_string(), said);
        assert_eq!(error.remedy().as_deref(), Some(remedy));
    }
}

#[test]
fn an_infinite_speed_is_not_fitted() {
    let text = GOOD
        .replace("no_load_speed_rad_s = 6.0\n", "")
        .replace("joint2.gain_per_rad", "joint2.no_load_speed_rad_s");
    let error = parse(&text).unwrap_err();
    assert!(error.to_string().contains("infinite"), "{error}");
}

#[test]
fn an_empty_file_lacks_its_rig() {
    let error = parse("").unwrap_err();
    assert_eq!(error.to_string(), "rig.toml:1:1: the file lacks `rig`");
}

#[test]
fn columns_count_characters_not_bytes() {
    let error = parse(&GOOD.replace("\"passive\"", "\"пассив\" # é")).unwrap_err();
    assert!(error.to_string().starts_with("rig.toml:21:9:"), "{error}");
}

#[test]
fn every_model_that_comes_along_is_read() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../models");
    let mut count = 0;
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let read = if path.extension().is_some_and(|kind| kind == "urdf") {
            let text = std::fs::read_to_string(&path).unwrap();
            Robot::parse(&text, &path, &[]).map(drop)
        } else {
            Model::load(&path).map(drop)
        };
        if let Err(error) = read {
            panic!("{error}: {}", error.remedy().unwrap_or_default());
        }
        count += 1;
    }
    assert!(count >= 10, "only {count} models");
}

/// Keys without a name that take up a value without an end once brought a parser down.
#[test]
fn nameless_keys_of_unfinished_values_are_refused() {
    for text in ["==}1\n[.", "==1''\n.=],'\n", " ==1}\n [1a\n."] {
        let error = parse(text).unwrap_err().to_string();
        assert!(error.starts_with("rig.toml:1:"), "{error}");
    }
}

/// Pieces of a model file, of a key or value, and values of every type.
const TEXT: &str = "([\\[\\]{}=\"'.,#a-z0-9_ \n-]|rig|link|joint|log|effect|= |é){0,80}";
const PATCH: &str = "[\\[\\]{}=\"a-z0-9._ \n-]{0,6}";
const VALUE: &str = "(-?[0-9]{1,3}|nan|inf|true|\"[a-z]{0,5}\"|\\[\\]|\\{\\}|\\[1, \"a\"\\])";

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn random_text_never_panics(text in TEXT) {
        let _ = parse(&text);
    }

    #[test]
    fn a_damaged_file_never_panics(
        cuts in prop::collection::vec((any::<prop::sample::Index>(), 0usize..12, PATCH), 1..6)
    ) {
        let mut text: Vec<char> = GOOD.chars().collect();
        for (at, length, with) in &cuts {
            let start = at.index(text.len());
            let end = (start + length).min(text.len());
            text.splice(start..end, with.chars());
        }
        let text: String = text.into_iter().collect();
        if let Err(error) = parse(&text) {
            let message = error.to_string();
            prop_assert!(message.starts_with("rig.toml:"), "{message}");
        }
    }

    #[test]
    fn swapped_values_never_panic(line in 0usize..70, value in VALUE) {
        let text: Vec<String> = GOOD
            .lines()
            .enumerate()
            .map(|(i, text)| match text.split_once(" = ") {
                Some((key, _)) if i == line => format!("{key} = {value}"),
                _ => text.to_string(),
            })
            .collect();
        let _ = parse(&text.join("\n"));
    }
}

#[test]
fn a_current_is_a_torque_by_its_constant() {
    let text = |unit: &str| {
        format!(
            r#"
[rig]
name = "arm"
angle_zero = "hanging"
[[link]]
com_m = 0.1
mass_kg = 0.2
inertia_kg_m2 = 1e-4
[[joint]]
drive = "torque"
[log]
time = {{ column = "t", unit = "s" }}
[[log.joint]]
position = {{ column = "q", unit = "rad" }}
input = {{ column = "i", {unit} }}
"#
        )
    };
    for (unit, si) in [("A", 1.8), ("mA", 1.8e-3)] {
        let model = parse(&text(&format!(
            "unit = \"{unit}\", torque_constant_nm_a = 1.8"
        )));
        let input = model.unwrap().log.joints[0].input.clone().unwrap();
        let found = input.columns()[0].unit;
        assert!((found.si - si).abs() < 1e-15, "{found:?}");
        assert!((found.scale().unwrap() - 1.8).abs() < 1e-12);
    }
    let lacks = parse(&text("unit = \"A\"")).unwrap_err();
    assert!(
        lacks.to_string().contains("lacks `torque_constant_nm_a`"),
        "{lacks}"
    );
    let beside = "unit = \"N m\", torque_constant_nm_a = 1.8";
    assert!(
        parse(&text(beside))
            .unwrap_err()
            .to_string()
            .contains("unknown key")
    );
}

#[test]
fn bounds_of_a_fit_narrow_what_is_possible() {
    let bounded = |bounds: &str| {
        let text = [GOOD, "\n[fit.bounds]\n", bounds].concat();
        parse(&text)
    };
    let com = "link1.com_m".parse::<ParameterPath>().unwrap();
    let possible = com.possible();
    let of = |bounds: &str| com.bounds(&bounded(bounds).unwrap());
    assert_eq!(of(""), possible);
    assert_eq!(of("\"link1.com_m\" = [0.05, 0.2]"), (0.05, 0.2));
    assert_eq!(of("\"link1.com_m\" = [0.05, inf]"), (0.05, possible.1));
    for (wrong, why) in [
        ("\"link1.com_m\" = [0.2, 0.05]", "no possible value"),
        ("\"link1.com_m\" = [0.3, 0.4]", "lies outside its bounds"),
        ("\"link1.com_m\" = 0.3", "is a float"),
        ("\"link1.com_m\" = [0.3]", "is an array"),
        ("\"link7.com_m\" = [0.0, 1.0]", "is not in this model"),
        ("link1.com_m = [0.0, 1.0]", "link1"),
    ] {
        let said = bounded(wrong).unwrap_err().to_string();
        assert!(
            said.contains(why) && said.contains("rig.toml:"),
            "{wrong}: {said}"
        );
    }
}

#[test]
fn what_is_known_beforehand_takes_part_in_every_fit() {
    let known = |text: &str| parse(&[GOOD, "\n[uncertainty]\n", text].concat());
    let of = |text: &str, path: &str| {
        let model = known(text).unwrap();
        let path: ParameterPath = path.parse().unwrap();
        assert_eq!(model.free.iter().filter(|free| **free == path).count(), 1);
        *model.uncertain(path).unwrap()
    };
    let exact = parse(GOOD).unwrap();
    assert!(exact.uncertain.is_empty());
    let com = of("\"link1.com_m\" = 0.01", "link1.com_m");
    assert_eq!(com.uncertainty, 0.01);
    assert_eq!(Some(com.given), com.path.get(&exact));
    let given = "\"link1.com_m\" = { uncertainty = 0.02, given = 0.07 }";
    assert_eq!(of(given, "link1.com_m").given, 0.07);
    // Its own goes before what is typical, and what is free has none.
    let both = "typical = true\n\"link1.com_m\" = 0.01";
    assert_eq!(of(both, "link1.com_m").uncertainty, 0.01);
    assert_eq!(of(both, "link1.mass_kg").uncertainty, 0.05);
    let model = known("typical = true").unwrap();
    for free in &exact.free {
        assert!(model.uncertain(*free).is_none(), "{free}");
    }
    for (wrong, why) in [
        ("\"link1.com_m\" = 2.0", "is impossible"),
        ("\"link1.com_m\" = 0.0", "is impossible"),
        ("\"link1.com_m\" = \"some\"", "is a string"),
        ("\"link1.com_m\" = { given = 0.1 }", "uncertainty"),
        (
            "\"link1.com_m\" = { uncertainty = 0.1, about = 2 }",
            "about",
        ),
        ("\"link7.com_m\" = 0.1", "is not in this model"),
        ("typicl = true", "typicl"),
        ("typical = 1", "is an integer"),
    ] {
        let said = known(wrong).unwrap_err().to_string();
        assert!(
            said.contains(why) && said.contains("rig.toml:"),
            "{wrong}: {said}"
        );
    }
    let free = exact
        .free
        .iter()
        .find(|path| !matches!(path, ParameterPath::Effect { .. }));
    let both = format!("\"{}\" = 0.1", free.unwrap());
    let said = known(&both).unwrap_err().to_string();
    assert!(
        said.contains("is free, and so it can have no uncertainty"),
        "{said}"
    );
}
