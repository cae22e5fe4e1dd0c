use super::physics::{DriveCommand, Mount, Physics};
use super::truth::Arm;
use super::*;
use crate::error::Place;

const RELEASED: DriveCommand = DriveCommand {
    duty: 0.0,
    supply_v: 9.8,
    torque_on: false,
};

fn ideal() -> Physics {
    Physics::ideal(0.09, 0.25, 6e-4, 1.5, 9.8)
}

#[test]
fn the_same_seed_gives_the_same_bytes() {
    let once = generate(7, Hidden::Random);
    assert_eq!(once, generate(7, Hidden::Random));
    assert_ne!(once.logs, generate(8, Hidden::Random).logs);
}

#[test]
fn an_arm_without_friction_keeps_its_energy() {
    let physics = ideal();
    let mut arm = Arm::at_rest(&physics, Mount::default(), 1.5);
    let before = arm.energy_j();
    let span = 0.25 * 9.81 * 0.09;
    for _ in 0..1000 {
        arm.advance(0.01, |_| RELEASED);
        assert!((arm.energy_j() - before).abs() < 1e-3 * span);
    }
    assert!(arm.speed.is_finite() && arm.angle.abs() < 1.6);
}

#[test]
fn a_small_swing_has_the_period_of_a_pendulum() {
    let physics = ideal();
    let mut arm = Arm::at_rest(&physics, Mount::default(), 0.01);
    let inertia = physics.inertia_at_joint(Mount::default());
    let period = std::f64::consts::TAU * (inertia / (0.25 * 9.81 * 0.09)).sqrt();
    arm.advance(10.0 * period, |_| RELEASED);
    assert!((arm.angle - 0.01).abs() < 1e-5, "{}", arm.angle);
}

#[test]
fn a_stuck_arm_stays_put() {
    let mut physics = ideal();
    physics.switch_on("coulomb", &[0.05]);
    let held = 0.049 / (0.25 * 9.81 * 0.09);
    let mut arm = Arm::at_rest(&physics, Mount::default(), held);
    arm.advance(5.0, |_| RELEASED);
    assert_eq!((arm.angle, arm.speed), (held, 0.0));
    let pushed = DriveCommand {
        duty: -0.01,
        torque_on: true,
        ..RELEASED
    };
    arm.advance(0.5, |_| pushed);
    assert!(arm.angle < held);
}

#[test]
fn every_effect_changes_the_motion() {
    for kind in KINDS {
        let (rig, secret, recordings) = stage(3, Hidden::Effect(kind));
        let (with, without) = (rig.physics(secret.as_ref()), rig.physics(None));
        let mut worst = 0.0_f64;
        for recording in &recordings {
            let replay = |physics| recording.commands.replay(physics, recording.mount);
            let (with, without) = (replay(&with), replay(&without));
            let squares: f64 = with
                .iter()
                .zip(&without)
                .map(|(a, b)| (a - b).powi(2))
                .sum();
            worst = worst.max((squares / with.len() as f64).sqrt());
        }
        println!("{kind:20} {worst:.4} rad rms");
        assert!(
            worst > 2.0 * handstand_shared::raw::Position::LSB_RAD,
            "{kind}: {worst} rad"
        );
    }
}

#[test]
fn the_replay_of_the_truth_is_the_log() {
    let (rig, secret, recordings) = stage(5, Hidden::Effect("delay"));
    let truth = rig.physics(secret.as_ref());
    for recording in &recordings {
        let sensed = recording.commands.replay(&truth, recording.mount);
        for (sensed, read) in sensed.iter().zip(&recording.position) {
            assert!((sensed - read).abs() < 0.5 * handstand_shared::raw::Position::LSB_RAD + 4e-3);
        }
    }
}

#[test]
fn the_arm_stays_clear_of_upright_and_moves_enough() {
    for kind in KINDS {
        for seed in 0..5 {
            let (_, secret, recordings) = stage(seed, Hidden::Effect(kind));
            let duty = |r: &ArmRecording| {
                r.commands
                    .duty
                    .iter()
                    .fold(0.0_f64, |most, u| most.max(u.abs()))
            };
            for (name, recording) in ["a", "b", "c"].iter().zip(&recordings) {
                let (q, w, u) = (recording.widest(), recording.fastest(), duty(recording));
                println!("{kind:20} {seed} {name}: {q:.2} rad {w:5.1} rad/s duty {u:.2}");
                assert!(q < 2.6, "{kind} {seed}: {secret:?}");
                assert!(q > 0.5, "{kind} {seed} hardly moves: {secret:?}");
            }
        }
    }
}

#[test]
fn a_sealed_answer_opens_and_a_changed_one_does_not() {
    let answer = generate(11, Hidden::Effect("cogging")).answer;
    let text = seal(&answer);
    assert!(!text.contains("cogging"));
    assert_eq!(unseal(&text).unwrap(), answer);
    let at = text.find("\"sealed\": \"").unwrap() + 20;
    let mut changed = text.clone();
    let other = if &text[at..=at] == "0" { "1" } else { "0" };
    changed.replace_range(at..=at, other);
    let error = unseal(&changed).unwrap_err();
    assert_eq!(error, ChallengeError::Changed);
    let error = Error::refused(Place::file("answer.sealed"), error);
    assert_eq!(error.exit_code(), 3);
    assert_eq!(unseal("{}").unwrap_err(), ChallengeError::NotSealed);
}

#[test]
fn nothing_hidden_is_said_so() {
    let answer = generate(2, Hidden::Nothing).answer;
    assert_eq!((answer.kind, answer.parameters.len()), (None, 0));
    let kinds: Vec<_> = (0..200).map(|seed| secret(seed, Hidden::Random)).collect();
    let nothing = kinds.iter().filter(|secret| secret.is_none()).count();
    assert!((5..40).contains(&nothing), "{nothing}");
}

#[test]
fn kinds_draw_their_values_apart() {
    let share = |kind, low: f64, high: f64| {
        let secret = secret(9, Hidden::Effect(kind)).unwrap();
        (secret.parameters[0].1 - low) / (high - low)
    };
    let shares = [
        share("viscous", 0.01, 0.04),
        share("coulomb", 0.02, 0.06),
        share("delay", 0.02, 0.08),
    ];
    for (a, b) in [(0, 1), (1, 2), (0, 2)] {
        assert!((shares[a] - shares[b]).abs() > 1e-3, "{shares:?}");
    }
}

#[test]
fn files_are_written_once() {
    let dir = tempfile::tempdir().unwrap();
    let challenge = generate(1, Hidden::Effect("backlash"));
    let inside = dir.path().join("new");
    write(&challenge, &inside).unwrap();
    for name in [
        "nominal.toml",
        "a.csv",
        "b.csv",
        "c.csv",
        "answer.sealed",
        "README.txt",
    ] {
        assert!(inside.join(name).is_file(), "{name}");
    }
    let again = write(&challenge, &inside).unwrap_err();
    assert_eq!(again.exit_code(), 2);
    assert!(!challenge.model_toml.contains("backlash"));
    assert!(challenge.answer.true_model_toml.contains("backlash"));
}
