//! The questions of `tests/peers`, answered by the library and timed in this process.

mod arm;
mod closed_loop;
mod dynamics;
mod gains;
mod trees;

pub use arm::{Arm, Starts};
pub use closed_loop::{Robot, angles_after, runs_per_second};
pub use dynamics::{farthest_off, forward_seconds};
pub use gains::{chain_fixture, dlqr_off, dlqr_seconds};
pub use trees::{Limbs, ROBOTS};

use std::time::Instant;

/// Median seconds of `repeats` runs.
pub fn median_seconds(repeats: usize, mut run: impl FnMut()) -> f64 {
    let mut times: Vec<f64> = (0..repeats.max(1))
        .map(|_| {
            let begun = Instant::now();
            run();
            begun.elapsed().as_secs_f64()
        })
        .collect();
    times.sort_by(f64::total_cmp);
    times[times.len() / 2]
}
