//! Which physical effect is missing: which candidates mend the model, what may be claimed, and in which words.

mod bench;
mod candidate;
mod conclusion;
mod consistency;
mod evidence;
mod findings;
mod horizon;
mod opening;
mod options;
mod progress;
mod remainder;
mod restart;
mod score;
mod search;
mod terms;
mod trial;
mod verdict;
pub mod words;

pub use candidate::{Candidate, candidates};
pub use findings::{
    Alternative, Diagnosis, ErrorFall, FittedEffect, FittedValue, MotionError, Remainder, RuledOut,
    Verdict,
};
pub use options::DiagnoseOptions;
pub use progress::Progress;
pub use search::diagnose;
