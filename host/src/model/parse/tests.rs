use super::*;
use crate::model::{PathReason, TomlReason};
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

/// Replace this by that in the good file; the complaint's place, message and remedy must hold
/// these.
#[rustfmt::skip]
const REFUSED: &[(&str, &str, &str, &str, &str)] = &[
    // Keys.
    ("mass_kg = 0.2", "mas_kg = 0.2", "12:1", "unknown key `mas_kg` in [[link]] 1",
     "did you mean `mass_kg`? known here: length_m"),
    ("length_m = 0.15", "length_mm = 150", "10:1", "key `length_mm` ends in `_mm`",
     "write `length_m`, in m"),
    ("com_m = 0.10", "com = 0.10", "11:1", "key `com` does not say its unit",
     "write `com_m`, in m"),
    ("step_s = 0.001", "step_ms = 1", "7:1", "`step_ms`", "write `step_s`, in s"),
    ("gain_per_rad = 8", "gain = 8", "25:1", "does not say its unit", "`gain_per_rad`, in 1/rad"),
    ("[fit]", "[fti]", "43:2", "unknown key `fti` in the file", "did you mean `fit`?"),
    ("[rig]", "[Rig]", "2:2", "unknown key `Rig`", "did you mean `rig`?"),
    ("free = [", "fre = [", "44:1", "unknown key `fre` in [fit]", "`free`"),
    ("segment = \"segment\"", "segmnt = \"segment\"", "48:1", "unknown key `segmnt` in [log]",
     "`segment`"),
    ("torque_nm = 0.02", "torque = 0.02", "33:1", "does not say its unit", "`torque_nm`, in N m"),
    ("offset_rad = 0.1", "offset_deg = 6", "56:70", "`offset_deg` ends in `_deg`",
     "`offset_rad`, in rad"),
    ("unit = \"ms\"", "unit = \"ms\", reversed = true", "47:40", "unknown key `reversed`",
     "known here: column"),
    ("drive = \"passive\"", "drive = \"passive\"\nstall_torque_nm = 1", "22:1",
     "unknown key `stall_torque_nm`", "known here: drive"),
    // Missing.
    ("name = \"everything\"\n", "", "2:1", "[rig] lacks `name`", "add `name`"),
    ("angle_zero = \"upright\"", "", "2:1", "[rig] lacks `angle_zero`", "add"),
    ("mass_kg = 0.2\n", "", "9:1", "[[link]] 1 lacks `mass_kg`", "add `mass_kg = ...`, in kg"),
    ("length_m = 0.15\n", "", "9:1", "[[link]] 1 lacks `length_m`", "in m"),
    ("stall_torque_nm = 1.5\n", "", "23:1", "[[joint]] 2 lacks `stall_torque_nm`", "in N m"),
    ("gain_per_rad = 8\n", "", "23:1", "[[joint]] 2 lacks `gain_per_rad`", "in 1/rad"),
    ("drive = \"passive\"", "", "20:1", "[[joint]] 1 lacks `drive`", "add"),
    ("torque_nm = 0.02 # felt by hand", "", "30:1", "[[effect]] 1 lacks `torque_nm`", "in N m"),
    ("kind = \"coulomb\"", "", "30:1", "lacks `kind`", "add"),
    ("kind = \"coulomb\"\njoint = 1", "kind = \"coulomb\"", "30:1", "lacks `joint`", "add"),
    ("time = { column = \"t_ms\", unit = \"ms\" }\n", "", "46:1", "[log] lacks `time`", "add"),
    ("ticks_per_turn = 4096, ", "", "56:12", "lacks `ticks_per_turn`", "add"),
    ("column = \"pos2\", ", "", "60:12", "lacks `column`", "add"),
    (", at_m = 0.12", "", "51:11", "lacks `at_m`", "in m"),
    // Types and values.
    ("mass_kg = 0.2", "mass_kg = \"0.2\"", "12:11", "`mass_kg` is a string", "it must be a number"),
    ("mass_kg = 0.2", "mass_kg = nan", "12:11", "`mass_kg` is NaN", "above 0"),
    ("mass_kg = 0.2", "mass_kg = inf", "12:11", "`mass_kg` is inf", "above 0"),
    ("mass_kg = 0.2", "mass_kg = 0", "12:11", "`mass_kg` = 0 is impossible", "above 0"),
    ("mass_kg = 0.2", "mass_kg = -1", "12:11", "`mass_kg` = -1 is impossible", "above 0"),
    ("inertia_kg_m2 = 1.2e-4", "inertia_kg_m2 = -1e-4", "13:17", "impossible", "from 0"),
    ("length_m = 0.15", "length_m = -0.15", "10:12", "impossible", "from 0"),
    ("gravity_m_s2 = 9.80665", "gravity_m_s2 = 981", "6:16", "impossible", "from 0 to 100"),
    ("step_s = 0.001", "step_s = 0", "7:10", "impossible", "from 0.00001 to 0.1"),
    ("step_s = 0.001", "step_s = 0.2", "7:10", "impossible", "from 0.00001 to 0.1"),
    ("stall_torque_nm = 1.5", "stall_torque_nm = 0", "26:19", "impossible", "above 0"),
    ("name = \"everything\"", "name = \"\"", "3:8", "`name` is empty", "name"),
    ("name = \"everything\"", "name = 7", "3:8", "`name` is an integer", "text in quotes"),
    ("angle_zero = \"upright\"", "angle_zero = \"uprigth\"", "4:14",
     "`angle_zero` cannot be `uprigth`",
     "did you mean `upright`? known here: hanging, upright, horizontal"),
    ("drive = \"position\"", "drive = \"positon\"", "24:9", "cannot be `positon`",
     "did you mean `position`?"),
    ("[rig]", "rig = 3\n[log.x]", "2:7", "`rig` is an integer", "it must be a table"),
    ("reversed = true", "reversed = 1", "56:99", "`reversed` is an integer", "true or false"),
    ("split_at_gap_s = 0.5", "split_at_gap_s = 0", "53:18", "impossible", "above 0"),
    // Joints and links.
    ("[[joint]]\ndrive = \"passive\"", "", "1:1", "has 2 link(s) but 1 joint(s)",
     "add a `[[joint]]`"),
    ("[[joint]]\ndrive = \"passive\"",
     "[[joint]]\ndrive = \"passive\"\n[[joint]]\ndrive = \"passive\"", "25:1",
     "[[joint]] 3 is one joint too many", "remove the joint"),
    // Effects.
    ("kind = \"coulomb\"", "kind = \"colomb\"", "31:8", "`kind` cannot be `colomb`",
     "did you mean `coulomb`?"),
    ("torque_nm = 0.02", "torque_nm = 11", "33:13", "`torque_nm` = 11 is impossible",
     "from 0 to 10"),
    ("joint = 1", "joint = 3", "32:9", "there is no joint 3", "count from 1 to 2"),
    ("joint = 1", "joint = 0", "32:9", "there is no joint 0", "count from 1 to 2"),
    ("joint = 1", "joint = 1.0", "32:9", "`joint` is a float", "a whole number"),
    ("joint = 2\ndelay", "joint = 1\ndelay", "37:9",
     "`delay` acts on driven joints only, and joint 1 is `passive`", "driven joint"),
    ("kind = \"delay\"\njoint = 2\ndelay_s", "kind = \"coulomb\"\njoint = 1\ntorque_nm", "36:8",
     "`coulomb` is there twice", "keep one"),
    ("[effect.fitted]\nby = \"an earlier run\"", "fitted = 3", "40:10", "`fitted` is an integer",
     "a table"),
    // Fit.
    ("\"link1.inertia_kg_m2\"", "\"link1.inertia\"", "44:9", "unknown name `inertia`",
     "did you mean `inertia_kg_m2`?"),
    ("\"link1.inertia_kg_m2\"", "\"link7.mass_kg\"", "44:9",
     "`link7.mass_kg` is not in this model", "remove it"),
    ("\"link1.inertia_kg_m2\"", "\"coulomb@1.torque_nm\"", "44:55", "named twice", "remove one"),
    ("\"link1.inertia_kg_m2\"", "3", "44:9", "`free` holds an integer", "quotes"),
    // Log.
    ("unit = \"ms\"", "unit = \"deg\"", "47:34",
     "unit `deg` measures an angle, and `time` is a time", "write one of: s, ms, us, ns"),
    ("unit = \"ms\"", "unit = \"msec\"", "47:34", "unknown unit `msec`",
     "write one of: s, ms, us, ns"),
    ("unit = \"V\"", "unit = \"kg\"", "49:40", "measures a mass, and `supply` is a voltage",
     "V, mV"),
    ("column = \"goal2\", unit = \"deg\"", "column = \"goal2\", unit = \"rpm\"", "61:36",
     "and `input` is an angle", "rad, deg"),
    ("input = { column = \"goal2\", unit = \"deg\" }", "", "59:1", "[[log.joint]] 2 lacks `input`",
     "unit = \"rad\""),
    ("velocity = {", "input = { column = \"u\", unit = \"1\" }\nvelocity = {", "57:1",
     "a passive joint has no input", "remove `input`"),
    ("ticks_per_turn = 4096", "ticks_per_turn = 0", "56:64", "impossible", "from 1"),
    ("unit = \"ticks\"", "unit = \"rad\"", "56:45", "unknown key `ticks_per_turn`", "known here"),
    ("[[log.joint]]\nposition = { column = \"pos2\"", "[rig.x]\nposition = { column = \"pos2\"",
     "59:6", "unknown key `x` in [rig]", "angle_zero"),
    // Syntax.
    ("mass_kg = 0.2", "mass_kg 0.2", "12:", "not TOML", "key = value"),
    ("[[link]]", "[[link]", "9:", "not TOML", "key = value"),
    ("name = \"everything\"", "name = \"everything", "3:", "not TOML", "quotes"),
    ("name = \"everything\"", "name = \"a\"\nname = \"b\"", "4:", "not TOML", "key = value"),
];

