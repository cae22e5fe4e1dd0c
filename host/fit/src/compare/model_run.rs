//! A model run along measured motions: every sample it predicts, and what it leaves.

use super::predicted::{predicted, residual};
use crate::fitting::{
    FitProblem, Horizon, WindowStart, fit_start_states, fit_start_states_roughly,
};
use crate::model::Model;

/// A model run along motions, its start states fitted; a comparison is made of it.
#[derive(Debug, Clone)]
pub struct ModelRun {
    /// The model.
    pub model: Model,
    /// The motions, cut into windows.
    pub data: FitProblem,
    /// Longest windows asked for.
    pub horizon: Horizon,
    /// Where each window starts.
    pub window_starts: Vec<WindowStart>,
    /// Predicted angles, rad, or rates where no angle is measured, rad/s, then rates of sensors
    /// beside an angle's: `[motion][signal][sample]`.
    pub predicted: Vec<Vec<Vec<f64>>>,
}

impl ModelRun {
    /// Fits the start states and predicts; `data` is cut at `horizon`.
    pub fn new(model: Model, data: FitProblem, horizon: Horizon) -> ModelRun {
        let window_starts = fit_start_states(&model, &data).window_starts;
        ModelRun::from_window_starts(model, data, horizon, window_starts)
    }

    /// The same with start states that are fitted roughly, for who cannot wait.
    pub fn roughly(model: Model, data: FitProblem, horizon: Horizon) -> ModelRun {
        let window_starts = fit_start_states_roughly(&model, &data).window_starts;
        ModelRun::from_window_starts(model, data, horizon, window_starts)
    }

    /// Predicts from these start states, one for each window of `data`.
    pub fn from_window_starts(
        model: Model,
        data: FitProblem,
        horizon: Horizon,
        window_starts: Vec<WindowStart>,
    ) -> ModelRun {
        ModelRun {
            predicted: predicted(&model, &data, &window_starts),
            model,
            data,
            horizon,
            window_starts,
        }
    }

    /// Measured minus predicted, rad or rad/s, `[signal][motion][sample]`, the joints first; not a
    /// number where nothing was measured.
    pub fn residuals(&self) -> Vec<Vec<Vec<f64>>> {
        let signals = 0..self.data.signals.len();
        let residual = |signal| residual(&self.data, &self.predicted, signal);
        signals.map(residual).collect()
    }
}
