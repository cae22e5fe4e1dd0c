//! The signals that are compared: one a joint, and the rates of sensors beside those of angles.

use super::super::horizon::Window;
use super::super::noise::{Noise, noise};
use super::FitProblem;
use crate::model::{ColumnMean, MeasuredSignal, Model};
use crate::motion::Motion;
use std::ops::Range;

/// Stands for the noise of a joint of which nothing is measured.
const NO_NOISE: Noise = Noise {
    deviation: 1e-3,
    error: 0.0,
};

/// What the signals are, and how exactly these motions hold them.
pub(super) fn of(
    model: &Model,
    motions: &[Motion],
    rate_joints: &[usize],
) -> (Vec<MeasuredSignal>, Vec<Noise>) {
    let known = |series: Vec<&[f64]>, columns: Option<&ColumnMean>| {
        noise(motions, &series, columns.and_then(ColumnMean::resolution))
    };
    let of_joints = model.log.joints.iter().take(model.link_count()).enumerate();
    let of_joints = of_joints.map(|(joint, columns)| {
        let signal = columns.signal();
        let series = motions.iter().map(|motion| motion.measured(joint, signal));
        let noise = match signal {
            MeasuredSignal::Nothing => NO_NOISE,
            _ => known(series.collect(), columns.measured()),
        };
        (signal, noise)
    });
    let of_rates = rate_joints.iter().map(|&joint| {
        let series = motions
            .iter()
            .map(|motion| motion.rate(joint).unwrap_or_default());
        let columns = model.log.joints[joint].rate.as_ref();
        (MeasuredSignal::Rate, known(series.collect(), columns))
    });
    of_joints.chain(of_rates).unzip()
}

impl FitProblem {
    /// Number of joints.
    pub fn joints(&self) -> usize {
        self.signals.len() - self.rate_joints.len()
    }

    /// The joint that a signal is of.
    pub fn joint_of(&self, signal: usize) -> usize {
        match signal.checked_sub(self.joints()) {
            None => signal,
            Some(rate) => self.rate_joints[rate],
        }
    }

    /// What is measured of a signal in a motion, rad, of a rate rad/s; not a number in gaps.
    pub fn measured(&self, motion: usize, signal: usize) -> &[f64] {
        let (motion, joint) = (&self.motions[motion], self.joint_of(signal));
        if signal < self.joints() {
            motion.measured(joint, self.signals[signal])
        } else {
            motion.rate(joint).unwrap_or_default()
        }
    }

    /// The same signals and weights of other motions.
    pub fn measured_in(mut self, motions: Vec<Motion>) -> FitProblem {
        let motions = motions.into_iter();
        self.motions = motions.map(|m| m.with_rates(&self.rate_joints)).collect();
        self
    }

    /// How many samples of signals in all windows were not measured.
    pub fn gaps(&self) -> usize {
        let of_window = |window: &Window| {
            let gaps = |signal: usize| {
                let values = &self.measured(window.motion, signal)[window.samples.clone()];
                values.iter().filter(|value| value.is_nan()).count()
            };
            (0..self.signals.len()).map(gaps).sum::<usize>()
        };
        self.windows.iter().map(of_window).sum()
    }

    /// The same windows with other readings in place of the measured ones, rad or rad/s: per
    /// motion and window, signal after signal. What was not measured stays so.
    pub fn measuring(mut self, readings: &[Vec<Vec<f64>>]) -> FitProblem {
        for (motion, readings) in readings.iter().enumerate() {
            let windows: Vec<Range<usize>> = self
                .windows_of(motion)
                .map(|(_, window)| window.samples.clone())
                .collect();
            let (motion, rates) = (&mut self.motions[motion], &self.rate_joints);
            for (samples, readings) in windows.into_iter().zip(readings) {
                for (signal, readings) in readings.chunks(samples.len()).enumerate() {
                    let place = match signal.checked_sub(motion.position_rad.len()) {
                        None if self.signals[signal] == MeasuredSignal::Rate => {
                            motion.velocity_rad_s[signal].as_mut()
                        }
                        None => Some(&mut motion.position_rad[signal]),
                        Some(rate) => motion.rate_rad_s[rates[rate]].as_mut(),
                    };
                    let place = place.into_iter().flat_map(|p| &mut p[samples.clone()]);
                    let measured = place.zip(readings);
                    for (value, reading) in measured.filter(|(value, _)| !value.is_nan()) {
                        *value = *reading;
                    }
                }
            }
        }
        self
    }
}
