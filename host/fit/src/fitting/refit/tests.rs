//! Known values, simulated, found again.

use super::*;
use crate::effects;
use crate::motion::{Motion, MotionSource};
use crate::sim::{Plant, PlantMemory, StartState, predict};
use handstand_challenge::{Bench, Readings, read_arm, read_pendulum};
use handstand_logs::{LogRequest, read};
use std::path::Path;

const PENDULUM: &str = r#"
[rig]
name = "pendulum"
angle_zero = "hanging"
step_s = 0.005

[[link]]
com_m = 0.1
mass_kg = 0.2
inertia_kg_m2 = 1e-4

[[joint]]
drive = "passive"

[log]
time = { column = "t", unit = "s" }

[[log.joint]]
position = { column = "q", unit = "rad", resolution_rad = 0.001 }
"#;

fn pendulum() -> Model {
    Model::parse(PENDULUM, Path::new("pendulum.toml")).unwrap()
}

fn candidate(id: &str) -> Candidate {
    Candidate {
        effect: effects::named(id).unwrap(),
        joint: Some(0),
    }
}

/// The pendulum let go at `angle`, as `model` swings.
fn swing(model: &Model, angle: f64) -> Motion {
    let time_s: Vec<f64> = (0..300).map(|k| f64::from(k) * 0.01).collect();
    let motion = Motion {
        name: format!("from {angle}"),
        source: MotionSource {
            path: "swing.csv".into(),
            sha256: "0".into(),
            lines: (1, 300),
        },
        position_rad: vec![vec![0.0; time_s.len()]],
        time_s,
        velocity_rad_s: vec![None],
        rate_rad_s: Vec::new(),
        input: vec![None],
        supply_v: None,
        torque_on: None,
        payload_kg: 0.0,
        turned: false,
    };
    read_by(model, motion, angle)
}

/// The motion with the readings of a model let go at `angle`.
fn read_by(model: &Model, mut motion: Motion, angle: f64) -> Motion {
    let start = StartState {
        angle_rad: vec![angle],
        speed_rad_s: vec![0.0],
        ..StartState::default()
    };
    let mut readings = vec![0.0; motion.len()];
    let plant = Plant::new(model, &motion);
    let mut memory = PlantMemory::default();
    let whole = 0..motion.len();
    predict(&plant, &motion, whole, &start, &mut memory, &mut readings);
    motion.position_rad[0] = readings
        .iter()
        .map(|rad| (rad / 0.001).round() * 0.001)
        .collect();
    motion
}

fn swings(truth: &Model) -> Split {
    Split {
        training: vec![swing(truth, 1.5), swing(truth, -0.7)],
        held_out: vec![swing(truth, 1.0)],
    }
}

#[test]
fn an_added_effect_gets_its_true_value_and_new_motions_are_predicted() {
    let mut truth = pendulum();
    truth.effects.push(candidate("coulomb").instance(&[0.004]));
    let split = swings(&truth);
    let refitted = refit_with(&pendulum(), &[candidate("coulomb")], &split, None, &|_| {}).unwrap();
    let value = &refitted.values[0];
    assert_eq!(value.path, "coulomb@1.torque_nm");
    assert_eq!(refitted.model.free, refitted.free);
    assert_eq!(refitted.free.len(), 1);
    assert!((value.value - 0.004).abs() < 4e-5, "{value:?}");
    assert!(value.low <= value.value && value.value <= value.high);
    let error = refitted.error;
    assert!(error.held_out && error.before_rad > 0.05, "{error:?}");
    assert!(error.after_rad < 2.0 * error.floor_rad, "{error:?}");
}

#[test]
fn a_value_that_nothing_shows_is_refused() {
    let split = swings(&pendulum());
    // Without friction there is no fading whose speed could be told.
    let mut model = pendulum();
    model
        .effects
        .push(candidate("stribeck").instance(&[0.0, 0.1]));
    let speed: ParameterPath = "stribeck@1.speed_rad_s".parse().unwrap();
    let error = refit(&model, &[speed], &split, None, &|_| {}).unwrap_err();
    assert_eq!(error.blind, ["stribeck@1.speed_rad_s"]);
}

