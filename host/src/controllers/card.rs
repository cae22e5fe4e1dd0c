//! What a controller tells about itself.

use super::Known;
use crate::closed_loop::Controller;
use crate::error::Result;
use std::fmt;

/// Where a controller has the speeds of the driven joints from. The arms' speed comes from the gyro.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Speeds {
    /// It is given the true ones, as in the paper's simulations. No servo tells them.
    True,
    /// Differences of the angles as read, the paper's equation 1.
    Differenced,
    /// It does without.
    Estimated,
}

/// A controller's page.
#[derive(Debug, Clone, Copy)]
pub struct Card {
    /// Name on the command line.
    pub id: &'static str,
    /// Name for people.
    pub title: &'static str,
    /// u as a formula.
    pub law: &'static str,
    /// Speeds of the driven joints.
    pub speeds: Speeds,
    /// Whether it is told at which angles the robot balances: the paper's angle compensation, known exactly.
    pub told_balance: bool,
    /// Where the law comes from.
    pub reference: &'static str,
}

/// A way to make a controller from what is known.
pub trait Design: Sync + fmt::Debug {
    /// What it is.
    fn card(&self) -> &Card;

    /// The controller for a robot of which this much is known.
    ///
    /// # Errors
    /// Plants that cannot be held.
    fn build(&self, known: &Known) -> Result<Box<dyn Controller>>;
}
