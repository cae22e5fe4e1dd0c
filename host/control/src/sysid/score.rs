//! How well a fitted model predicts records: one step ahead, and from the input alone.

use super::model::TransferModel;
use super::record::Record;
use crate::compare::{ResidualTest, fit_percent, independence, whiteness};
use serde::Serialize;

/// A model on a set of records.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct FitScore {
    /// Samples that counted.
    pub samples: usize,
    /// 100 (1 - |y - yhat| / |y - mean y|) with yhat from the input alone, as MATLAB's `compare`;
    /// 100 is perfect.
    pub simulated_fit_percent: f64,
    /// The same with yhat predicted one step ahead.
    pub predicted_fit_percent: f64,
    /// Root-mean-square of the one-step errors, in the output's unit.
    pub error_rms: f64,
    /// Whether the one-step errors are white and free of the input, at 99 %.
    pub tests: Vec<ResidualTest>,
}

/// One-step errors of the scored samples, one row per record.
pub fn prediction_errors(model: &TransferModel, records: &[Record]) -> Vec<Vec<f64>> {
    let of = |r: &Record| model.errors(r)[r.scored.clone()].to_vec();
    records.iter().map(of).collect()
}

/// Scores `model` on the records.
pub fn score(model: &TransferModel, records: &[Record]) -> FitScore {
    let errors = prediction_errors(model, records);
    let output: Vec<&[f64]> = records
        .iter()
        .map(|r| &r.output[r.scored.clone()])
        .collect();
    let input: Vec<Vec<f64>> = records
        .iter()
        .map(|r| r.input[r.scored.clone()].to_vec())
        .collect();
    let left: Vec<Vec<f64>> = records
        .iter()
        .map(|r| {
            let simulated = model.simulated(&r.input);
            let scored = r.scored.clone();
            scored.map(|t| r.output[t] - simulated[t]).collect()
        })
        .collect();
    let samples: usize = records.iter().map(Record::count).sum();
    let squares: f64 = errors.iter().flatten().map(|e| e * e).sum();
    let mut tests = vec![whiteness(&errors)];
    tests.extend(independence(&errors, &input, "input"));
    FitScore {
        samples,
        simulated_fit_percent: fit_percent(&output, &left),
        predicted_fit_percent: fit_percent(&output, &errors),
        error_rms: (squares / samples.max(1) as f64).sqrt(),
        tests,
    }
}
