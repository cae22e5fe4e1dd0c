//! Measured and simulated deviations, and their figures.

use crate::compare::{LoopMotion, LoopSignal};

/// Deviations of one motion at its samples from the first on: `[joint][sample]`, rad, up to the
/// fall; not a number where nothing was measured.
pub(super) struct DeviationSeries {
    pub angle_rad: Vec<Vec<f64>>,
    pub fell_s: Option<f64>,
}

/// A motion with the series behind its figures.
pub(super) struct MotionSeries {
    pub time_s: Vec<f64>,
    pub measured: DeviationSeries,
    pub simulated: DeviationSeries,
    pub motion: LoopMotion,
}

impl DeviationSeries {
    /// Peak to peak of a joint over the last second or the last half.
    fn limit_cycle_rad(&self, joint: usize, time_s: &[f64]) -> Option<f64> {
        let end_s = time_s.last()?;
        let late_s = (end_s - 1.0).max(end_s / 2.0);
        let late = self.angle_rad[joint]
            .iter()
            .zip(time_s)
            .filter(|(angle, time)| **time >= late_s && angle.is_finite());
        let ends = late.fold(None, |ends: Option<[f64; 2]>, (angle, _)| {
            let [low, high] = ends.unwrap_or([*angle; 2]);
            Some([low.min(*angle), high.max(*angle)])
        });
        ends.filter(|_| self.fell_s.is_none())
            .map(|[low, high]| high - low)
    }
}

/// One joint's figures over motions.
pub(super) fn pooled(all: &[MotionSeries], joint: usize) -> LoopSignal {
    let of = |series: fn(&MotionSeries) -> &DeviationSeries| {
        let angles = all.iter().flat_map(|both| &series(both).angle_rad[joint]);
        let cycles = all
            .iter()
            .filter_map(|both| series(both).limit_cycle_rad(joint, &both.time_s));
        (rms(angles.copied()), mean(cycles))
    };
    let errors = all.iter().flat_map(|both| {
        let pairs = both.measured.angle_rad[joint].iter();
        pairs
            .zip(&both.simulated.angle_rad[joint])
            .map(|(measured, simulated)| measured - simulated)
    });
    let (measured_rms_rad, measured_limit_cycle_rad) = of(|both| &both.measured);
    let (simulated_rms_rad, simulated_limit_cycle_rad) = of(|both| &both.simulated);
    LoopSignal {
        joint: joint + 1,
        rms_error_rad: rms(errors),
        measured_rms_rad,
        simulated_rms_rad,
        measured_limit_cycle_rad,
        simulated_limit_cycle_rad,
    }
}

/// Root-mean-square of what is a number; not a number without any.
fn rms(values: impl Iterator<Item = f64>) -> f64 {
    let squares = values.filter(|value| value.is_finite()).map(|v| v * v);
    mean(squares).unwrap_or(f64::NAN).sqrt()
}

fn mean(values: impl Iterator<Item = f64>) -> Option<f64> {
    let (sum, count) = values.fold((0.0, 0), |(sum, count), v| (sum + v, count + 1));
    (count > 0).then(|| sum / f64::from(count))
}
