//! What the joints' motions cover, in round numbers, by which the terms of a law are scaled.

use crate::diagnose::JointRange;
use crate::fitting::{FitProblem, Horizon};
use crate::model::Model;
use crate::motion::Motion;

/// The most that any joint covers, each rounded to one digit: equal rigs have equal terms.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Scales {
    /// Lowest angle, rad.
    pub low_rad: f64,
    /// Highest angle, rad.
    pub high_rad: f64,
    /// Largest angle from zero, rad.
    pub angle_rad: f64,
    /// Speed, rad/s.
    pub speed_rad_s: f64,
    /// Torque of the drives, N m.
    pub drive_nm: f64,
    /// Size of a term that is worth a look, N m.
    pub term_nm: f64,
    /// Largest input, in its own unit.
    pub input: f64,
    /// Longest motion, s.
    pub time_s: f64,
    /// Whether all joints slide: then rad is m, and N m is N.
    pub slides: bool,
    /// Whether the supply is logged and moves.
    pub supply_moves: bool,
}

/// Size of a term that is worth a look, as a share of the largest torque of gravity.
const TERM_SHARE: f64 = 0.05;
/// Share of the nominal supply by which one moves at least that teaches anything.
const SUPPLY_MOVES: f64 = 0.02;

impl Scales {
    pub fn of(model: &Model, motions: &[Motion]) -> Scales {
        let data = FitProblem::new(model, motions.to_vec(), Horizon::Whole);
        let ranges = (0..model.link_count()).map(|joint| JointRange::of(model, &data, joint));
        let ranges: Vec<JointRange> = ranges.collect();
        let most = |of: fn(&JointRange) -> f64| ranges.iter().map(of).fold(0.0, f64::max);
        let low_rad = ranges
            .iter()
            .map(|r| r.low_rad)
            .fold(f64::INFINITY, f64::min);
        let high_rad = ranges
            .iter()
            .map(|r| r.high_rad)
            .fold(-f64::INFINITY, f64::max);
        let inputs = motions
            .iter()
            .flat_map(|m| m.input.iter().flatten().flatten());
        let input = inputs.fold(0.0, |most: f64, input| most.max(input.abs()));
        let lasts = motions
            .iter()
            .filter_map(|m| Some(m.time_s.last()? - m.time_s.first()?));
        let supply = motions.iter().filter_map(|m| m.supply_v.as_ref()).flatten();
        let (least_v, most_v) = supply.fold((f64::INFINITY, 0.0_f64), |(least, most), v| {
            (least.min(*v), most.max(*v))
        });
        Scales {
            low_rad: one_digit(low_rad),
            high_rad: one_digit(high_rad),
            angle_rad: one_digit(low_rad.abs().max(high_rad.abs()).max(1e-3)),
            speed_rad_s: one_digit(most(|r| r.speed_rad_s).max(1e-3)),
            drive_nm: one_digit(most(|r| r.drive_nm).max(1e-6)),
            term_nm: one_digit(TERM_SHARE * most(|r| r.torque_nm).max(1e-6)),
            input: one_digit(input.max(1e-3)),
            time_s: one_digit(lasts.fold(0.1, f64::max)),
            slides: model.joints.iter().all(|joint| joint.slide.is_some()),
            supply_moves: most_v - least_v > SUPPLY_MOVES * most_v,
        }
    }
}

/// A number to its first digit.
fn one_digit(value: f64) -> f64 {
    if value == 0.0 || !value.is_finite() {
        return value;
    }
    format!("{value:.0e}").parse().unwrap_or(value)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scales_are_round() {
        assert_eq!(one_digit(0.0347), 0.03);
        assert_eq!(one_digit(-1.57), -2.0);
        assert_eq!(one_digit(0.0), 0.0);
        assert_eq!(one_digit(96.0), 100.0);
    }
}
