//! How long the model can run freely before an error in its start state swamps everything.

use super::data::{FitData, Horizon};
use super::node::Node;
use super::residual::residuals;
use crate::model::Model;

/// Growth of a small start error beyond which a free run says nothing about the model.
const MOST_GROWTH: f64 = 30.0;

/// The longest horizon at which start errors grow by less than thirty times: a whole run for a
/// stable plant, windows for an unstable or chaotic one.
pub fn longest_stable(model: &Model, data: &FitData) -> Horizon {
    let mut horizon = Horizon::Whole;
    let mut seconds = data.longest_s();
    while growth(model, &data.recut(horizon)) > MOST_GROWTH && seconds > 0.2 {
        seconds /= 2.0;
        horizon = Horizon::Seconds(seconds);
    }
    horizon
}

/// Root-mean-square growth of a start error over the last fifth of the windows, against its size.
fn growth(model: &Model, data: &FitData) -> f64 {
    let nodes: Vec<Node> = data.windows.iter().map(|w| Node::guess(data, w)).collect();
    let base = residuals(model, data, &nodes);
    let joints = data.sigma_rad.len();
    let mut worst: f64 = 0.0;
    for joint in 0..joints {
        let mut moved = nodes.clone();
        let delta = data.sigma_rad[joint];
        for node in &mut moved {
            node.unknowns[joint] += delta;
        }
        let shifted = residuals(model, data, &moved);
        for (a, b) in base.windows.iter().zip(&shifted.windows) {
            let tail = a.len() / joints * 4 / 5;
            let (mut sum, mut count) = (0.0, 0);
            for part in 0..joints {
                let from = part * a.len() / joints + tail;
                let to = (part + 1) * a.len() / joints;
                for k in from..to {
                    sum += (a[k] - b[k]).powi(2);
                    count += 1;
                }
            }
            worst = worst.max((sum / f64::from(count.max(1))).sqrt());
        }
    }
    worst
}
