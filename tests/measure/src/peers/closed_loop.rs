//! Closed-loop runs of the paper's robot, as `closed_loop.py` has them.

use handstand::Model;
use handstand::effects::named;
use handstand::model::EffectInstance;
use handstand::sim::closed_loop::{
    ClosedLoop, Commands, Drives, InitialState, StateFeedback, stream,
};
use std::path::Path;
use std::time::Instant;

/// Sampled regulator for Q = 100 I, R = I, 10 ms.
const GAINS: [[f64; 6]; 2] = [
    [
        -75.758443, -32.187228, -11.454290, -13.004784, -6.2134254, -2.3441985,
    ],
    [
        -62.056988, -26.928273, -9.0350845, -10.653945, -5.1619377, -1.8225471,
    ],
];
const START_RAD: [f64; 3] = [0.01, -0.02, 0.02];
const RUN_S: f64 = 5.0;
const PERIOD_S: f64 = 0.01;

/// What the robot of a run is like.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Robot {
    /// A rigid chain with ideal drives.
    Ideal,
    /// Coulomb friction of 5 mN m at shoulder and hip, a dead zone of 1 %, 2 N m at most, 5 ms of
    /// delay.
    WithEffects,
}

fn task(robot: Robot) -> (ClosedLoop, StateFeedback) {
    let text = include_str!("../../../../host/models/handstand.toml");
    let mut model = Model::parse(text, Path::new("handstand.toml")).expect("our own model");
    if robot == Robot::WithEffects {
        let coulomb = named("coulomb").expect("an effect of the library");
        model.effects = [1, 2]
            .map(|joint| EffectInstance {
                effect: coulomb,
                joint: Some(joint),
                values: vec![0.005],
            })
            .to_vec();
        let drives = Drives {
            saturates: true,
            dead_zone: 0.01,
            delay_periods: 0.5,
            ..Drives::IDEAL
        };
        model = drives.on(&model, PERIOD_S);
    }
    let pose = [std::f64::consts::FRAC_PI_2, 0.0, 0.0];
    let closed = ClosedLoop::new(&model, &pose, Commands::Torque, PERIOD_S);
    (
        closed.expect("three links, two drives"),
        StateFeedback::new(3, GAINS.map(|row| row.to_vec()).to_vec()),
    )
}

/// 5-s runs per second on that many threads.
pub fn runs_per_second(robot: Robot, threads: usize, runs: usize) -> f64 {
    let (closed, controller) = task(robot);
    let starts: Vec<InitialState> = (0..runs)
        .map(|i| InitialState::at(START_RAD.map(|angle| angle + 1e-6 * i as f64)))
        .collect();
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
    pool.expect("threads can be started").install(|| {
        let begun = Instant::now();
        let outcomes = closed.run_all(&controller, &starts, RUN_S, 1);
        let seconds = begun.elapsed().as_secs_f64();
        assert!(outcomes.iter().all(|outcome| outcome.stabilised));
        runs as f64 / seconds
    })
}

/// Relative angles after `seconds` of one run, deviations from upright, rad.
pub fn angles_after(robot: Robot, seconds: f64) -> Vec<f64> {
    let (closed, controller) = task(robot);
    let mut last = Vec::new();
    let start = InitialState::at(START_RAD);
    closed.watch(&controller, &start, seconds, stream(1, 0), |sample| {
        last = sample.angle_rad.to_vec();
    });
    last
}
