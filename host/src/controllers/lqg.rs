//! LQG: the paper's regulator on a Kalman filter's state, the delay in the model.

use super::observed::{Observed, Options};
use super::{Card, Design, Known, Speeds};
use crate::closed_loop::Controller;
use crate::error::Result;

/// From angles and gyro alone; rounding counts as noise.
#[derive(Debug)]
pub struct Lqg;

static CARD: Card = Card {
    id: "lqg",
    title: "LQG with delay states",
    law: "u = -K [x, past u], estimated",
    speeds: Speeds::Estimated,
    told_balance: true,
    reference: "Astrom, Wittenmark, Computer-Controlled Systems, 3rd ed., chapter 11",
};

impl Design for Lqg {
    fn card(&self) -> &Card {
        &CARD
    }

    fn build(&self, known: &Known) -> Result<Box<dyn Controller>> {
        let options = Options {
            delay: true,
            ..Options::paper()
        };
        Ok(Box::new(Observed::new(known, &options)?))
    }
}
