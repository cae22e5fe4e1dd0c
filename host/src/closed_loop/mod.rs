//! A robot held up by its controller: plant, sensor, controller and actuator closed to a loop.
//!
//! Everything is told as a deviation from the pose that is held (upright, for the handstand), joint by joint, each
//! relative to the link before. Every piece is a small configuration; what changes during a run is kept apart from it,
//! so that one loop serves many runs at once. A run allocates at its beginning only.
//!
//! ```text
//! plant x(t) -> sensor -> y(k) -> controller -> u(k) -> delay -> actuator -> torque -> plant
//! ```

mod actuator;
mod clock;
mod closed;
mod conditions;
mod controller;
mod outcome;
mod pending;
mod plant;
mod random;
mod run;
mod sensor;
mod side_by_side;
pub(crate) mod state_feedback;

#[cfg(test)]
mod tests;

pub use actuator::Actuator;
pub use clock::Clock;
pub use closed::{ClosedLoop, Job, Start, run_jobs};
pub use conditions::Conditions;
pub use controller::{Controller, Seen};
pub use outcome::{Limits, Outcome};
pub use plant::Plant;
pub use random::{normal, stream};
pub use run::Sample;
pub use sensor::{Gyro, Sensor, Velocity};
pub use state_feedback::StateFeedback;
