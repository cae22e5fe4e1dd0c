//! Where samples come from, and where goals go.

use super::reach::GoalRange;
use super::sample::RobotSample;
use crate::LineWriter;
use crate::error::Result;
use std::time::Duration;

/// Switches torque off, whatever else is going on.
pub type EmergencyOff = Box<dyn FnOnce() + Send>;

/// Says these bytes twice, some time apart: what else was being said may have garbled the first, or
/// have been a goal, which switches torque on. `idle` goes before the second: a line that stalled
/// passes all of it on in one burst, and the last word must not meet an answer.
pub(super) fn send_twice(mut voice: LineWriter, idle: Vec<u8>, bytes: Vec<u8>) -> EmergencyOff {
    const APART: Duration = Duration::from_millis(50);
    Box::new(move || {
        for before in [Vec::new(), idle] {
            // It cannot be told any more that this failed.
            let _ = voice.write_all(&[before, bytes.clone()].concat());
            std::thread::sleep(APART);
        }
    })
}

/// Servos that can be sampled, and moved.
pub trait SampleSource {
    /// Sends goals, in the order of ids, if there are any; waits for the next sample. None: it did
    /// not come in time.
    ///
    /// # Errors
    /// The device failed.
    fn sample(&mut self, goals_rad: Option<&[f64]>) -> Result<Option<RobotSample>>;

    /// When the newest sample arrived, s, on the clock of its `time_s`: other than that where a
    /// controller keeps the time.
    fn arrival_s(&self, newest: &RobotSample) -> f64 {
        newest.time_s
    }

    /// Whether the servos can get to the goals of a motion, which lie within these ranges, in the
    /// order of ids; asked before torque.
    ///
    /// # Errors
    /// A servo that takes no goals or whose limits leave one out; it does not answer.
    fn may_reach(&mut self, goals: &[GoalRange]) -> Result<()>;

    /// What is to be said of the samples so far, a line each.
    fn remarks(&self) -> Vec<String> {
        Vec::new()
    }

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

    /// What switches torque off from another thread, should the program have to end at once; none
    /// where nothing outlives it.
    fn emergency_off(&mut self) -> Option<EmergencyOff>;

    /// Why the robot must be stopped, if it must.
    fn danger(&self) -> Option<String>;
}
