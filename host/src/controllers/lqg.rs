//! LQG: the paper's regulator on a Kalman filter's state, the delay in the model.

use super::observed::{Observed, Options};
use super::{ControllerInfo, Design, DesignModel, Speeds};
use crate::error::Result;
use crate::sim::closed_loop::Controller;

/// From angles and gyro alone; rounding counts as noise.
#[derive(Debug)]
pub struct Lqg;

static INFO: ControllerInfo = ControllerInfo {
    id: "lqg",
    title: "LQG with delay states",
    law: "u = -K [x, past u], estimated",
    speeds: Speeds::Estimated,
    known_equilibrium: true,
    reference: "Astrom, Wittenmark, Computer-Controlled Systems, 3rd ed., chapter 11",
};

impl Design for Lqg {
    fn info(&self) -> &ControllerInfo {
        &INFO
    }

    fn build(&self, known: &DesignModel) -> Result<Box<dyn Controller>> {
        let options = Options {
            delay: true,
            ..Options::paper()
        };
        Ok(Box::new(Observed::new(known, &options)?))
    }
}
