//! A robot on simulated servos, in words: `robot=MODEL.toml,joints=1+2/11+12,start=hanging`.

use super::sim_words::ids;
use crate::bus_sim::Robot;
use crate::error::{Error, Result as Done};
use crate::model::Model;
use crate::sim::hanging;
use crate::synth::upright;
use std::path::PathBuf;
use std::str::FromStr;

/// Which robot, and how it hangs on the servos.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct SimRobot {
    /// Its model file.
    pub model: PathBuf,
    /// Servos of each driven joint, from the base outwards; without it those of the Bioloid's shoulders and hips, or
    /// servo 1 where only one joint is driven.
    pub joints: Option<Vec<Vec<u8>>>,
    /// Where it begins.
    pub start: Start,
}

/// A pose to begin in, at rest.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Start {
    /// All links straight down.
    #[default]
    Hanging,
    /// All links straight up.
    Upright,
}

impl FromStr for Start {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text {
            "hanging" => Ok(Start::Hanging),
            "upright" => Ok(Start::Upright),
            _ => Err(format!("start={text}: give hanging or upright")),
        }
    }
}

impl SimRobot {
    /// Reads `1+2/11+12`.
    ///
    /// # Errors
    /// What is no id, and how to write them.
    pub fn joints(text: &str) -> Result<Vec<Vec<u8>>, String> {
        text.split('/').map(ids).collect()
    }

    /// The robot, to hang on servos with these ids.
    ///
    /// # Errors
    /// Its model cannot be read or does not fit, or it needs servos that are not there.
    pub fn set_up(&self, there: &[u8]) -> Done<Robot> {
        let model = Model::load(&self.model)?;
        let driven = model.joints.iter().filter(|j| j.drive.is_driven()).count();
        let joints = match (&self.joints, driven) {
            (Some(joints), _) => joints.clone(),
            (None, 1) => vec![vec![1]],
            (None, 2) => vec![vec![1, 2], vec![11, 12]],
            (None, _) => Vec::new(),
        };
        let absent = joints.iter().flatten().find(|id| !there.contains(id));
        if let Some(id) = absent {
            return Err(Error::usage(
                format!("the robot hangs on servo {id}, which is not there"),
                "name the servos of each driven joint: joints=1+2/11+12",
            ));
        }
        let angle_rad = match self.start {
            Start::Hanging => hanging(&model),
            Start::Upright => upright(&model),
        };
        Robot::new(&model, &joints, &angle_rad)
    }
}
