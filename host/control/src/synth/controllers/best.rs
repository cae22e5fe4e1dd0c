//! All of it together: what holds the robot under everything at once.

use super::observed::{ObservedDesign, Options};
use super::{ControllerInfo, Speeds};

/// LQG from angles and gyro, balance estimated, delay in the model, commands through the dead
/// zone's inverse. Its settings: found by random search over 150 robots that start within 2.5 deg
/// under everything at once, then rounded.
pub const BEST: ObservedDesign = ObservedDesign {
    info: ControllerInfo {
        id: "best",
        title: "LQG, offsets, delay, inverse",
        law: "u = inverse(-K [x - x_balance, past u]), all estimated",
        speeds: Speeds::Estimated,
        known_equilibrium: false,
        reference: "the parts above",
    },
    options: Options {
        offsets: true,
        delay: true,
        servo: true,
        inverse: true,
        weights: [&[0.002, 1.0, 7.0], &[0.5, 0.4, 10.0]],
        torque_noise_nm: 0.06,
        offset_walk_rad: 2.3e-4,
        ..Options::PAPER
    },
};
