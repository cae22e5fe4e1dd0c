//! A value of the model file that is wrong is named with its right value, however far off it is.

use handstand::Model;
use handstand::challenge::{Bench, Motions, bench};
use handstand::diagnose::{DiagnoseOptions, Diagnosis, Verdict, diagnose};
use handstand::log::{LogRequest, read};
use handstand::model::ParameterPath;
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
    let dir = tempfile::tempdir().unwrap();
    let bench = bench(Motions::Arm, 5, &[]).unwrap();
    let mut model = Model::parse(&bench.model_toml, &dir.path().join("arm.toml")).unwrap();
    let [training, held_out] = motions(&bench, &model, dir.path());
    let path: ParameterPath = path.parse().unwrap();
    let right = path.get(&model).unwrap();
    assert!(path.set(&mut model, factor * right));
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
