//! Short stretches of a motion, long enough to differentiate a coarse encoder twice.

use crate::motion::Motion;

/// Half a stretch's least duration, s.
const HALF_S: f64 = 0.02;

/// Samples of a stretch: its first, one in its middle, its last.
#[derive(Debug, Clone, Copy)]
pub(super) struct Stretch {
    begin: usize,
    middle: usize,
    end: usize,
}

/// Gathers samples into stretches that share their end samples.
#[derive(Debug, Default)]
pub(super) struct Stretches {
    begin: Option<usize>,
    middle: Option<usize>,
}

impl Stretches {
    /// Forgets a stretch begun.
    pub fn reset(&mut self) {
        *self = Stretches::default();
    }

    /// Takes a motion's next sample; a stretch if it completes one.
    pub fn take(&mut self, time_s: &[f64], end: usize) -> Option<Stretch> {
        let begin = *self.begin.get_or_insert(end);
        if time_s[end] - time_s[self.middle.unwrap_or(begin)] < HALF_S {
            return None;
        }
        let Some(middle) = self.middle.take() else {
            self.middle = Some(end);
            return None;
        };
        self.begin = Some(end);
        Some(Stretch { begin, middle, end })
    }
}

impl Stretch {
    /// Mean of values that straight lines join; 0 of none.
    pub fn mean(self, motion: &Motion, values: Option<&[f64]>) -> f64 {
        let between = |values: &[f64], k: usize| 0.5 * (values[k] + values[k + 1]);
        values.map_or(0.0, |values| self.weighted(motion, |k| between(values, k)))
    }

    /// Mean of values that hold to the next; 0 of none.
    pub fn mean_held(self, motion: &Motion, values: Option<&[f64]>) -> f64 {
        values.map_or(0.0, |values| self.weighted(motion, |k| values[k]))
    }

    fn weighted(self, motion: &Motion, value: impl Fn(usize) -> f64) -> f64 {
        let time_s = &motion.time_s;
        let step_s = |k: usize| time_s[k + 1] - time_s[k];
        let sum: f64 = (self.begin..self.end).map(|k| step_s(k) * value(k)).sum();
        sum / (time_s[self.end] - time_s[self.begin])
    }

    /// Difference quotient of an angle, rad/s.
    pub fn speed_rad_s(self, motion: &Motion, joint: usize) -> f64 {
        slope(motion, joint, self.begin, self.end)
    }

    /// Second difference quotient of an angle, rad/s^2.
    pub fn acceleration_rad_s2(self, motion: &Motion, joint: usize) -> f64 {
        let first = slope(motion, joint, self.begin, self.middle);
        let second = slope(motion, joint, self.middle, self.end);
        2.0 * (second - first) / (motion.time_s[self.end] - motion.time_s[self.begin])
    }
}

fn slope(motion: &Motion, joint: usize, from: usize, to: usize) -> f64 {
    let (time_s, angle) = (&motion.time_s, &motion.position_rad[joint]);
    (angle[to] - angle[from]) / (time_s[to] - time_s[from])
}
