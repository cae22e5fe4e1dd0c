//! Which physical effect is missing from a model, on which evidence; which law the library lacks;
//! and a first model of a log where there is none.

pub mod diagnose;
pub mod discover;
pub mod first_model;

#[cfg(test)]
use handstand_challenge as challenge;
use handstand_fit::fitting;
use handstand_logs as log;
use handstand_model::{effects, error, model, motion, output};
