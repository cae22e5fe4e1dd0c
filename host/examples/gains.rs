//! Design the gains that balance the three-link robot upright, in floating and in fixed point.
//!
//! ```sh
//! cargo run --release --example gains
//! ```

use handstand::synth::{CostWeights, Design, Format, Readings, Request, Time, Weight, upright};
use handstand::{Model, Result};
use std::path::Path;

/// The robot of the paper: a passive grip on the bar, torques at shoulder and hip.
const ROBOT: &str = include_str!("../models/handstand.toml");

fn main() -> Result<()> {
    let design = regulator()?;
    println!("K = {:.3}", design.gains.k);
    for pole in &design.gains.poles {
        println!("pole at {pole:.4}, {:.4} from the origin", pole.norm());
    }
    if let Some(fixed) = &design.fixed {
        println!("as integers: {:?}", fixed.law.bytes());
    }
    Ok(())
}

/// Discrete linear-quadratic regulator at 100 Hz, for a torque that acts 10 ms late.
pub fn regulator() -> Result<Design> {
    let robot = Model::parse(ROBOT, Path::new("handstand.toml"))?;
    let request = Request {
        pose_rad: upright(&robot),
        weights: CostWeights::PAPER,
        integral: None,
        time: Time::Sampled {
            ts_s: 0.01,
            delay_s: Some(0.01),
        },
        sensors: None,
        readings: Readings::default(),
        // The fixed-point law is proven not to overflow within half a radian and 10 rad/s.
        state_range: Weight::Diagonal(vec![0.5, 0.5, 0.5, 10.0, 10.0, 10.0]),
        input_range: None,
        format: Format::default(),
    };
    Ok(Design::of(&robot, &request)?)
}
