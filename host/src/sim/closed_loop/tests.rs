use super::*;
use crate::model::Model;
use std::path::Path;

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
    let text = include_str!("../../models/handstand.toml");
    Model::parse(text, Path::new("handstand.toml")).unwrap()
}

fn upright() -> Plant {
    Plant::new(&model(), &[std::f64::consts::FRAC_PI_2, 0.0, 0.0]).unwrap()
}

fn one(closed: &ClosedLoop, controller: &dyn Controller, start: &Start, seconds: f64) -> Outcome {
    closed.run(controller, start, seconds, stream(1, 0))
}

const TILT: f64 = 2.0 * std::f64::consts::PI / 180.0;

#[test]
fn the_papers_gains_hold_it_up_and_none_lets_it_fall() {
    let closed = ClosedLoop::ideal(upright(), 0.01);
    let start = Start::at([TILT, 0.0, 0.0]);
    // Its slowest pole is slow: 2 deg swing to 28 deg and need 4 s to die out.
    let held = one(&closed, &paper_gains(), &start, 12.0);
    assert!(held.survived() && held.settle_s.unwrap() < 5.0, "{held:?}");
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
    let dense = ClosedLoop::ideal(upright(), 0.01);
    let chain = ClosedLoop::ideal(upright().by_articulated_bodies(), 0.01);
    let start = Start::at([TILT, -TILT, TILT]);
    let ours = one(&dense, &paper_gains(), &start, 2.0);
    let theirs = one(&chain, &paper_gains(), &start, 2.0);
    assert!((ours.rms_angle_rad - theirs.rms_angle_rad).abs() < 1e-12);
    assert!((ours.rms_torque_nm - theirs.rms_torque_nm).abs() < 1e-10);
}

#[test]
fn a_step_of_1_ms_is_short_enough() {
    let closed = ClosedLoop::ideal(upright(), 0.01);
    let mut fine = closed.clone();
    fine.plant.step_s = 1e-4;
    let start = Start::at([TILT, -TILT, TILT]);
    let [coarse, fine] = [closed, fine].map(|c| one(&c, &paper_gains(), &start, 2.0));
    assert!(
        (coarse.rms_angle_rad / fine.rms_angle_rad - 1.0).abs() < 1e-6,
        "{coarse:?} {fine:?}"
    );
}

#[test]
fn eccentric_masses_are_held_with_compensation_only_at_their_balance() {
    let mut model = model();
    let angle = |joint: usize, angle: f64| crate::model::EffectInstance {
        effect: crate::effects::named("com_angle").unwrap(),
        joint: Some(joint),
        values: vec![angle],
    };
    model.effects = vec![angle(0, 0.03), angle(1, -0.05), angle(2, 0.04)];
    let plant = Plant::new(&model, &[std::f64::consts::FRAC_PI_2, 0.0, 0.0]).unwrap();
    let balance = plant.balanced_rad();
    assert!(balance.iter().any(|a| a.abs() > 0.01), "{balance:?}");
    let closed = ClosedLoop::ideal(plant, 0.01);
    let start = Start::at(balance.clone());
    let held = one(&closed, &paper_gains().holding(&balance), &start, 5.0);
    assert!(held.rms_torque_nm < 1e-9, "{held:?}");
    let plain = one(&closed, &paper_gains(), &start, 5.0);
    assert!(plain.rms_torque_nm > 0.01, "{plain:?}");
}

/// A controller that asks for one torque after another: 1, 2, 3 N m ...
#[derive(Debug)]
struct Counting;

impl Controller for Counting {
    fn memory_len(&self) -> usize {
        1
    }
    fn control(&self, memory: &mut [f64], _seen: Seen<'_>, torque_nm: &mut [f64]) {
        memory[0] += 1.0;
        torque_nm.fill(memory[0]);
    }
}

#[test]
fn a_command_takes_effect_after_its_delay() {
    let mut closed = ClosedLoop::ideal(upright(), 0.01);
    closed.limits.fall_rad = f64::INFINITY;
    let torques = |closed: &ClosedLoop| {
        let mut seen = Vec::new();
        closed.watch(
            &Counting,
            &Start::at([0.0; 3]),
            0.06,
            stream(1, 0),
            |sample| {
                seen.push(sample.torque_nm[0]);
            },
        );
        seen
    };
    assert_eq!(torques(&closed), [0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0]);
    closed.conditions.actuator.delay_periods = 2.0;
    assert_eq!(torques(&closed), [0.0, 0.0, 0.0, 1.0, 2.0, 3.0, 4.0]);
    closed.conditions.actuator.delay_periods = 1.5;
    assert_eq!(torques(&closed), [0.0, 0.0, 1.0, 2.0, 3.0, 4.0, 5.0]);
    // The effort tells when within a period the torque changes.
    let effort = |delay: f64| {
        let mut closed = closed.clone();
        closed.conditions.actuator.delay_periods = delay;
        one(&closed, &Counting, &Start::at([0.0; 3]), 0.02).rms_torque_nm
    };
    assert!((effort(0.25) - ((0.75 + 0.25 + 0.75 * 4.0) / 2.0f64).sqrt()).abs() < 1e-9);
    closed.conditions.clock.loss = 1.0;
    assert_eq!(torques(&closed), [0.0; 7]);
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
        &mut angle,
        &mut speed,
        rng,
    );
    assert_eq!(angle, [0.02, -0.01]);
    assert!((speed[1] - 0.2).abs() < 1e-12 && speed[0] == 1.0);
}

#[test]
fn a_run_is_the_same_whatever_runs_beside_it() {
    let plain = ClosedLoop::ideal(upright(), 0.01);
    let mut late = plain.clone();
    late.conditions.actuator.delay_periods = 0.3;
    let mut wild = plain.clone();
    wild.conditions.clock.jitter = 0.4;
    let controller = paper_gains();
    let jobs: Vec<Job<'_>> = (0..31)
        .map(|i| Job {
            closed: [&plain, &late, &wild][i % 3],
            controller: &controller,
            // Some fall at once, some later, some never.
            start: Start::at([0.004 * i as f64, 0.0, 0.0]),
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
    assert!(alone.iter().any(|o| o.survived()) && !alone.iter().all(|o| o.survived()));
    assert_eq!(run_jobs(jobs), alone);
}

#[test]
fn chance_is_the_same_on_any_number_of_threads() {
    let mut closed = ClosedLoop::ideal(upright(), 0.01);
    closed.conditions.sensor.position_noise_rad = 1e-3;
    closed.conditions.clock.jitter = 0.3;
    closed.conditions.clock.loss = 0.05;
    let starts: Vec<Start> = (0..40)
        .map(|i| Start::random(3, TILT, &mut stream(2, i)))
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
