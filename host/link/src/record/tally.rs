//! Statistics of a recording.

use super::sample::RobotSample;
use serde::Serialize;

/// Counts of the samples so far.
#[derive(Debug, Clone, Default)]
pub struct RecordingTally {
    /// Samples.
    pub samples: u64,
    /// Answers that did not come.
    pub missing: u64,
    first_s: Option<f64>,
    last_s: f64,
}

impl RecordingTally {
    /// Count a sample.
    pub fn count(&mut self, sample: &RobotSample) {
        let missing = |joint: &&super::ServoSample| joint.position_rad.is_none();
        self.samples += 1;
        self.missing += sample.joints.iter().filter(missing).count() as u64;
        self.first_s.get_or_insert(sample.time_s);
        self.last_s = sample.time_s;
    }

    /// From the first sample to the last, s.
    pub fn seconds(&self) -> f64 {
        self.last_s - self.first_s.unwrap_or(self.last_s)
    }

    /// Samples per second; `None` before the second one.
    pub fn rate_hz(&self) -> Option<f64> {
        let seconds = self.seconds();
        (self.samples > 1 && seconds > 0.0).then(|| (self.samples - 1) as f64 / seconds)
    }
}

/// Root mean square of errors.
#[derive(Debug, Clone, Copy, Default)]
pub struct Rms {
    sum: f64,
    count: u64,
}

impl Rms {
    /// Add an error.
    pub fn add(&mut self, error: f64) {
        self.sum += error * error;
        self.count += 1;
    }

    /// The root mean square; `None` without any error.
    pub fn value(&self) -> Option<f64> {
        (self.count > 0).then(|| (self.sum / self.count as f64).sqrt())
    }
}

/// Quantiles of measured times, us.
#[derive(Debug, Clone, Copy, Serialize)]
pub struct Quantiles {
    /// Smallest.
    pub min: f64,
    /// Median.
    pub median: f64,
    /// 99 % are at most this.
    pub p99: f64,
    /// Largest.
    pub max: f64,
}

impl Quantiles {
    /// Of these times; `None` of none.
    pub fn of(mut times_us: Vec<f64>) -> Option<Quantiles> {
        times_us.sort_by(f64::total_cmp);
        let last = times_us.len() as f64 - 1.0;
        let at = |share: f64| times_us.get((last * share).ceil() as usize).copied();
        Some(Quantiles {
            min: at(0.0)?,
            median: at(0.5)?,
            p99: at(0.99)?,
            max: at(1.0)?,
        })
    }
}
