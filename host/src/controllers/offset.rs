//! A disturbance observer in place of the angle compensation.

use super::observed::{Observed, Options};
use super::{Card, Design, Known, Speeds};
use crate::closed_loop::Controller;
use crate::error::Result;

/// The paper's regulator about the angles of balance as they are observed; angles and true speeds are read.
#[derive(Debug)]
pub struct OffsetObserver;

static CARD: Card = Card {
    id: "offset-observer",
    title: "DLQR with observed offsets",
    law: "u = -K (x - x_balance), balance estimated",
    speeds: Speeds::True,
    told_balance: false,
    reference: "Franklin, Powell, Workman, Digital Control of Dynamic Systems, 3rd ed., section 8.5",
};

impl Design for OffsetObserver {
    fn card(&self) -> &Card {
        &CARD
    }

    fn build(&self, known: &Known) -> Result<Box<dyn Controller>> {
        let options = Options {
            true_speeds: true,
            offsets: true,
            ..Options::paper()
        };
        Ok(Box::new(Observed::new(known, &options)?))
    }
}
