use super::*;
use crate::effects;

const MODEL: &str = include_str!("../testdata/full.toml");

fn path() -> &'static Path {
    Path::new("full.toml")
}

fn effect(id: &str, joint: usize, value: f64) -> EffectInstance {
    EffectInstance {
        effect: effects::named(id).unwrap(),
        joint: Some(joint),
        values: vec![value],
    }
}

fn fitted() -> FitRecord {
    FitRecord {
        intervals: vec![("coulomb@2.torque_nm".parse().unwrap(), 0.018, 0.022)],
        logs: vec![("drop \"1\".csv".into(), "ab12".into())],
        error_before: 0.012_345_678,
        error_after: 0.0021,
        error_unit: "rad".into(),
        horizon_s: Some(0.25),
    }
}

#[test]
fn an_added_effect_is_there_and_every_old_line_too() {
    let added = effect("coulomb", 1, 0.019_876_543_2);
    let text = add_effect(MODEL, path(), &added, Some(&fitted())).unwrap();
    let model = Model::parse(&text, path()).unwrap();
    let last = model.effects.last().unwrap();
    assert_eq!(last.effect.info().id, "coulomb");
    assert_eq!((last.joint, last.values[0]), (Some(1), 0.019_876_5));
    let mut lines = text.lines();
    for old in MODEL.lines().filter(|line| !line.starts_with("free")) {
        assert!(lines.any(|line| line == old), "kept in order: {old}");
    }
    assert!(text.contains(
        "[[effect]]\nkind = \"coulomb\"\njoint = 2\ntorque_nm = 0.0198765\n\n[effect.fitted]\n"
    ));
    assert!(text.contains("error_before = 0.0123457\n"), "{text}");
    assert!(
        text.contains("intervals = { torque_nm = [0.018, 0.022] }\n"),
        "{text}"
    );
    assert!(
        text.contains("error_unit = \"rad\"\nhorizon_s = 0.25\n"),
        "{text}"
    );
}

#[test]
fn whole_motions_have_no_horizon_and_a_later_fit_renews_it() {
    let added = effect("coulomb", 1, 0.02);
    let of = |horizon_s| FitRecord {
        horizon_s,
        ..fitted()
    };
    let whole = add_effect(MODEL, path(), &added, Some(&of(None))).unwrap();
    assert!(!whole.contains("horizon_s"), "{whole}");
    let mut text = whole.clone();
    for horizon_s in [0.5, 0.123_456_789] {
        text = renew_provenance(&text, path(), &of(Some(horizon_s))).unwrap();
        let written = format!("\nhorizon_s = {}\n", number(horizon_s).to_string().trim());
        assert_eq!(text.matches("horizon_s").count(), 1, "{text}");
        assert!(text.contains(&written), "{text}");
        assert_eq!(
            Model::parse(&text, path()).unwrap().effects,
            Model::parse(&whole, path()).unwrap().effects
        );
    }
    let back = renew_provenance(&text, path(), &of(None)).unwrap();
    assert_eq!(back, whole);
}

