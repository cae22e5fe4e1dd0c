//! Where samples come from, and where goals go.

use super::sample::Sample;
use crate::error::Result;

/// Servos that can be sampled, and moved.
pub trait Source {
    /// Sends goals, in the order of ids, if there are any; waits for the next sample. None: it did not come in time.
    ///
    /// # Errors
    /// The device failed.
    fn sample(&mut self, goals_rad: Option<&[f64]>) -> Result<Option<Sample>>;

    /// Torque on, every servo's goal where it stands.
    ///
    /// # Errors
    /// The device failed or refuses.
    fn arm(&mut self) -> Result<()>;

    /// Torque off, everywhere.
    ///
    /// # Errors
    /// The device failed.
    fn disarm(&mut self) -> Result<()>;

    /// Why the robot must be stopped, if it must.
    fn danger(&self) -> Option<String>;
}