#[test]
fn wrong_files_are_refused_at_the_place_with_a_remedy() {
    let mut wrong = String::new();
    for (this, that, place, what, remedy) in REFUSED {
        assert!(GOOD.contains(this), "the good file holds {this}");
        let error = parse(&GOOD.replacen(this, that, 1)).expect_err(that);
        assert_eq!(error.exit_code(), 3);
        let message = error.to_string();
        let found = error.remedy().unwrap();
        let right = message.starts_with(&format!("rig.toml:{place}"))
            && message.contains(what)
            && found.contains(remedy);
        if !right {
            wrong += &format!("\n{that}\n  {message}; {found}\n  not {place}: {what}; {remedy}");
        }
    }
    assert!(wrong.is_empty(), "{wrong}");
}

#[test]
fn a_reason_can_be_matched_on() {
    let reason = |this: &str, that: &str| parse(&GOOD.replacen(this, that, 1)).unwrap_err();
    let error = reason("mass_kg = 0.2", "mass_kg = -1");
    let limits = Limits::above(0.0, 1e3);
    let (key, value) = ("mass_kg".to_string(), -1.0);
    let out_of_range = TomlReason::OutOfRange { key, value, limits };
    assert_eq!(error.reason::<TomlReason>(), Some(&out_of_range));
    assert_eq!(error.reason::<ModelReason>(), None);
    let error = reason("joint = 2\ndelay", "joint = 1\ndelay");
    let unsuited = ModelReason::UnsuitedJoint {
        id: "delay",
        wanted: "driven",
        joint: 0,
        drive: "passive",
    };
    assert_eq!(error.reason(), Some(&unsuited));
    let error = reason("link1.inertia_kg_m2", "mass_kg");
    let text = "mass_kg".to_string();
    assert_eq!(error.reason(), Some(&PathReason::NoParameter { text }));
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
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("models");
    let mut count = 0;
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if let Err(error) = Model::load(&path) {
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
