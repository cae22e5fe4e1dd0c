//! Which physical effect is missing: where the model fails, which candidates mend it, what may be claimed.

mod candidate;
mod findings;

pub use candidate::{Candidate, candidates};
pub use findings::{
    Alternative, Diagnosis, ErrorFall, FittedEffect, FittedValue, MotionError, Remainder, RuledOut,
    Verdict,
};
