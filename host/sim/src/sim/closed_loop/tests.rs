use super::*;
use crate::model::Model;
use std::path::Path;

mod drives;

/// The paper's discrete gains: Q = 100 I, R = I, 10 ms.
fn paper_gains() -> StateFeedback {
    StateFeedback::new(
        3,
        vec![
            vec![
                -75.758443, -32.187228, -11.454290, -13.004784, -6.2134254, -2.3441985,
            ],
            vec![
                -62.056988, -26.928273, -9.0350845, -10.653945, -5.1619377, -1.8225471,
            ],
        ],
    )
}

fn model() -> Model {
    let text = include_str!("../../../../models/handstand.toml");
    Model::parse(text, Path::new("handstand.toml")).unwrap()
}

const POSE: [f64; 3] = [std::f64::consts::FRAC_PI_2, 0.0, 0.0];

fn upright() -> PosedPlant {
    PosedPlant::new(&model(), &POSE, Commands::Torque).unwrap()
}

/// The robot with one more effect at a joint, counted from 0.
fn with(effects: &[(&str, usize, &[f64])]) -> Model {
    let mut model = model();
    for (id, joint, values) in effects {
        model.effects.push(crate::model::EffectInstance {
            effect: crate::effects::named(id).unwrap(),
            joint: Some(*joint),
            values: values.to_vec(),
        });
    }
    model
}

/// The loop of a model, 10 ms.
fn loop_of(model: &Model) -> ClosedLoop {
    ClosedLoop::new(model, &POSE, Commands::Torque, 0.01).unwrap()
}

fn one(
    closed: &ClosedLoop,
    controller: &dyn Controller,
    start: &InitialState,
    seconds: f64,
) -> Outcome {
    closed.run(controller, start, seconds, stream(1, 0))
}

const TILT: f64 = 2.0 * std::f64::consts::PI / 180.0;

#[test]
fn the_papers_gains_hold_it_up_and_none_lets_it_fall() {
    let closed = ClosedLoop::around(upright(), 0.01);
    let start = InitialState::at([TILT, 0.0, 0.0]);
    // Its slowest pole is slow: 2 deg swing to 28 deg and need 4 s to die out.
    let held = one(&closed, &paper_gains(), &start, 12.0);
    assert!(held.stabilised && held.settle_s.unwrap() < 5.0, "{held:?}");
    assert!(held.limit_cycle_rad.unwrap() < 1e-5, "{held:?}");
    let mut slack = paper_gains();
    slack.gains.iter_mut().flatten().for_each(|k| *k = 0.0);
    let fell = one(&closed, &slack, &start, 5.0);
    assert!(
        fell.fell_s.unwrap() < 1.0 && fell.rms_torque_nm == 0.0,
        "{fell:?}"
    );
}

#[test]
fn both_equations_agree() {
    let dense = ClosedLoop::around(upright(), 0.01);
    let general = ClosedLoop::around(upright().by_general_simulation(), 0.01);
    let start = InitialState::at([TILT, -TILT, TILT]);
    let ours = one(&dense, &paper_gains(), &start, 2.0);
    let theirs = one(&general, &paper_gains(), &start, 2.0);
    assert!((ours.rms_angle_rad - theirs.rms_angle_rad).abs() < 1e-12);
    assert!((ours.rms_torque_nm - theirs.rms_torque_nm).abs() < 1e-10);
}

#[test]
fn a_step_of_1_ms_is_short_enough() {
    let closed = ClosedLoop::around(upright(), 0.01);
    let mut fine = closed.clone();
    fine.plant.step_s = 1e-4;
    let start = InitialState::at([TILT, -TILT, TILT]);
    let [coarse, fine] = [closed, fine].map(|c| one(&c, &paper_gains(), &start, 2.0));
    assert!(
        (coarse.rms_angle_rad / fine.rms_angle_rad - 1.0).abs() < 1e-6,
        "{coarse:?} {fine:?}"
    );
}

