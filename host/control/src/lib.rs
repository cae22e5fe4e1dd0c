//! Gains that balance a robot, from its model to fixed-point tables; and servos identified as black
//! boxes.

pub mod synth;
pub mod sysid;

use handstand_fit::{compare, fitting};
use handstand_model::{dynamics, effects, error, model, motion, output};
use handstand_sim::sim;
