//! Which physical effect is missing: which candidates mend the model, what may be claimed, and in which words.

mod candidate;
mod findings;
mod remainder;
mod score;
mod search;
mod trial;
mod verdict;
pub mod words;

pub use candidate::{Candidate, candidates};
pub use findings::{
    Alternative, Diagnosis, ErrorFall, FittedEffect, FittedValue, MotionError, Remainder, RuledOut,
    Verdict,
};
pub use search::{DiagnoseOptions, Progress, diagnose};
