//! A plant held at a pose by its controller: plant, sensor, controller and delay closed to a loop.
//!
//! States are deviations from the pose that is held (upright, for the handstand), joint by joint,
//! each relative to the link before. Configurations are shared by many runs at once; what changes
//! during a run is kept apart. A run allocates at its beginning only.
//!
//! ```text
//! plant x(t) -> sensor -> y(k) -> controller -> u(k) -> delay
//!            -> drives with their effects -> torque -> plant
//! ```

mod body;
mod clock;
mod closed;
mod controller;
mod convention;
mod drives;
mod equations;
mod general;
mod known_equilibrium;
mod lanes;
mod outcome;
mod pending;
mod posed_plant;
mod random;
mod run;
mod sensor;
pub mod state_feedback;

#[cfg(test)]
mod tests;

pub use clock::Clock;
pub use closed::{ClosedLoop, InitialState, Job, run_jobs};
pub use controller::{Controller, Measurement};
pub use drives::Drives;
pub use drives::set_delay;
pub use known_equilibrium::KnownEquilibrium;
pub use outcome::{Outcome, StabilityCriteria};
pub use posed_plant::{Commands, PosedPlant};
pub use random::{normal, stream};
pub use run::Sample;
pub use sensor::{GYRO_STEP_RAD_S, Gyro, Sensor, Velocity};
pub use state_feedback::StateFeedback;
