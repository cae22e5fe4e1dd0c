//! `handstand study`: robustness of the closed loop, by simulation.
//!
//! `sweep` varies one quantity, `monte-carlo` draws everything that is uncertain, in shards if need
//! be, which `merge` puts together. A study file gives robot, controller and conditions
//! (`docs/study.md`); without one it is the paper's robot with the controller `dlqr-delay`.
//!
//! ```console
//! $ handstand study sweep delay dead-zone -o delay
//! $ handstand study monte-carlo study.toml -o result
//! $ handstand study monte-carlo study.toml -o shards --shard 2/8
//! $ handstand study merge shards -o result
//! ```

mod merge;
mod monte_carlo;
mod sweep;
mod write;

use super::{Console, ExitStatus};
use clap::Subcommand;
use handstand::Result;

/// What can be done with studies.
#[derive(Debug, Subcommand)]
pub enum StudyCommand {
    /// Sweep one parameter of the closed loop
    Sweep(sweep::SweepArgs),
    /// Simulate robots drawn from the uncertain quantities
    MonteCarlo(monte_carlo::MonteCarloArgs),
    /// Merge a study's shards
    Merge(merge::MergeArgs),
}

/// Does it.
pub fn run(command: &StudyCommand, console: &Console) -> Result<ExitStatus> {
    match command {
        StudyCommand::Sweep(args) => sweep::run(args, console),
        StudyCommand::MonteCarlo(args) => monte_carlo::run(args, console),
        StudyCommand::Merge(args) => merge::run(args, console),
    }
}
