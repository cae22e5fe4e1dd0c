//! Which experiment tells explanations apart that the logs leave open, or tightens a value.
//!
//! Optimal experiment design by simulation: motions of [`excite`] within limits,
//! under conditions that a person can change (a known mass, the rig turned, another supply), are
//! predicted by every explanation that is left, each fitted to the logs. Explanations are told
//! apart by the experiment in which the closest two of them differ most, in standard errors, after
//! either has been refitted to what the other predicts (Hunter & Reiner 1965; Atkinson & Fedorov
//! 1975). Values are tightened by the experiment that adds most to the Fisher information (D- or
//! A-optimality; Atkinson, Donev & Tobias 2007).

mod candidates;
mod clearance;
mod condition;
pub mod excite;
mod first_motions;
mod follow_up;
mod inputs;
mod limits;
mod motion_file;
mod prediction;
mod proposal;
mod propose;
mod rival;
mod separation;
mod tighten;

#[cfg(test)]
mod tests;

use handstand_diagnose::diagnose;
use handstand_fit::fitting;
use handstand_logs as log;
use handstand_model::{dynamics, error, model, motion, output};
use handstand_sim::sim;

pub use candidates::can_be_moved;
pub use clearance::Clearance;
pub use condition::Condition;
pub use first_motions::{FirstMotions, first_motions};
pub use follow_up::FollowUp;
pub use limits::ExperimentLimits;
pub use motion_file::{inputs_alone, is_replayable};
pub use proposal::{
    ExperimentProposal, MeasuredValue, ProposedExperiment, RivalName, Separation, TightenedValue,
};
pub use propose::{ProposeOptions, propose, propose_values};
pub use tighten::Criterion;
