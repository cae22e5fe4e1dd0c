//! Riccati equations, solved to the last digits that the gains can have.
//!
//! `doubling` finds the stabilising solution fast, to the digits that the plant's conditioning
//! leaves of double precision; `newton` then corrects it against a residual taken in twice the
//! digits (`twofold`), each correction being a Stein equation (`stein`). Of 60 states that is the
//! difference between two digits of K and ten.

mod dense;
mod doubling;
mod newton;
mod problem;
mod square;
mod stein;
mod twofold;

use doubling::symmetrise;
pub(super) use problem::{Problem, TimeDomain};
pub(super) use stein::stein;
