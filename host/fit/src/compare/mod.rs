//! A model against measured motions: how far apart they are, and under which conditions.

mod closed_loop;
mod conditions;
mod failure;
mod model_run;
mod order;
mod predicted;
mod residual_tests;
mod residual_variables;
mod result;
mod run;
mod sample_features;
mod text;

#[cfg(test)]
mod tests;

pub use closed_loop::{
    ClosedLoopComparison, LEGEND as CLOSED_LOOP_LEGEND, LoopMotion, LoopSignal, closed_loop_rows,
    closed_loop_text,
};
pub use failure::FailingSamples;
pub use model_run::ModelRun;
pub use residual_tests::{independence, whiteness};
pub use residual_variables::{ResidualVariable, residual_variables};
pub use result::{Comparison, Failure, HorizonError, ResidualTest, SignalError, Trace};
pub use run::fit_percent;
pub use run::{compare, compare_all};
pub use sample_features::speed_rad_s;
pub use text::{LEGEND as COMPARISON_LEGEND, comparison_rows, text, waterfall};
