//! A model against measured motions: how far apart they are, and under which conditions.

mod result;

pub use result::{Comparison, Failure, HorizonError, ResidualTest, SignalError, Trace};
