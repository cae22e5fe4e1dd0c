use super::gyro::GyroLaw;
use super::physics::{DriveCommand, Mount, Physics};
use super::regulator::RobotRegulator;
use super::robot::{Laws, Robot};
use super::truth::Arm;
use super::*;
use handstand_model::error::Place;

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

/// Root-mean-square difference; 0 of nothing.
fn apart(a: &[f64], b: &[f64]) -> f64 {
    let squares: f64 = a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum();
    (squares / a.len().max(1) as f64).sqrt()
}

#[test]
fn every_effect_changes_the_motion() {
    for kind in KINDS {
        let (rig, secrets, recordings) = stage(3, &[kind]);
        let (with, mut without) = (rig.physics(&secrets), rig.physics(&[]));
        without.gyro = with.gyro.map(|_| GyroLaw::default());
        let mut worst = 0.0_f64;
        for recording in &recordings {
            let replay = |physics| recording.commands.replay(physics, recording.mount);
            let ((with, with_rates), (without, rates)) = (replay(&with), replay(&without));
            let steps = handstand_shared::raw::Position::LSB_RAD;
            worst = worst.max(apart(&with, &without) / steps);
            // Both gyros meet the same noise.
            worst = worst.max(apart(&with_rates, &rates) / gyro::STEP_RAD_S);
        }
        println!("{kind:20} {worst:.2} steps rms");
        assert!(
            worst > if rig.has_gyro { 0.9 } else { 2.0 },
            "{kind}: {worst} steps"
        );
    }
}

#[test]
fn the_replay_of_the_truth_is_the_log() {
    let (rig, secrets, recordings) = stage(5, &["delay"]);
    let truth = rig.physics(&secrets);
    for recording in &recordings {
        let (sensed, _) = recording.commands.replay(&truth, recording.mount);
        for (sensed, read) in sensed.iter().zip(&recording.position) {
            assert!((sensed - read).abs() < 0.5 * handstand_shared::raw::Position::LSB_RAD + 4e-3);
        }
    }
}

