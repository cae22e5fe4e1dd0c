//! What a diagnosis may be told.

use super::strategy::Strategy;
use crate::fitting::{Horizon, StopSwitch};
use crate::model::ParameterPath;

/// How to diagnose.
#[derive(Debug, Clone)]
pub struct DiagnoseOptions {
    /// Seed of the bootstrap.
    pub seed: u64,
    /// Effects left out of the library.
    pub without: Vec<String>,
    /// Values of the model file that were measured by themselves: they are right, and not fitted.
    pub known: Vec<ParameterPath>,
    /// Window length; chosen from the data when absent.
    pub horizon: Option<Horizon>,
    /// Most effects named together.
    pub most_effects: usize,
    /// Whether to diagnose even where another sign, zero, unit or drive in the model file clearly
    /// lowers the error.
    pub trust_log: bool,
    /// Error that is good enough for the user, rad: an explanation that leaves no more ends the
    /// search.
    pub tolerance_rad: Option<f64>,
    /// Seconds that the diagnosis may take, judging included; it claims no more than it examined.
    pub within_s: Option<f64>,
    /// Parts of the search that are left out, to measure what they bring.
    pub skipped: Vec<Strategy>,
    /// Ends the diagnosis from another thread.
    pub stop: StopSwitch,
}

impl Default for DiagnoseOptions {
    fn default() -> Self {
        DiagnoseOptions {
            seed: 0,
            without: Vec::new(),
            known: Vec::new(),
            horizon: None,
            most_effects: 3,
            trust_log: false,
            tolerance_rad: None,
            within_s: None,
            skipped: Vec::new(),
            stop: StopSwitch::default(),
        }
    }
}