#[test]
fn eccentric_masses_are_held_with_compensation_only_at_their_balance() {
    let angles = [0.03, -0.05, 0.04];
    let model = with(&[
        ("com_angle", 0, &angles[..1]),
        ("com_angle", 1, &angles[1..2]),
        ("com_angle", 2, &angles[2..]),
    ]);
    let plant = PosedPlant::new(&model, &POSE, Commands::Torque).unwrap();
    let balance = plant.balanced_rad();
    assert!(balance.iter().any(|a| a.abs() > 0.01), "{balance:?}");
    let closed = ClosedLoop::around(plant, 0.01);
    let start = InitialState::at(balance.clone());
    let compensated = KnownEquilibrium::new(Box::new(paper_gains()), balance.clone());
    let held = one(&closed, &compensated, &start, 5.0);
    assert!(held.rms_torque_nm < 1e-9, "{held:?}");
    let plain = one(&closed, &paper_gains(), &start, 5.0);
    assert!(plain.rms_torque_nm > 0.01, "{plain:?}");
}

#[test]
fn only_what_needs_the_general_simulation_gets_it() {
    let dense = |effects: &[(&str, usize, &[f64])]| loop_of(&with(effects)).plant.is_dense();
    assert!(dense(&[("mass", 0, &[0.1]), ("delay", 1, &[0.01])]));
    assert!(dense(&[
        ("dead_zone", 1, &[0.1, 0.0]),
        ("torque_saturation", 2, &[1.0])
    ]));
    assert!(dense(&[("encoder_scale", 1, &[1.1])]));
    // A column's times are of the log, not of the loop.
    assert!(dense(&[("time_offset", 1, &[0.02])]));
    for (id, joint, values) in [
        ("coulomb", 0, &[0.01][..]),
        ("viscous", 2, &[0.01]),
        ("speed_limit", 1, &[5.0]),
        ("backlash", 1, &[0.01]),
        ("cable_spring", 2, &[0.1, 0.0]),
    ] {
        assert!(!dense(&[(id, joint, values)]), "{id}");
    }
}

/// Effects that vanish leave the general simulation where the dense equations are.
#[test]
fn the_general_simulation_agrees_where_its_effects_vanish() {
    let start = InitialState::at([TILT, -TILT, TILT]);
    let ours = one(&loop_of(&model()), &paper_gains(), &start, 2.0);
    let viscous = [("viscous", 0, &[0.0][..])];
    // Friction that vanishes still ends a step where a joint turns back.
    let coulomb = [("coulomb", 1, &[0.0][..])];
    for (effects, tolerance) in [(viscous, 1e-12), (coulomb, 1e-6)] {
        let theirs = one(&loop_of(&with(&effects)), &paper_gains(), &start, 2.0);
        let angle = ours.rms_angle_rad - theirs.rms_angle_rad;
        let torque = ours.rms_torque_nm - theirs.rms_torque_nm;
        assert!(
            angle.abs() < tolerance && torque.abs() < 10.0 * tolerance,
            "{angle} {torque}"
        );
    }
}

/// A robot that hangs, its shoulder stuck: it swings as if the joint were locked, and the drive's
/// 0.1 N m do nothing.
#[test]
fn friction_sticks_in_the_loop() {
    let model = with(&[("coulomb", 1, &[5.0]), ("coulomb", 2, &[5.0])]);
    let hanging = [-std::f64::consts::FRAC_PI_2, 0.0, 0.0];
    let mut closed = ClosedLoop::new(&model, &hanging, Commands::Torque, 0.01).unwrap();
    closed.limits.fall_rad = f64::INFINITY;
    let mut last = [f64::NAN; 3];
    let start = InitialState::at([0.3, 0.1, -0.2]);
    let constant = StateFeedback::new(3, vec![vec![0.0; 6]; 2]).feeding(&[0.1, -0.1]);
    closed.watch(&constant, &start, 0.5, stream(1, 0), |sample| {
        last.copy_from_slice(sample.angle_rad);
    });
    assert!(
        (last[1] - 0.1).abs() < 1e-12 && (last[2] + 0.2).abs() < 1e-12,
        "{last:?}"
    );
    assert!((last[0] - 0.3).abs() > 0.1, "{last:?}");
}

