//! A value of the model file that is wrong is named with its right value, however far off it is.

use handstand::Model;
use handstand::challenge::{Bench, Motions, bench};
use handstand::diagnose::{DiagnoseOptions, Diagnosis, Verdict, WrongValue, diagnose};
use handstand::log::{LogRequest, read};
use handstand::model::ParameterPath;
use handstand::model::edit::set_values;
use handstand::motion::Motion;
use std::path::Path;

/// The bench's motions, to fit and held out.
fn motions(bench: &Bench, model: &Model, dir: &Path) -> [Vec<Motion>; 2] {
    let of = |held_out: bool| {
        let logs = bench.logs.iter().filter(|log| log.held_out == held_out);
        let requests = logs.map(|log| {
            let path = dir.join(&log.name);
            std::fs::write(&path, &log.csv).unwrap();
            LogRequest::whole(&path)
        });
        read(&requests.collect::<Vec<_>>(), &model.log).unwrap()
    };
    [of(false), of(true)]
}

/// Of an arm that lacks nothing, with one value of its file multiplied; and the right value.
fn diagnosed(path: &str, factor: f64) -> (Diagnosis, f64) {
    diagnosed_as_stated(path, factor, "")
}

/// The same of a file that ends with this section.
fn diagnosed_as_stated(path: &str, factor: f64, section: &str) -> (Diagnosis, f64) {
    let dir = tempfile::tempdir().unwrap();
    let bench = bench(Motions::Arm, 5, &[]).unwrap();
    let file = dir.path().join("arm.toml");
    let exact = Model::parse(&bench.model_toml, &file).unwrap();
    let [training, held_out] = motions(&bench, &exact, dir.path());
    let path: ParameterPath = path.parse().unwrap();
    let right = path.get(&exact).unwrap();
    let text = set_values(&bench.model_toml, &file, &[(path, factor * right)]).unwrap();
    let model = Model::parse(&[&text, "\n", section].concat(), &file).unwrap();
    let options = DiagnoseOptions::default();
    (
        diagnose(&model, training, held_out, &options, &|_| {}),
        right,
    )
}

/// The bench's owner does not know the friction: it is free, and wrong too.
fn is_named(path: &str, factor: f64) -> Diagnosis {
    let (diagnosis, right) = diagnosed(path, factor);
    assert_eq!(
        diagnosis.verdict,
        Verdict::WrongValue,
        "{path} x {factor}: {:?}",
        diagnosis.summary
    );
    let wrong = diagnosis.wrong_values.iter();
    let mut own = wrong.filter(|wrong| wrong.fitted.path == path);
    let own = own.next().expect("the value that is wrong");
    let off = (own.fitted.value / right - 1.0).abs();
    assert!(off < 0.01, "{path} x {factor}: {:?}", own.fitted);
    diagnosis
}

/// The effects that say the same in every experiment.
fn same_in_other_words(diagnosis: &Diagnosis) -> Vec<&str> {
    let same = diagnosis.alternatives.iter().filter(|other| other.same_law);
    same.flat_map(|other| &other.effects)
        .map(|effect| effect.kind.as_str())
        .collect()
}

#[test]
fn a_mass_twice_the_right_one_is_named_and_no_missing_mass_says_the_same() {
    let diagnosis = is_named("link1.mass_kg", 2.0);
    // A missing mass brings its inertia along: here the file's inertia is right.
    assert_eq!(same_in_other_words(&diagnosis), [""; 0]);
}

#[test]
fn a_centre_of_mass_at_two_thirds_of_its_place_is_named() {
    is_named("link1.com_m", 0.667);
}

#[test]
fn a_stall_torque_is_named_though_a_torque_scale_says_the_same() {
    let diagnosis = is_named("joint1.stall_torque_nm", 1.4);
    assert_eq!(same_in_other_words(&diagnosis), ["torque_scale"]);
}

/// What the diagnosis says of a value that is off, in a file that ends with this section.
fn said_of(path: &str, factor: f64, section: &str) -> (Diagnosis, WrongValue) {
    let (diagnosis, right) = diagnosed_as_stated(path, factor, section);
    assert_eq!(
        diagnosis.verdict,
        Verdict::WrongValue,
        "{:?}",
        diagnosis.summary
    );
    let mut wrong = diagnosis.wrong_values.iter();
    let value = wrong.find(|wrong| wrong.fitted.path == path);
    let value = value
        .unwrap_or_else(|| panic!("{:?}", diagnosis.summary))
        .clone();
    assert!((value.fitted.value / right - 1.0).abs() < 0.02, "{value:?}");
    (diagnosis, value)
}

#[test]
fn a_value_off_by_more_than_its_owner_allows_is_wrong() {
    let known = "[uncertainty]\n\"link1.mass_kg\" = 0.01\n";
    let (diagnosis, mass) = said_of("link1.mass_kg", 1.2, known);
    assert!(!mass.within_uncertainty && !mass.free);
    let said = &diagnosis.summary[0];
    assert!(
        said.contains("wrong: ") && said.contains("the mass of link 1: "),
        "{said}"
    );
    assert!(
        diagnosis.next[0].contains(" --free link1.mass_kg"),
        "{:?}",
        diagnosis.next
    );
}

#[test]
fn a_value_off_by_no_more_than_its_owner_allows_is_only_told_better() {
    let known = "[uncertainty]\ntypical = true\n";
    let (diagnosis, torque) = said_of("joint1.stall_torque_nm", 1.1, known);
    assert!(torque.within_uncertainty && !torque.free);
    // What is wrong is the friction, of which the owner knows nothing.
    let said = &diagnosis.summary[0];
    assert!(
        said.contains("friction") && !said.contains("stall torque"),
        "{said}"
    );
}
