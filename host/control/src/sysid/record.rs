//! Input and output at equal steps of time: what a discrete-time model is fitted to.

use crate::error::{Error, Place, Result};
use crate::motion::Motion;
use std::ops::Range;

/// Largest departure of a time step from the sampling period, as a share of it.
const JITTER: f64 = 0.25;

/// One recording, from rest.
#[derive(Debug, Clone, PartialEq)]
pub struct Record {
    /// Name of the motion.
    pub name: String,
    /// Raw command, SI of its kind.
    pub input: Vec<f64>,
    /// Measured output, SI.
    pub output: Vec<f64>,
    /// Samples that count; filters run from the first sample all the same.
    pub scored: Range<usize>,
}

impl Record {
    /// All samples count.
    pub fn new(name: impl Into<String>, input: Vec<f64>, output: Vec<f64>) -> Self {
        Record {
            name: name.into(),
            scored: 0..output.len(),
            input,
            output,
        }
    }

    /// Samples that count.
    pub fn count(&self) -> usize {
        self.scored.len()
    }

    /// The record cut in two: the first `share` of it to learn from, the rest to judge by.
    pub fn split(&self, share: f64) -> (Record, Record) {
        let scored = &self.scored;
        let at = scored.start + (share * scored.len() as f64).round() as usize;
        let part = |scored: Range<usize>| Record {
            scored,
            ..self.clone()
        };
        (part(scored.start..at), part(at..scored.end))
    }
}

/// What of the motion is the output.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum OutputQuantity {
    /// The measured quantity as it is.
    AsMeasured,
    /// The speed estimated from a measured angle, `(theta(t) - theta(t - 1)) / Ts`, the paper's eq.
    /// (1).
    Velocity,
}

/// The sampling period of the motions: the median of all time steps, s.
pub fn sampling_period_s(motions: &[Motion]) -> f64 {
    let mut steps: Vec<f64> = motions
        .iter()
        .flat_map(|motion| motion.time_s.windows(2).map(|pair| pair[1] - pair[0]))
        .collect();
    steps.sort_by(f64::total_cmp);
    steps.get(steps.len() / 2).copied().unwrap_or(f64::NAN)
}

/// Joint `joint` of the motion (from 0) as a record. Taken as measured, input and output count from
/// their first samples; of a velocity estimate the first sample does not count.
///
/// # Errors
/// A joint that nothing drives; a time step more than a quarter off `ts_s`, where
/// a sample is missing.
pub fn record(motion: &Motion, joint: usize, output: OutputQuantity, ts_s: f64) -> Result<Record> {
    for (k, pair) in motion.time_s.windows(2).enumerate() {
        let step = pair[1] - pair[0];
        if (step - ts_s).abs() > JITTER * ts_s {
            return Err(Error::data(
                Place::file(&motion.source.path),
                format!(
                    "samples {k} and {} of {} are {step:.6} s apart where the sampling period is \
                     {ts_s:.6} s",
                    k + 1,
                    motion.name
                ),
                "a discrete-time model needs equal steps: name a range of rows without the gap, \
                 or set split_at_gap_s",
            ));
        }
    }
    let Some(input) = &motion.input[joint] else {
        return Err(Error::usage(
            format!("joint {} is passive: it has no input", joint + 1),
            "name a driven joint with --joint",
        ));
    };
    let measured = &motion.position_rad[joint];
    Ok(match output {
        OutputQuantity::AsMeasured => {
            Record::new(&motion.name, from_first(input), from_first(measured))
        }
        OutputQuantity::Velocity => Record {
            scored: 1..measured.len(),
            ..Record::new(&motion.name, input.clone(), velocity(measured, ts_s))
        },
    })
}

/// `(theta(t) - theta(t - 1)) / Ts`, the paper's eq. (1); 0 for the first sample, which has none
/// before it.
pub fn velocity(angle_rad: &[f64], ts_s: f64) -> Vec<f64> {
    let pairs = angle_rad.windows(2);
    let speeds = pairs.map(|pair| (pair[1] - pair[0]) / ts_s);
    std::iter::once(0.0)
        .chain(speeds)
        .take(angle_rad.len())
        .collect()
}

fn from_first(signal: &[f64]) -> Vec<f64> {
    let first = signal.first().copied().unwrap_or(0.0);
    signal.iter().map(|value| value - first).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_velocity_is_a_difference_over_a_period() {
        let speed = velocity(&[1.0, 1.5, 1.25], 0.5);
        assert_eq!(speed, [0.0, 1.0, -0.5]);
        assert!(velocity(&[], 0.5).is_empty());
    }

    #[test]
    fn a_split_counts_each_sample_once() {
        let record = Record {
            scored: 1..10,
            ..Record::new("r", vec![0.0; 10], vec![0.0; 10])
        };
        let (first, second) = record.split(2.0 / 3.0);
        assert_eq!((first.scored, second.scored), (1..7, 7..10));
    }
}
