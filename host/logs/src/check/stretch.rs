//! Short stretches of a motion, long enough to differentiate a coarse encoder twice.

use crate::row::LogRow;

/// Half a stretch's least duration, s.
const HALF_S: f64 = 0.02;

/// Means and differences over one stretch.
#[derive(Debug, Clone, Default)]
pub(super) struct Stretch {
    /// Mean angle per joint, rad.
    pub position_rad: Vec<f64>,
    /// Difference quotient of the angle per joint, rad/s.
    pub speed_rad_s: Vec<f64>,
    /// Second difference quotient per joint, rad/s^2.
    pub acceleration_rad_s2: Vec<f64>,
    /// Mean of the logged speed per joint, rad/s; 0 where not logged.
    pub logged_speed_rad_s: Vec<f64>,
    /// Mean reading of each joint's own rate sensor, 0 where it has none.
    pub rate_rad_s: Vec<f64>,
    /// Mean input per joint, SI; 0 where there is none.
    pub input: Vec<f64>,
}

/// Gathers samples into stretches that share their end samples.
#[derive(Debug, Default)]
pub(super) struct Stretches {
    begin: Option<(f64, Vec<f64>)>,
    middle: Option<(f64, Vec<f64>)>,
    sums: Stretch,
    /// Duration of the sums, s.
    weight: f64,
    previous: Option<LogRow>,
}

impl Stretches {
    /// Forgets a stretch begun.
    pub fn reset(&mut self) {
        *self = Stretches::default();
    }

    /// Takes a sample; a stretch if it completes one.
    pub fn take(&mut self, row: &LogRow) -> Option<Stretch> {
        let here = (row.time_s, row.position_rad.clone());
        let Some((begin, _)) = self.begin else {
            self.begin = Some(here);
            self.previous = Some(row.clone());
            return None;
        };
        self.sum(row);
        let since_s = match &self.middle {
            Some((middle, _)) => row.time_s - middle,
            None => row.time_s - begin,
        };
        if since_s < HALF_S {
            return None;
        }
        if self.middle.is_none() {
            self.middle = Some(here);
            return None;
        }
        let stretch = self.finish(&here);
        let previous = self.previous.take();
        *self = Stretches {
            begin: Some(here),
            previous,
            ..Stretches::default()
        };
        stretch
    }

    /// Adds the stretch from the previous sample to `row`; inputs hold, the rest is joined by
    /// lines.
    fn sum(&mut self, row: &LogRow) {
        let Some(previous) = &mut self.previous else {
            return;
        };
        let joints = row.position_rad.len();
        let sums = &mut self.sums;
        for sum in [
            &mut sums.position_rad,
            &mut sums.logged_speed_rad_s,
            &mut sums.rate_rad_s,
            &mut sums.input,
        ] {
            sum.resize(joints, 0.0);
        }
        let dt = row.time_s - previous.time_s;
        self.weight += dt;
        for i in 0..joints {
            sums.position_rad[i] += dt * 0.5 * (previous.position_rad[i] + row.position_rad[i]);
            let speeds = [previous.velocity_rad_s[i], row.velocity_rad_s[i]];
            sums.logged_speed_rad_s[i] += dt * 0.5 * speeds.iter().flatten().sum::<f64>();
            let rates = [previous.rate_rad_s[i], row.rate_rad_s[i]];
            sums.rate_rad_s[i] += dt * 0.5 * rates.iter().flatten().sum::<f64>();
            sums.input[i] += dt * previous.input[i].unwrap_or(0.0);
        }
        previous.clone_from(row);
    }

    fn finish(&mut self, end: &(f64, Vec<f64>)) -> Option<Stretch> {
        let (Some(begin), Some(middle)) = (&self.begin, &self.middle) else {
            return None;
        };
        let mut stretch = std::mem::take(&mut self.sums);
        for sum in [
            &mut stretch.position_rad,
            &mut stretch.logged_speed_rad_s,
            &mut stretch.rate_rad_s,
            &mut stretch.input,
        ] {
            sum.iter_mut().for_each(|value| *value /= self.weight);
        }
        for i in 0..end.1.len() {
            let first = (middle.1[i] - begin.1[i]) / (middle.0 - begin.0);
            let second = (end.1[i] - middle.1[i]) / (end.0 - middle.0);
            stretch
                .speed_rad_s
                .push((end.1[i] - begin.1[i]) / (end.0 - begin.0));
            stretch
                .acceleration_rad_s2
                .push(2.0 * (second - first) / (end.0 - begin.0));
        }
        Some(stretch)
    }
}