#[test]
fn values_that_a_free_swing_tells_only_together_are_refused_by_name() {
    let mut truth = pendulum();
    truth.links[0].mass_kg = 0.21;
    let split = swings(&truth);
    // A pendulum swings by the ratio of the two.
    let free = ["link1.mass_kg", "link1.inertia_kg_m2"];
    let paths = free.map(|path| path.parse::<ParameterPath>().unwrap());
    let error = refit(&pendulum(), &paths, &split, None, &|_| {}).unwrap_err();
    assert_eq!(error.mixed, free);
    assert_eq!(error.hold.len(), 1, "{:?}", error.hold);
    assert!(error.to_string().contains("mixtures"), "{error}");
    // Each by itself is told.
    for path in paths {
        assert!(refit(&pendulum(), &[path], &split, None, &|_| {}).is_ok());
    }
}

#[test]
fn a_refit_finds_a_mass_moved_outwards() {
    let mut truth = pendulum();
    truth.links[0].com_m = 0.12;
    let com: ParameterPath = "link1.com_m".parse().unwrap();
    let refitted = refit(&pendulum(), &[com], &swings(&truth), None, &|_| {}).unwrap();
    assert!((refitted.values[0].value - 0.12).abs() < 1e-4);
    assert!(refitted.error.after_rad < 0.1 * refitted.error.before_rad);
}

/// Teeth that pass within a few steps of 10 ms: in such steps the pendulum is another one.
#[test]
fn steps_that_are_too_long_for_what_is_found_are_shortened() {
    let mut nominal = pendulum();
    let teeth = candidate("cogging").instance(&[0.03, 60.0, 0.3]);
    nominal.effects.push(teeth);
    let in_steps = |step_s| Model {
        step_s,
        ..nominal.clone()
    };
    let mut truth = in_steps(0.0005);
    truth.effects.push(candidate("viscous").instance(&[0.0003]));
    let split = swings(&truth);
    let added = |model: &Model| {
        let viscous = [candidate("viscous")];
        refit_with(model, &viscous, &split, None, &|_| {}).unwrap()
    };
    // Samples are 10 ms apart: longer steps are none.
    for step_s in [0.01, 0.1] {
        let refitted = added(&in_steps(step_s));
        assert_eq!(refitted.shorter_step_s, Some(refitted.model.step_s));
        assert!(refitted.error.after_rad < 1.5 * refitted.error.floor_rad);
    }
    let fine = added(&in_steps(0.0005));
    assert_eq!(fine.shorter_step_s, None);
    assert_eq!(fine.model.step_s, 0.0005);
}

/// What a bench's owner believes, the true model, and the motions: those held out as well where
/// they are wanted.
fn believed_and_true(bench: &Bench) -> (Model, Model, Split) {
    let dir = tempfile::tempdir().unwrap();
    let parsed = |text: &str| Model::parse(text, &dir.path().join("m.toml")).unwrap();
    let (believed, truth) = (parsed(&bench.model_toml), parsed(&bench.true_model_toml));
    let training = bench
        .logs
        .iter()
        .filter(|log| !log.held_out)
        .flat_map(|log| {
            let file = dir.path().join(&log.name);
            std::fs::write(&file, &log.csv).unwrap();
            read(&[LogRequest::whole(file)], &believed.log).unwrap()
        });
    let split = Split {
        training: training.collect(),
        held_out: Vec::new(),
    };
    (believed, truth, split)
}

/// A pendulum that rests half a swing sooner, under more of one friction and less of another: what
/// is left of its logs has valleys that look like the true one.
#[test]
fn added_drag_leaves_no_more_than_the_truth_whatever_valleys_friction_makes() {
    for seed in [1, 2, 3, 4] {
        let (believed, truth, split) =
            believed_and_true(&read_pendulum(seed, Readings::NoisySteps));
        let drag = [Candidate::named("air_drag@1", &believed).unwrap()];
        let added = refit_with(&believed, &drag, &split, None, &|_| {}).unwrap();
        let data = FitProblem::new(&believed, split.training.clone(), Horizon::Whole);
        let true_rad = fit_start_states(&truth, &data).rms(&data);
        let [_, after_rad] = added.fitted_rad;
        assert!(
            after_rad <= true_rad * 1.0001,
            "{seed}: {after_rad} {true_rad}"
        );
        // And from the true friction, as well as from the believed.
        let again = refit(&added.model, &added.free, &split, None, &|_| {}).unwrap();
        assert!(again.error.after_rad <= after_rad * 1.0001);
    }
}

