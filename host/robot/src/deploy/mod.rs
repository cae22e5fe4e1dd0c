//! Deploy a designed law to the CM-5: make its plan, upload it, read it back, verify it.
//!
//! [`plan`] makes the board's plan from a design: gains on the measured state ([`state_design`]),
//! or the observer-based law. [`upload`] and [`verify`] transfer it, [`replay`] compares the
//! firmware's law with wide integers.

pub mod balance;
mod basis;
mod board;
mod limits;
mod observer;
mod observer_loop;
#[cfg(feature = "virtual-cm5")]
pub mod rehearsal;
mod replay;
mod rust_file;
mod state;
mod state_loop;
mod transfer;

pub use basis::{EffectUse, PlanBasis, ToldDrives, UsePlace};
pub use board::{Board, ServoPair};
pub use limits::{ModeLimit, mode_limits};
pub use observer::{reading_steps, state_steps};
pub use observer_loop::{ObserverLoop, observer_loop};
pub use replay::replay;
pub use rust_file::{plan_file, plan_of_file};
pub use state::state_design;
pub use state_loop::state_radius;
pub use transfer::{read_back, upload, verify};

use crate::error::Result;
use crate::model::Model;
use crate::synth::controllers::{BoardTiming, DesignModel, OnBoard};
use crate::synth::{Design, upright};
use handstand_shared::observer::INPUTS;
use handstand_shared::plan::{Law, Plan};

/// The design that a plan is made from.
#[derive(Debug, Clone, Copy)]
pub enum BoardLaw<'a> {
    /// State feedback on angles and their differences, as [`state_design`] designs it.
    State(&'a Design),
    /// The observer-based law.
    Observer(&'a OnBoard),
}

/// The observer-based law for a model on this board, in floating point.
///
/// # Errors
/// Absolute angles; as [`OnBoard::new`].
pub fn observer_design(model: &Model, board: &Board, timing: &BoardTiming) -> Result<OnBoard> {
    OnBoard::new(&observer_known(model, board)?, timing)
}

/// What the observer-based law is designed from.
fn observer_known(model: &Model, board: &Board) -> Result<DesignModel> {
    state::relative(model)?;
    Ok(DesignModel {
        limit_nm: board.most_nm.into_iter().fold(f64::INFINITY, f64::min),
        ..DesignModel::new(model, &upright(model), board.period_s)?
    })
}

/// The plan that makes the CM-5 execute a design.
///
/// # Errors
/// A design that the firmware has no law for, values that do not fit its words, joints that slide,
/// or a robot in space.
pub fn plan(model: &Model, law: BoardLaw, board: &Board) -> Result<Plan> {
    model.hinges_only("the board's plans are for servos that turn")?;
    model.planar_only("the CM-5 balances planar chains")?;
    match law {
        BoardLaw::State(design) => state::plan(model, design, board),
        BoardLaw::Observer(machine) => {
            let law = Law::Observer(observer::quantised(machine, board.most_nm)?);
            let moments = board::moments(model);
            board.plan(law, moments, [observer::INPUT_STEP_NM; INPUTS])
        }
    }
}
