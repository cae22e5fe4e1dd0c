//! The benchmark of spoiled logs: is a wrong sign, zero, unit, drive or time told from physics, and
//! is the right remedy given?

mod edits;
mod outcome;
mod rig;
mod spoiling;

pub(crate) use outcome::said;
pub use outcome::{Answer, Outcome, judge, unspoiled};
pub use rig::{Rig, bundled, public, simulated};
pub use spoiling::{Spoiled, Spoiling, spoilings};