#[test]
fn an_added_effect_is_free_where_the_model_lists_what_is() {
    let old = r#"["link1.inertia_kg_m2", "joint2.gain_per_rad", "coulomb@1.torque_nm"]"#;
    let one = "[\n  \"link1.com_m\", # of the bob\n]";
    for (list, said) in [
        (old, r#"torque_nm", "coulomb@2.torque_nm"]"#),
        ("[]", r#"free = ["coulomb@2.torque_nm"]"#),
        (
            one,
            "\"link1.com_m\", # of the bob\n  \"coulomb@2.torque_nm\",\n]\n",
        ),
        (
            "[\n  \"link1.com_m\" # of the bob\n]",
            "\"link1.com_m\", # of the bob\n  \"coulomb@2.torque_nm\"\n]\n",
        ),
        (
            "[\n  # none yet\n]",
            "# none yet\n\"coulomb@2.torque_nm\"\n]\n",
        ),
    ] {
        let bare = MODEL.replace(old, list);
        let text = add_effect(&bare, path(), &effect("coulomb", 1, 0.02), None).unwrap();
        assert!(text.contains(said), "{text}");
        let model = Model::parse(&text, path()).unwrap();
        let last = model.free.last().map(ToString::to_string);
        assert_eq!(last.as_deref(), Some("coulomb@2.torque_nm"), "{text}");
    }
}

#[test]
fn the_first_effect_of_a_file_gets_its_heading() {
    let start = MODEL.find("[[effect]]").unwrap();
    let end = MODEL.find("[fit]").unwrap();
    let log = MODEL.find("[log]").unwrap();
    assert!(end < log);
    let bare = format!("{}{}", &MODEL[..start], &MODEL[log..]);
    let text = add_effect(&bare, path(), &effect("delay", 1, 0.03), None).unwrap();
    assert!(text.starts_with(&bare), "{text}");
    assert_eq!(Model::parse(&text, path()).unwrap().effects.len(), 1);
}

#[test]
fn effects_that_do_not_suit_the_model_are_refused() {
    for (effect, what) in [
        (effect("coulomb", 0, 0.1), "there twice"),
        (effect("delay", 0, 0.1), "driven joints only"),
        (effect("coulomb", 5, 0.1), "no joint 6"),
        (effect("coulomb", 1, -0.1), "impossible"),
        (effect("coulomb", 1, f64::NAN), "NaN"),
    ] {
        let error = add_effect(MODEL, path(), &effect, None).unwrap_err();
        assert!(error.to_string().contains(what), "{error}");
    }
}

#[test]
fn set_values_change_only_their_numbers() {
    let values: Vec<(ParameterPath, f64)> = [
        ("link1.com_m", 0.101_234_567),
        ("joint2.gain_per_rad", 9.5),
        ("coulomb@1.torque_nm", 1.234_567_89e-7),
        ("link2.length_m", 0.2),
    ]
    .map(|(text, value)| (text.parse().unwrap(), value))
    .to_vec();
    let text = set_values(MODEL, path(), &values).unwrap();
    assert!(text.contains("com_m = 0.101235 # weighed on a knife edge\n"));
    assert!(text.contains("torque_nm = 1.23457e-7 # felt by hand\n"));
    let model = Model::parse(&text, path()).unwrap();
    for (path, value) in &values {
        let found = path.get(&model).unwrap();
        assert!((found / value - 1.0).abs() < 1e-5, "{path}: {found}");
    }
    assert_eq!(text.lines().count(), MODEL.lines().count() + 1);
    assert_eq!(set_values(MODEL, path(), &[]).unwrap(), MODEL);
}

#[test]
fn values_with_no_place_or_impossible_are_refused() {
    for (parameter, value, what) in [
        ("coulomb@2.torque_nm", 0.1, "no `coulomb@2.torque_nm`"),
        ("link3.mass_kg", 0.1, "no `link3.mass_kg`"),
        ("joint1.stall_torque_nm", 0.1, "no `joint1"),
        ("link1.mass_kg", -0.1, "impossible"),
        ("link1.mass_kg", f64::INFINITY, "inf"),
    ] {
        let values = [(parameter.parse().unwrap(), value)];
        let error = set_values(MODEL, path(), &values).unwrap_err();
        assert!(error.to_string().contains(what), "{error}");
    }
}

#[test]
fn the_origin_of_old_values_is_renewed_in_its_place() {
    let added = effect("coulomb", 1, 0.02);
    let text = add_effect(MODEL, path(), &added, Some(&fitted())).unwrap();
    let mut record = fitted();
    record.intervals = vec![
        ("coulomb@2.torque_nm".parse().unwrap(), 0.03, 0.04),
        ("link1.com_m".parse().unwrap(), 0.1, 0.2),
    ];
    record.logs[0].0 = "later.csv".into();
    let renewed = renew_provenance(&text, path(), &record).unwrap();
    assert!(
        renewed.contains("intervals = { torque_nm = [0.03, 0.04] }\n"),
        "{renewed}"
    );
    assert!(!renewed.contains("0.018"), "{renewed}");
    assert!(!renewed.contains("drop "), "{renewed}");
    let of_links = renewed.find("[fit.fitted]\nintervals = { \"link1.com_m\" = [0.1, 0.2] }\n");
    assert!(of_links.is_some(), "{renewed}");
    let twice = renew_provenance(&renewed, path(), &record).unwrap();
    assert_eq!(twice, renewed);
}

#[test]
fn an_effect_of_all_driven_joints_is_written_as_such() {
    let mut added = effect("delay", 0, 0.02);
    added.joint = None;
    let model = MODEL.replace("kind = \"delay\"", "kind = \"sensor_lag\"");
    let model = model.replace("delay_s = ", "time_constant_s = ");
    let text = add_effect(&model, path(), &added, None).unwrap();
    assert!(
        text.contains("kind = \"delay\"\njoint = \"all\"\ndelay_s = 0.02\n"),
        "{text}"
    );
    let all: ParameterPath = "delay@all.delay_s".parse().unwrap();
    let moved = set_values(&text, path(), &[(all, 0.03)]).unwrap();
    assert!(
        moved.contains("joint = \"all\"\ndelay_s = 0.03\n"),
        "{moved}"
    );
    let twice = effect("delay", 1, 0.02);
    assert!(add_effect(&moved, path(), &twice, None).is_err());
}

#[test]
fn an_inertia_about_the_joint_becomes_one_about_the_centre_of_mass() {
    let text = "[rig]\nname = \"a\"\nangle_zero = \"hanging\"\n\n[[link]]\ncom_m = 0.1\nmass_kg = 0.2\n\
                joint_inertia_kg_m2 = 0.005 # published\n\n[[joint]]\ndrive = \"passive\"\n\n[log]\n\
                time = { column = \"t\", unit = \"s\" }\n\n[[log.joint]]\n\
                position = { column = \"q\", unit = \"rad\" }\n";
    let path = Path::new("m.toml");
    let model = Model::parse(text, path).unwrap();
    assert!((model.links[0].inertia_kg_m2 - 0.003).abs() < 1e-15);
    let com: ParameterPath = "link1.com_m".parse().unwrap();
    let edited = set_values(text, path, &[(com, 0.12)]).unwrap();
    let again = Model::parse(&edited, path).unwrap();
    assert!(
        (again.links[0].inertia_kg_m2 - 0.003).abs() < 1e-15,
        "{edited}"
    );
    assert_eq!(again.links[0].com_m, 0.12);
    let both = text.replace(
        "joint_inertia_kg_m2",
        "inertia_kg_m2 = 0.003\njoint_inertia_kg_m2",
    );
    assert!(
        Model::parse(&both, path)
            .unwrap_err()
            .to_string()
            .contains("centre of mass too")
    );
    let little = text.replace("0.005", "0.001");
    let said = Model::parse(&little, path).unwrap_err().to_string();
    assert!(said.starts_with("m.toml:8"), "{said}");
}

#[test]
fn a_step_is_written_over_the_old_one_or_beside_the_rig_s_other_keys() {
    let text = set_step(MODEL, path(), 0.000_25).unwrap();
    assert_eq!(Model::parse(&text, path()).unwrap().step_s, 0.000_25);
    assert_eq!(text.lines().count(), MODEL.lines().count());
    let without = MODEL.replace("step_s = 0.001\n", "");
    let text = set_step(&without, path(), 0.0025).unwrap();
    assert_eq!(Model::parse(&text, path()).unwrap().step_s, 0.0025);
    assert!(set_step(MODEL, path(), 0.5).is_err());
}

#[test]
fn bounds_are_written_changed_and_lifted() {
    let com = "link1.com_m".parse().unwrap();
    let free = Model::parse(MODEL, path()).unwrap().free;
    let text = set_bounds(MODEL, path(), &[(com, Some((0.05, 0.2)))]).unwrap();
    assert!(
        text.contains("[fit.bounds]\n\"link1.com_m\" = [0.05, 0.2]\n"),
        "{text}"
    );
    let model = Model::parse(&text, path()).unwrap();
    assert_eq!(com.bounds(&model), (0.05, 0.2));
    assert_eq!(model.free, free);
    let open = set_bounds(&text, path(), &[(com, Some((f64::NEG_INFINITY, 0.3)))]).unwrap();
    assert_eq!(com.bounds(&Model::parse(&open, path()).unwrap()).1, 0.3);
    assert_eq!(set_bounds(&text, path(), &[(com, None)]).unwrap(), MODEL);
    for (low, high) in [(0.3, 0.4), (0.2, 0.05)] {
        assert!(set_bounds(MODEL, path(), &[(com, Some((low, high)))]).is_err());
    }
}

#[test]
fn what_was_believed_stays_beside_a_value_that_a_fit_changes() {
    let text = [MODEL, "\n[uncertainty]\ntypical = true # a guess\n"].concat();
    let model = Model::parse(&text, path()).unwrap();
    let known = model.uncertain[0];
    let (kept, other) = (known.path, model.uncertain[1].path);
    let after = keep_given(&text, path(), &[kept], &model).unwrap();
    let after = set_values(&after, path(), &[(kept, 1.1 * known.given)]).unwrap();
    assert!(after.contains("typical = true # a guess"), "{after}");
    let fitted = Model::parse(&after, path()).unwrap();
    let again = fitted.uncertain(kept).unwrap();
    assert_eq!(
        (again.given, again.uncertainty),
        (known.given, known.uncertainty)
    );
    assert!((again.at(kept.get(&fitted).unwrap()).distance).abs() > 0.3);
    assert_eq!(fitted.uncertain(other), model.uncertain(other));
    // A second fit changes nothing of what was believed; one that took nothing for known does.
    let twice = keep_given(&after, path(), &[kept], &fitted).unwrap();
    assert_eq!(twice, after);
    let mut unknown = fitted.clone();
    unknown.forget(&[kept]);
    let free = keep_given(&after, path(), &[kept], &unknown).unwrap();
    let free = Model::parse(&free, path()).unwrap();
    assert_eq!(Some(free.uncertain(kept).unwrap().given), kept.get(&fitted));
    // A file that states none stays as it is.
    assert_eq!(keep_given(MODEL, path(), &[kept], &model).unwrap(), MODEL);
}
