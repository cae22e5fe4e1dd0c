//! The closed loop of a model and a known controller beside the measured one: its figures, in
//! words. `compare_closed_loop` of the studies finds them.
//!
//! The phases of two such loops drift apart, even with the right model. RMS deviation, limit cycle
//! and falls therefore say more than the error sample by sample.

mod result;
mod text;

pub use result::{ClosedLoopComparison, LoopMotion, LoopSignal};
pub use text::{LEGEND, closed_loop_rows, closed_loop_text};
