//! How the robot is reached.

use crate::deploy::balance::AttitudeSource;
use crate::deploy::{Board, ToldDrives};
use crate::error::Result;
use crate::link::SerialLink;
use crate::synth::controllers::BoardTiming;
use std::fmt;
use std::sync::Arc;

/// An open line to the robot, and the attitude of the simulated robot behind it, if there is one.
pub type OpenLine = (Box<dyn SerialLink>, Option<AttitudeSource>);

/// The robot that pages may watch, record and balance.
#[derive(Clone)]
pub struct RobotAccess {
    /// Its port, as a command line names it.
    pub port: String,
    /// Its servos.
    pub ids: Vec<u8>,
    /// Servos, safety limits and sensors that a plan is made for.
    pub board: Board,
    /// When readings are taken.
    pub timing: BoardTiming,
    /// What is told of the drives beside a model.
    pub told: ToldDrives,
    /// Opens the port; called for each run.
    pub open: Arc<dyn Fn() -> Result<OpenLine> + Send + Sync>,
}

impl fmt::Debug for RobotAccess {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut shown = f.debug_struct("RobotAccess");
        shown.field("port", &self.port).field("ids", &self.ids);
        shown.finish_non_exhaustive()
    }
}
