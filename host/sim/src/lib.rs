//! A model simulated along its logs and in closed loops, fitted to them, and compared with them.

pub mod compare;
pub mod fitting;
pub mod sim;

use handstand_model::{dynamics, effects, error, model, motion, output};
