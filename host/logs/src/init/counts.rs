//! Counts per turn of an angle that is read in counts.

use super::values::{range, stands_still};
use std::f64::consts::TAU;

/// Counts per turn of common encoders.
const COUNTS: [f64; 4] = [1024.0, 4096.0, 16384.0, 65536.0];

/// Counts per turn of the least encoder that reaches so far.
pub fn counts(highest: f64) -> f64 {
    let reach = COUNTS.into_iter().find(|counts| highest < *counts);
    reach.unwrap_or(COUNTS[COUNTS.len() - 1])
}

/// Counts per turn of an angle whose name says that it counts: of counts below zero, which leave
/// the first turn, the range says nothing, and most servos that write such have 4096.
pub fn counts_of(values: &[f64]) -> f64 {
    let (low, high) = range(values).unwrap_or((0.0, 0.0));
    if low < 0.0 {
        counts(high.max(-low)).max(4096.0)
    } else {
        counts(high)
    }
}

/// Counts per turn of the common encoder with which an angle moves most nearly as far as its goals
/// do, rad; none where either stands still.
pub fn counts_beside(angle: &[f64], goal_rad: &[f64]) -> Option<f64> {
    if stands_still(angle) || stands_still(goal_rad) {
        return None;
    }
    let spread = |values: &[f64]| {
        let known = || values.iter().filter(|value| value.is_finite());
        let middle = known().sum::<f64>() / known().count() as f64;
        let squares: f64 = known().map(|value| (value - middle).powi(2)).sum();
        (squares / known().count() as f64).sqrt()
    };
    let per_turn = TAU * spread(angle) / spread(goal_rad);
    let away = |counts: &f64| (counts / per_turn).ln().abs();
    COUNTS
        .into_iter()
        .min_by(|a, b| away(a).total_cmp(&away(b)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn goals_tell_the_counts_of_a_turn_and_counts_below_zero_no_first_turn() {
        let goal_rad: Vec<f64> = (0..400)
            .map(|k| 0.9 * (0.05 * f64::from(k)).sin())
            .collect();
        // A servo follows by nine tenths, around its middle.
        let counts = |per_turn: f64| -> Vec<f64> {
            let angle = goal_rad.iter().map(|goal| 0.9 * goal * per_turn / TAU);
            angle.map(|counts| (counts + 30.0).round()).collect()
        };
        for per_turn in [1024.0, 4096.0, 16384.0] {
            assert_eq!(counts_beside(&counts(per_turn), &goal_rad), Some(per_turn));
        }
        assert_eq!(counts_beside(&counts(4096.0), &[0.3; 400]), None);
        assert_eq!(counts_beside(&[7.0; 400], &goal_rad), None);
        assert_eq!(counts_of(&[12.0, 900.0]), 1024.0);
        assert_eq!(counts_of(&[-300.0, 500.0]), 4096.0);
        assert_eq!(counts_of(&[-300.0, 9000.0]), 16384.0);
    }
}
