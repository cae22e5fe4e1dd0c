use super::*;
use crate::challenge::{ArmInputs, Motions, play, true_model_toml};
use crate::diagnose::search::tests::all_but;
use crate::diagnose::{DiagnoseOptions, Diagnosis, Verdict, diagnose};
use crate::log::{LogRequest, read};
use crate::model::Model;
use std::path::Path;

fn motions(names: &[&str]) -> Vec<Motion> {
    let named = |name: &&str| Motion {
        name: name.to_string(),
        ..Motion::default()
    };
    names.iter().map(named).collect()
}

fn names(motions: &[Motion]) -> Vec<&str> {
    motions.iter().map(|motion| motion.name.as_str()).collect()
}

fn turned(shown: &[bool], may_prove: bool) -> Vec<Turn> {
    let split = Split {
        training: motions(&["a", "b"]),
        held_out: motions(&["c", "d", "e"]),
    };
    splits(&split, shown, may_prove)
}

#[test]
fn one_motion_is_learned_from_and_proves_nothing() {
    let turns = turned(&[false, true, false], true);
    assert_eq!(turns.len(), 1);
    assert_eq!(turns[0].shows_alone, ["d"]);
    assert_eq!(names(&turns[0].split.training), ["a", "b", "c", "d", "e"]);
    assert!(turns[0].split.held_out.is_empty());
}

#[test]
fn the_last_of_several_proves_what_the_others_show() {
    let turns = turned(&[true, false, true], true);
    assert_eq!(names(&turns[0].split.training), ["a", "b", "c"]);
    assert_eq!(names(&turns[0].split.held_out), ["e", "d"]);
    assert!(turns[0].shows_alone.is_empty());
    assert_eq!(turns[1].shows_alone, ["c", "e"]);
    assert_eq!(turned(&[true, false, true], false), turns[1..]);
    assert!(turned(&[false; 3], true).is_empty());
}

/// What the arm of a seed that hides a limit of its torque does under weak commands, and among
/// these short strong ones.
fn played(strong: f64, from_s: f64) -> Motion {
    let time_s: Vec<f64> = (0..1000).map(|k| 0.01 * f64::from(k)).collect();
    let duty = |t: &f64| {
        let t = t + from_s;
        let weak = 0.05 * (2.1 * t).sin() + 0.04 * (5.3 * t).sin();
        let side = if t % 2.0 < 1.0 { strong } else { -strong };
        if t % 1.0 < 0.035 { side } else { weak }
    };
    let inputs = ArmInputs {
        duty: time_s.iter().map(duty).collect(),
        torque_on: vec![true; time_s.len()],
        time_s,
        supply_v: Some(9.8),
        payload_kg: 0.0,
        turned: false,
    };
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join(format!("at_{strong}_from_{from_s}.csv"));
    std::fs::write(&file, play(SEED, &[LIMIT], &inputs)).unwrap();
    let log = &model().log;
    read(&[LogRequest::whole(file)], log).unwrap().remove(0)
}

const SEED: u64 = 3;
const LIMIT: &str = "torque_saturation";

/// All of the arm but its limit.
fn model() -> Model {
    let toml = true_model_toml(Motions::Arm, SEED, &[LIMIT]).unwrap();
    let mut model = Model::parse(&toml, Path::new("arm.toml")).unwrap();
    model.effects.retain(|e| e.effect.info().id != LIMIT);
    let known = model.clone();
    model.free.retain(|path| path.get(&known).is_some());
    model
}

fn limit_nm() -> f64 {
    let toml = true_model_toml(Motions::Arm, SEED, &[LIMIT]).unwrap();
    let model = Model::parse(&toml, Path::new("arm.toml")).unwrap();
    let hidden = model.effects.iter().find(|e| e.effect.info().id == LIMIT);
    hidden.unwrap().values[0]
}

fn diagnosed(training: Vec<Motion>, held_out: Vec<Motion>) -> Diagnosis {
    let options = DiagnoseOptions {
        without: all_but(&[
            LIMIT,
            "coulomb",
            "backlash",
            "cogging",
            "delay",
            "dead_zone",
        ]),
        ..DiagnoseOptions::default()
    };
    diagnose(&model(), training, held_out, &options, &|_| ())
}

fn found_limit(diagnosis: &Diagnosis) {
    assert_eq!(diagnosis.effects.len(), 1, "{:?}", diagnosis.summary);
    assert_eq!(diagnosis.effects[0].kind, LIMIT);
    let value = diagnosis.effects[0].parameters[0].value;
    assert!((value / limit_nm() - 1.0).abs() < 0.03, "{value}");
}

#[test]
fn a_limit_that_one_motion_reaches_is_told_and_not_claimed() {
    let weak = vec![played(0.1, 0.0), played(0.08, 3.0)];
    let strong = played(0.45, 1.3);
    let name = strong.name.clone();
    let diagnosis = diagnosed(weak, vec![strong]);
    assert_eq!(
        diagnosis.verdict,
        Verdict::Ambiguous,
        "{:?}",
        diagnosis.summary
    );
    found_limit(&diagnosis);
    assert_eq!(diagnosis.shows_alone, std::slice::from_ref(&name));
    let said = &diagnosis.summary[0];
    assert!(
        said.starts_with(&format!("Shows in {name} alone: ")),
        "{said}"
    );
    assert!(
        said.ends_with("record another motion like it to prove it."),
        "{said}"
    );
    assert!(diagnosis.next[0].contains(&name), "{:?}", diagnosis.next);
}

#[test]
fn a_limit_that_two_motions_reach_is_named() {
    let weak = vec![played(0.1, 0.0), played(0.08, 3.0)];
    let strong = vec![played(0.45, 1.3), played(0.4, 7.6)];
    let proving = strong[1].name.clone();
    let diagnosis = diagnosed(weak, strong);
    assert_eq!(diagnosis.verdict, Verdict::Named, "{:?}", diagnosis.summary);
    found_limit(&diagnosis);
    assert!(diagnosis.shows_alone.is_empty());
    let held_out = diagnosis.motions.iter().filter(|motion| motion.held_out);
    let held_out: Vec<&String> = held_out.map(|motion| &motion.motion).collect();
    assert_eq!(held_out, [&proving]);
}
