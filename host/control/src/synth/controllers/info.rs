//! Description of a controller, and the trait of its design.

use super::DesignModel;
use crate::error::Result;
use crate::sim::closed_loop::Controller;
use std::fmt;

/// Where a controller has the speeds of the driven joints from. The arms' speed comes from the
/// gyro.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Speeds {
    /// It is given the true ones, as in the paper's simulations. No servo measures them.
    True,
    /// Differences of the angles as read, the paper's equation 1.
    Differenced,
    /// It estimates them.
    Estimated,
}

/// Description of a controller.
#[derive(Debug, Clone, Copy)]
pub struct ControllerInfo {
    /// Name on the command line.
    pub id: &'static str,
    /// Name for people.
    pub title: &'static str,
    /// u as a formula.
    pub law: &'static str,
    /// Speeds of the driven joints.
    pub speeds: Speeds,
    /// Whether it knows the angles at which the robot balances: the paper's angle compensation,
    /// known exactly.
    pub known_equilibrium: bool,
    /// Where the law comes from.
    pub reference: &'static str,
}

/// A way to make a controller from what is known.
pub trait ControllerDesign: Sync + fmt::Debug {
    /// What it is.
    fn info(&self) -> &ControllerInfo;

    /// The controller for a robot of which this much is known.
    ///
    /// # Errors
    /// Plants that cannot be held.
    fn build(&self, known: &DesignModel) -> Result<Box<dyn Controller>>;
}
