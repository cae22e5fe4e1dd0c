//! A disturbance observer in place of the angle compensation.

use super::observed::{Observed, Options};
use super::{ControllerInfo, Design, DesignModel, Speeds};
use crate::error::Result;
use crate::sim::closed_loop::Controller;

/// The paper's regulator about the angles of balance as they are observed; angles and true speeds
/// are read.
#[derive(Debug)]
pub struct OffsetObserver;

static INFO: ControllerInfo = ControllerInfo {
    id: "offset-observer",
    title: "DLQR with observed offsets",
    law: "u = -K (x - x_balance), balance estimated",
    speeds: Speeds::True,
    known_equilibrium: false,
    reference: "Franklin, Powell, Workman, Digital Control of Dynamic Systems, 3rd ed., section 8.5",
};

impl Design for OffsetObserver {
    fn info(&self) -> &ControllerInfo {
        &INFO
    }

    fn build(&self, known: &DesignModel) -> Result<Box<dyn Controller>> {
        let options = Options {
            true_speeds: true,
            offsets: true,
            ..Options::paper()
        };
        Ok(Box::new(Observed::new(known, &options)?))
    }
}