/// Play in the gear, of which the model knows nothing: it loses whole motions.
#[test]
fn an_effect_that_is_added_leaves_no_more_than_the_model_without_it() {
    for seed in [1, 2] {
        let (believed, _, mut split) =
            believed_and_true(&read_arm(seed, "gear_backlash", Readings::NoisySteps));
        split.training.truncate(1);
        let stribeck = [Candidate::named("stribeck@1", &believed).unwrap()];
        match refit_with(&believed, &stribeck, &split, None, &|_| {}) {
            Ok(added) => assert!(added.fitted_rad[1] < added.fitted_rad[0], "{added:?}"),
            Err(NotAdded::NotBetter(error)) => {
                assert!(error.after_rad <= error.before_rad, "{error:?}")
            }
            Err(why) => panic!("{why:?}"),
        }
    }
}

#[test]
fn an_effect_that_is_not_there_is_refused_for_want_of_better_values() {
    let mut truth = pendulum();
    truth.effects.push(candidate("coulomb").instance(&[0.004]));
    let mut model = truth.clone();
    model.free = vec!["coulomb@1.torque_nm".parse().unwrap()];
    let split = Split {
        held_out: Vec::new(),
        ..swings(&truth)
    };
    let added = refit_with(&model, &[candidate("stribeck")], &split, None, &|_| {});
    let Err(NotAdded::NotBetter(error)) = added else {
        panic!("{added:?}");
    };
    assert!(error.after_rad <= error.before_rad);
    let why = crate::fitting::Unhelpful::NotFound(error).why(&["stribeck@1".to_string()]);
    assert!(why.contains("did not find a better value"), "{why}");
}

/// A swinging pendulum tells one mixture of its mass, moment of inertia and centre of mass: with
/// what its owner knows of each, all three are told, and those known best move least.
#[test]
fn what_is_known_beforehand_settles_what_the_motions_mix() {
    let text = [
        PENDULUM,
        "[uncertainty]\n\"link1.com_m\" = 0.05\n\"link1.mass_kg\" = 0.01\n\
         \"link1.inertia_kg_m2\" = 0.2\n",
    ]
    .concat();
    let believed = Model::parse(&text, Path::new("pendulum.toml")).unwrap();
    let mut truth = pendulum();
    truth.links[0].com_m = 0.104;
    let split = Split {
        training: vec![swing(&truth, 1.2), swing(&truth, 0.7)],
        held_out: vec![swing(&truth, 1.0)],
    };
    let mut free = believed.clone();
    free.uncertain.clear();
    let untold = refit(&free, &free.free, &split, None, &|_| {}).unwrap_err();
    assert_eq!(untold.mixed.len(), 3, "{untold}");
    let found = refit(&believed, &believed.free, &split, None, &|_| {}).unwrap();
    assert!(
        found.error.after_rad < 1.05 * found.error.floor_rad,
        "{:?}",
        found.error
    );
    let reduced_length_m = |model: &Model| {
        let link = &model.links[0];
        link.com_m + link.inertia_kg_m2 / (link.mass_kg * link.com_m)
    };
    let ratio = reduced_length_m(&found.model) / reduced_length_m(&truth);
    assert!((ratio - 1.0).abs() < 1e-3, "{ratio}");
    for known in &believed.uncertain {
        let place = found
            .free
            .iter()
            .position(|path| *path == known.path)
            .unwrap();
        let value = &found.values[place];
        assert!(known.allows(value.value), "{value:?}");
        // No log tells them apart: each stays nearly as uncertain as it was, but for the one that
        // makes the mixture.
        let half = (value.high - value.low) / 2.0 / known.given;
        let is_told = value.path == "link1.com_m";
        let share = half / (1.96 * known.uncertainty);
        assert!((share < 0.4) == is_told, "{value:?}: {share}");
    }
}
