//! Columns whose samples were taken at another time than their rows say.

use super::Motion;
use crate::model::{JointColumns, LogColumns};

impl Motion {
    /// Moves columns in time by what `columns` says, s: values between samples by straight lines.
    /// Rows at the ends for which a moved column has no value are left out.
    pub fn shifted(self, columns: &LogColumns) -> Motion {
        self.shifted_by(|joint| columns.joints[joint].shifts_s())
    }

    /// As [`Motion::shifted`], by what each joint's position, velocity, rate and input ask for, s.
    pub fn shifted_by(mut self, shifts_s: impl Fn(usize) -> [f64; 4]) -> Motion {
        let (mut earliest, mut latest) = (0.0_f64, 0.0_f64);
        for joint in 0..self.position_rad.len() {
            let shifts = shifts_s(joint);
            let time_s = &self.time_s;
            let mut shift = |values: Option<&mut Vec<f64>>, shift_s: f64| {
                if let Some(values) = values.filter(|_| shift_s != 0.0) {
                    earliest = earliest.min(shift_s);
                    latest = latest.max(shift_s);
                    *values = moved(time_s, values, shift_s);
                }
            };
            shift(Some(&mut self.position_rad[joint]), shifts[0]);
            shift(self.velocity_rad_s[joint].as_mut(), shifts[1]);
            let rate = self.rate_rad_s.get_mut(joint);
            shift(rate.and_then(Option::as_mut), shifts[2]);
            shift(self.input[joint].as_mut(), shifts[3]);
        }
        if (earliest, latest) == (0.0, 0.0) {
            return self;
        }
        let Some((first, last)) = self.time_s.first().zip(self.time_s.last()) else {
            return self;
        };
        let (from, to) = (first + latest, last + earliest);
        let begin = self.time_s.partition_point(|t| *t < from);
        let end = self.time_s.partition_point(|t| *t <= to).max(begin);
        self.part(begin..end)
    }

    /// Some of its samples.
    pub fn part(&self, samples: std::ops::Range<usize>) -> Motion {
        let of = |values: &Vec<f64>| values[samples.clone()].to_vec();
        let of_each = |all: &[Option<Vec<f64>>]| all.iter().map(|v| v.as_ref().map(of)).collect();
        Motion {
            name: self.name.clone(),
            source: self.source.clone(),
            time_s: of(&self.time_s),
            position_rad: self.position_rad.iter().map(of).collect(),
            velocity_rad_s: of_each(&self.velocity_rad_s),
            rate_rad_s: of_each(&self.rate_rad_s),
            input: of_each(&self.input),
            supply_v: self.supply_v.as_ref().map(of),
            torque_on: self
                .torque_on
                .as_ref()
                .map(|on| on[samples.clone()].to_vec()),
            payload_kg: self.payload_kg,
            turned: self.turned,
        }
    }
}

/// By how much the earliest and the latest of all columns is moved, s: at most 0, at least 0.
pub fn ends_s(columns: &LogColumns) -> (f64, f64) {
    let shifts_s = columns.joints.iter().flat_map(JointColumns::shifts_s);
    shifts_s.fold((0.0, 0.0), |(earliest, latest): (f64, f64), shift_s| {
        (earliest.min(shift_s), latest.max(shift_s))
    })
}

/// The values at each row's time, where they were taken `shift_s` later than written; the first or
/// last value beyond the ends.
fn moved(time_s: &[f64], values: &[f64], shift_s: f64) -> Vec<f64> {
    let at = |t: &f64| {
        let wanted = t - shift_s;
        let after = time_s.partition_point(|t| *t <= wanted);
        match (after.checked_sub(1), time_s.get(after)) {
            (None, _) => values[0],
            (Some(before), None) => values[before],
            (Some(before), Some(next)) => {
                let share = (wanted - time_s[before]) / (next - time_s[before]);
                values[before] + share * (values[after] - values[before])
            }
        }
    };
    time_s.iter().map(at).collect()
}

#[cfg(test)]
mod tests {
    use crate::fixture::motion;

    #[test]
    fn a_shift_moves_a_column_and_shortens_the_motion() {
        let motion = motion("m", 100);
        let late = motion.clone().shifted_by(|_| [0.0, 0.0, 0.0, 0.025]);
        assert_eq!(late.time_s, motion.time_s[3..].to_vec());
        let (was, is) = (
            motion.input[0].as_ref().unwrap(),
            late.input[0].as_ref().unwrap(),
        );
        assert!((is[0] - 0.5 * (was[0] + was[1])).abs() < 1e-12);
        assert_eq!(late.position_rad[0], motion.position_rad[0][3..]);
        let early = motion.clone().shifted_by(|_| [-0.02, 0.0, 0.0, 0.0]);
        assert_eq!(early.len(), 98);
        assert!((early.position_rad[0][0] - motion.position_rad[0][2]).abs() < 1e-12);
        assert_eq!(motion.clone().shifted_by(|_| [0.0; 4]), motion);
    }
}
