//! What every command that fits is told: what to judge by, over how long, and where the new model goes.

use super::input;
use handstand::Result;
use handstand::fitting::Horizon;
use handstand::log::LogRequest;
use std::path::PathBuf;

/// Options of `fit` and `add`.
#[derive(Debug, clap::Args)]
pub struct Fitting {
    /// Logs to judge by, which are not fitted
    #[arg(long, num_args = 1.., value_name = "LOG", value_parser = input::log)]
    pub holdout: Vec<LogRequest>,
    /// Seconds the model runs without correction, or `whole`; chosen by its stability without it
    #[arg(long, value_name = "SECONDS", value_parser = input::horizon, allow_negative_numbers = true)]
    pub horizon: Option<Horizon>,
    /// New model file
    #[arg(long, short, value_name = "NEW.toml")]
    pub output: PathBuf,
    /// Replace the file if it exists
    #[arg(long)]
    pub force: bool,
}

impl Fitting {
    /// Whether the new model may be written, asked before any work is done.
    ///
    /// # Errors
    /// The file exists and was not to be replaced.
    pub fn vacant(&self) -> Result<()> {
        input::vacant(&self.output, self.force)
    }
}
