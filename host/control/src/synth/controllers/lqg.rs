//! LQG: the paper's regulator on a Kalman filter's state, the delay in the model.

use super::observed::{ObservedDesign, Options};
use super::{ControllerInfo, Speeds};

/// From angles and gyro alone; rounding counts as noise.
pub const LQG: ObservedDesign = ObservedDesign {
    info: ControllerInfo {
        id: "lqg",
        title: "LQG with delay states",
        law: "u = -K [x, past u], estimated",
        speeds: Speeds::Estimated,
        known_equilibrium: true,
        reference: "Astrom, Wittenmark, Computer-Controlled Systems, 3rd ed., chapter 11",
    },
    options: Options {
        delay: true,
        ..Options::PAPER
    },
};