#[test]
fn the_arm_stays_clear_of_upright_and_moves_enough() {
    for kind in KINDS {
        for seed in 0..5 {
            let (_, secret, recordings) = stage(seed, &[kind]);
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
    assert_eq!(unseal::<ChallengeAnswer>(&text).unwrap(), answer);
    let at = text.find("\"sealed\": \"").unwrap() + 20;
    let mut changed = text.clone();
    let other = if &text[at..=at] == "0" { "1" } else { "0" };
    changed.replace_range(at..=at, other);
    let error = unseal::<ChallengeAnswer>(&changed).unwrap_err();
    assert_eq!(
        error.what,
        "the sealed answer was changed: its SHA-256 does not match"
    );
    assert_eq!(error.at(Place::file("answer.sealed")).exit_code(), 3);
    assert_eq!(
        unseal::<ChallengeAnswer>("{}").unwrap_err().what,
        "not a sealed answer"
    );
}

#[test]
fn nothing_hidden_is_said_so() {
    let answer = generate(2, Hidden::Nothing).answer;
    assert_eq!((answer.kind, answer.parameters.len()), (None, 0));
    let kind = |seed| HiddenEffect::kind(&mut stream(seed, 0), Hidden::Random);
    let kinds: Vec<_> = (0..200).map(kind).collect();
    let nothing = kinds.iter().filter(|kind| kind.is_none()).count();
    assert!((5..40).contains(&nothing), "{nothing}");
}

#[test]
fn kinds_draw_their_values_apart() {
    let share = |kind, low: f64, high: f64| {
        let secret = secret(9, kind);
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

/// Three links without friction, hip and shoulder driven.
fn robot_laws() -> Laws {
    let joint =
        |com_m, mass_kg, inertia, stall| Physics::ideal(com_m, mass_kg, inertia, stall, 9.8);
    Laws {
        joints: [
            joint(0.07, 0.37, 8e-4, 0.0),
            joint(0.06, 0.98, 3.3e-3, 3.0),
            joint(0.12, 0.58, 1.1e-3, 3.0),
        ],
        length_m: [0.14, 0.12, 0.18],
        turned: false,
    }
}

#[test]
fn a_robot_without_friction_keeps_its_energy() {
    let mut laws = robot_laws();
    laws.joints[1].switch_on("com_angle", &[0.2]);
    let mut robot = Robot::new(&laws, [1.5, -0.7, 0.4], [0.0, 2.0, -3.0]);
    let before = robot.energy_j();
    for _ in 0..200 {
        robot.advance(0.01, |_| [RELEASED; 3]);
        let change = robot.energy_j() - before;
        assert!(change.abs() < 1e-4, "{change} J");
    }
}

#[test]
fn a_robot_stuck_by_friction_stays_put_and_a_pushed_joint_moves() {
    let mut laws = robot_laws();
    for joint in &mut laws.joints {
        joint.switch_on("coulomb", &[0.2]);
    }
    // Gravity asks less of every joint than friction holds.
    let stuck = [0.02, 0.01, -0.02];
    let mut robot = Robot::new(&laws, stuck, [0.0; 3]);
    robot.advance(2.0, |_| [RELEASED; 3]);
    for (angle, start) in robot.angle.iter().zip(stuck) {
        assert!((angle - start).abs() < 1e-9, "{angle}");
    }
    let pushed = DriveCommand {
        duty: 0.2,
        torque_on: true,
        ..RELEASED
    };
    robot.advance(0.3, |_| [RELEASED, RELEASED, pushed]);
    assert!(robot.angle[2] > 0.1, "{:?}", robot.angle);
}

#[test]
fn a_regulator_holds_the_robot_upright_where_it_leans_and_where_drives_are_late() {
    let mut laws = robot_laws();
    laws.joints[2].switch_on("com_angle", &[0.1]);
    laws.joints[1].switch_on("delay", &[0.013]);
    let mut regulator = RobotRegulator::upright(&laws).unwrap();
    let start = regulator.pose.map(|angle| angle + 0.002);
    assert!((start[0] - std::f64::consts::PI).abs() > 0.01);
    let mut robot = Robot::new(&laws, start, [0.0; 3]);
    let mut past = [regulator.holding; 2];
    for _ in 0..300 {
        let duty = regulator.duty(&robot.angle, &robot.speed, &[0.0; 2]);
        let sent = |duty| DriveCommand {
            duty,
            supply_v: 9.8,
            torque_on: true,
        };
        robot.advance(0.01, |since_s| {
            let late = if since_s < 0.003 { past[0] } else { past[1] };
            [RELEASED, sent(late[0]), sent(duty[1])]
        });
        past = [past[1], duty];
    }
    for (angle, pose) in robot.angle.iter().zip(&regulator.pose) {
        assert!((angle - pose).abs() < 1e-3, "{:?}", robot.angle);
    }
}

#[test]
fn a_bench_hides_what_it_is_told_and_its_owner_does_not_know() {
    let arm = bench(Motions::Arm, 4, &["delay", "viscous"]).unwrap();
    assert_eq!(arm, bench(Motions::Arm, 4, &["delay", "viscous"]).unwrap());
    let kinds: Vec<&str> = arm.effects.iter().map(|effect| effect.kind).collect();
    assert_eq!(kinds, ["delay", "viscous"]);
    assert!(!arm.model_toml.contains("delay") && arm.true_model_toml.contains("delay"));
    let robot = bench(Motions::Balancing, 4, &["viscous"]).unwrap();
    let held_out = robot.logs.iter().filter(|log| log.held_out).count();
    assert_eq!((robot.logs.len(), held_out), (5, 2));
    let joint = robot.effects[0].joint.unwrap();
    let lines = |toml: &str| toml.matches("\"viscous\"").count();
    let known = if joint == 1 { 2 } else { 1 };
    assert_eq!(lines(&robot.model_toml), known);
    assert_eq!(
        lines(&robot.true_model_toml),
        if joint == 1 { 3 } else { 2 }
    );
}

#[test]
fn a_true_model_is_the_bench_s() {
    for (motions, kinds) in [
        (Motions::Arm, ["delay", "viscous"]),
        (Motions::Arm, ["torque_saturation", "coulomb"]),
        (Motions::Hanging, ["mass", "dead_zone"]),
    ] {
        let bench = bench(motions, 6, &kinds).unwrap();
        assert_eq!(
            true_model_toml(motions, 6, &kinds),
            Some(bench.true_model_toml)
        );
    }
}
