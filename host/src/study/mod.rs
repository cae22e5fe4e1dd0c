//! What the closed loop bears: one thing varied at a time, or all that is uncertain at once.
//!
//! `study` (what is studied) -> `case` (one robot under one set of circumstances) -> `judge` (a case in figures) ->
//! `sweep` (a case at every level); `study` -> `monte_carlo` (chunks of runs) -> `journal` (on disk) -> `merge` ->
//! `summary`.

mod case;
mod fixed_controller;
mod journal;
mod judge;
mod merge;
mod monte_carlo;
mod parse;
mod plot;
mod shard;
mod summary;
mod sweep;
mod sweeps;
mod uncertain;

#[cfg(test)]
mod tests;

pub use case::{Case, Design};
pub use journal::{FORMAT, Header, Journal};
pub use judge::{Figures, Judging, judge, tilt_border_rad};
pub use merge::{Merged, Missing, merge};
pub use monte_carlo::{CHUNK, chunk_rows, chunks, columns};
pub use parse::Study;
pub use plot::{monte_carlo_svg, sweep_svg};
pub use shard::Shard;
pub use summary::{Summary, share_interval};
pub use sweep::{Level, Ran, SWEEPS, Sweep, SweepCard, named, sweep};
pub use uncertain::{Distribution, Place, QUANTITIES, Quantity, Uncertain};
