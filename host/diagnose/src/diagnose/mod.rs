//! Which physical effect is missing: which candidates mend the model, what may be claimed, and in
//! which words.

mod block_errors;
mod budget;
mod candidates;
mod conclusion;
mod consistency;
pub mod conventions;
mod equivalence;
mod error_budget;
mod evaluator;
mod explanation;
mod findings;
mod first_look;
mod horizon;
mod hypothesis;
mod inseparable;
mod judging;
mod log_outcome;
mod logs;
mod longer_runs;
mod measured_value;
mod multistart;
pub mod names;
mod one_sided;
mod options;
mod pipeline;
mod progress;
mod relative_scale;
mod replacement;
mod residual_structure;
mod restarts;
mod search;
mod selection;
mod stability;
mod strategy;
mod terms;
mod turns;
mod values;
mod verdict;
mod warnings;
mod whole_error;
pub mod words;

pub use candidates::candidates;
pub use findings::{
    Alternative, BudgetShare, BudgetedPart, Diagnosis, FREE_VALUES, FittedEffect, Fold,
    MotionError, ResidualStructure, RuledOut, SearchEnded, Verdict, WrongValue,
};
pub use inseparable::how_to_measure;
pub use log_outcome::{LogOutcome, OutcomeFile, OutcomeKey, OutcomeValue, outcomes_in};
pub(crate) use logs::with_names;
pub use logs::{LogDiagnosis, diagnose_logs, quoted, quoted_logs};
pub use measured_value::values_behind;
pub use options::DiagnoseOptions;
pub use pipeline::diagnose;
pub use selection::independent_share;
pub use strategy::Strategy;
pub(crate) use terms::JointRange;
pub use whole_error::whole_error_rad;
