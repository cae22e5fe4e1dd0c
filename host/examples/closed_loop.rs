//! Close the loop in simulation: gains from a linear design, on a robot with friction that the
//! design leaves out.
//!
//! ```sh
//! cargo run --release --example closed_loop
//! ```

use handstand::sim::closed_loop::{
    ClosedLoop, Commands, InitialState, Outcome, StateFeedback, stream,
};
use handstand::synth::{
    CostWeights, Design, Format, Readings, Request, Time, Weight, rows, upright,
};
use handstand::{Model, Result};
use std::path::Path;

/// The robot of the paper, and what its shoulder and hip have besides.
const ROBOT: &str = include_str!("../models/handstand.toml");
const FRICTION: &str = "
[[effect]]
kind = \"coulomb\"
joint = 2
torque_nm = 0.02

[[effect]]
kind = \"coulomb\"
joint = 3
torque_nm = 0.02
";
/// Sampling time, s.
const PERIOD_S: f64 = 0.01;
/// Length of a run, s.
const RUN_S: f64 = 5.0;

fn main() -> Result<()> {
    for degrees in [0.5, 1.0, 2.0, 4.0, 8.0] {
        let outcome = held_from(degrees)?;
        println!("from {degrees} deg at every joint: {outcome:?}");
    }
    Ok(())
}

/// A run of five seconds from this angle at every joint, degrees.
pub fn held_from(degrees: f64) -> Result<Outcome> {
    let robot = Model::parse(&format!("{ROBOT}{FRICTION}"), Path::new("robot.toml"))?;
    let design = Design::of(&robot, &request(&robot))?;
    // Coulomb friction jumps, so that no linear design can hold it: it is listed, and stays in the
    // simulation.
    assert_eq!(design.omitted.len(), 2);

    let controller = StateFeedback::new(robot.link_count(), rows(&design.gains.k));
    let closed = ClosedLoop::new(&robot, &upright(&robot), Commands::Own, PERIOD_S)?;
    let start = InitialState::at(vec![degrees.to_radians(); robot.link_count()]);
    // Nothing is random in this loop; sensors with noise would draw from this stream.
    Ok(closed.run(&controller, &start, RUN_S, stream(1, 0)))
}

fn request(robot: &Model) -> Request {
    Request {
        pose_rad: upright(robot),
        weights: CostWeights::PAPER,
        integral: None,
        time: Time::Sampled {
            ts_s: PERIOD_S,
            delay_s: None,
        },
        sensors: None,
        readings: Readings::default(),
        state_range: Weight::Diagonal(vec![0.5, 0.5, 0.5, 10.0, 10.0, 10.0]),
        input_range: None,
        format: Format::default(),
    }
}