#[test]
fn encoders_of_the_model_are_what_is_measured() {
    let model = with(&[("encoder_scale", 1, &[1.1])]);
    let mut seen = [0.0; 2];
    let start = InitialState::at([0.02, 0.01, 0.0]);
    loop_of(&model).watch(&paper_gains(), &start, 0.01, stream(1, 0), |sample| {
        if sample.time_s == 0.0 {
            seen = [sample.measured.angle_rad[0], sample.measured.angle_rad[1]];
        }
    });
    assert!(
        (seen[0] - 0.02).abs() < 1e-15 && (seen[1] - 0.011).abs() < 1e-15,
        "{seen:?}"
    );
}

#[test]
fn sensors_round_and_difference() {
    let sensor = Sensor {
        position_resolution_rad: 0.01,
        velocity: Velocity::Difference,
        gyro: Some(Gyro {
            resolution_rad_s: 0.5,
            noise_rad_s: 0.0,
        }),
        ..Sensor::EXACT
    };
    let (mut angle, mut speed) = ([0.0; 2], [0.0; 2]);
    let rng = &mut stream(1, 0);
    sensor.read(
        0.1,
        true,
        &[0.013, -0.026],
        &[0.7, 0.7],
        0.7,
        &mut angle,
        &mut speed,
        rng,
    );
    assert_eq!((angle, speed), ([0.01, -0.03], [0.5, 0.0]));
    sensor.read(
        0.1,
        false,
        &[0.018, -0.013],
        &[0.8, 0.7],
        0.8,
        &mut angle,
        &mut speed,
        rng,
    );
    assert_eq!(angle, [0.02, -0.01]);
    assert!((speed[1] - 0.2).abs() < 1e-12 && speed[0] == 1.0);
}

#[test]
fn a_run_is_the_same_whatever_runs_beside_it() {
    let plain = ClosedLoop::around(upright(), 0.01);
    let late = loop_of(&with(&[("delay", 1, &[0.003]), ("delay", 2, &[0.003])]));
    let mut wild = plain.clone();
    wild.clock.jitter = 0.4;
    let controller = paper_gains();
    let jobs: Vec<Job<'_>> = (0..31)
        .map(|i| Job {
            closed: [&plain, &late, &wild][i % 3],
            controller: &controller,
            // Some fall at once, some later, some never.
            start: InitialState::at([0.004 * i as f64, 0.0, 0.0]),
            seconds: 0.1 * i as f64,
            rng: stream(4, i as u64),
        })
        .collect();
    let alone: Vec<Outcome> = jobs
        .iter()
        .map(|j| {
            j.closed
                .run(j.controller, &j.start, j.seconds, j.rng.clone())
        })
        .collect();
    assert!(alone.iter().any(|o| o.fell_s.is_none()) && !alone.iter().all(|o| o.fell_s.is_none()));
    assert_eq!(run_jobs(jobs), alone);
}

#[test]
fn chance_is_the_same_on_any_number_of_threads() {
    let mut closed = ClosedLoop::around(upright(), 0.01);
    closed.sensor.position_noise_rad = 1e-3;
    closed.clock.jitter = 0.3;
    closed.clock.loss = 0.05;
    let starts: Vec<InitialState> = (0..40)
        .map(|i| InitialState::random(3, TILT, &mut stream(2, i)))
        .collect();
    let on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap();
        pool.install(|| closed.run_all(&paper_gains(), &starts, 1.0, 3))
    };
    let once = on(1);
    assert_eq!(once, on(5));
    assert!(once.windows(2).any(|pair| pair[0] != pair[1]));
}
