//! Logs of an arm in space of which one joint follows another convention than the robot's file: is
//! that told, and of the right joint?
//!
//! MuJoCo simulates the arm; reading and goal of the joint are written reversed, from another zero
//! or in another unit, as another calibration of its servo does it.

mod case;
mod judging;

pub use case::{Convention, ConventionCase};
pub use judging::{ConventionOutcome, try_convention};
