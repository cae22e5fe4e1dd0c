//! The one study engine: any controller, any non-ideality, one thing varied or all that is
//! uncertain at once.
//!
//! `parse` (a file) or `conditions` (a named set) -> `case` (one robot, one controller) -> `judge`
//! (robots drawn around it, in figures). On top of that: `sweep` (a [`quantity`] at every level),
//! `region` (of starts), `longest_delay`, `mass_errors` (in the linear loop), `verify` (a design,
//! with the effects that it leaves out), and `monte_carlo` (chunks of runs) -> `journal` (on disk)
//! -> `merge` -> `summary`.

mod case;
mod closed_loop;
mod conditions;
mod ellipsoid;
mod held;
mod journal;
mod judge;
mod lasting;
mod latency;
mod longest_delay;
mod manner;
mod mass_errors;
mod merge;
mod monte_carlo;
mod parse;
mod quantities;
mod quantity;
mod region;
mod region_map;
mod response;
mod shard;
mod summary;
mod sweep;
mod tune;
mod verified_loop;
mod verify;

#[cfg(test)]
mod tests;

use handstand_control::synth;
use handstand_fit::compare;
use handstand_model::{effects, error, model, motion, output};
use handstand_sim::sim;

pub use case::{Case, Control, Designed};
pub use closed_loop::compare_closed_loop;
pub use conditions::{CONDITIONS, LoopCondition, NonIdeality, condition};
pub use ellipsoid::Ellipsoid;
pub use journal::{Header, Journal};
pub use judge::{Figures, Judging, STABILISED_SHARE, judge, outcomes};
pub use lasting::Lasting;
pub use latency::{SERVO_DEAD_TIME_S, SIGNAL_PATHS, SignalPath};
pub use longest_delay::{Longest, longest_linear, longest_stabilised};
pub use manner::{Manner, can_stick};
pub use mass_errors::{MassErrors, radii, unstable_share};
pub use merge::{Merged, Missing, merge};
pub use monte_carlo::{CHUNK, chunk_rows, fill};
pub use parse::{Study, handstand};
pub use quantities::QUANTITIES;
pub use quantity::{
    Distribution, Levels, Quantity, Spread, SpreadOver, Uncertain, quantity, sweeps,
};
pub use region::bisect;
pub use region::{REGION_JUDGEMENTS, Region, region, tilt_border_rad};
pub use region_map::{MappedStart, region_map};
pub use response::{LoopResponse, response, step_response};
pub use shard::Shard;
pub use summary::{FigureQuantiles, Influence, Summary, share_interval};
pub use sweep::{Level, Sweep, sweep};
pub use tune::{TUNING_STEPS, Tuned, WeightTrial, tune};
pub use verified_loop::{NEAR_RAD, VerifiedLaw};
pub use verify::{
    LimitedFigure, UndesignedEffect, Verification, Without, left_out, verification_steps, verify,
};
