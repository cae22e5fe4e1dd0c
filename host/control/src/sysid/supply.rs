//! Speed error against supply voltage: the paper's Figure 5.

use super::blocks::BlockMean;
use super::dynamics::IntervalEstimate;
use crate::error::Problem;
use crate::fitting::quantile_975;
use serde::Serialize;

/// Share of the largest command below which a block does not count: there the dead zone speaks.
const LEAST_COMMAND: f64 = 0.5;
/// Fewest blocks for a line.
const LEAST: usize = 8;

/// A line: relative speed error against supply.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct SupplyLine {
    /// Change of `speed / command - 1` per volt.
    pub error_per_v: IntervalEstimate,
    /// Supply at which the speed is the one commanded, V; its interval may be unbounded.
    pub right_at_v: IntervalEstimate,
    /// Lowest and highest supply seen, V.
    pub range_v: (f64, f64),
    /// Blocks that counted.
    pub blocks: usize,
    /// Root-mean-square of what is left of the relative error.
    pub rms: f64,
}

/// Blocks that count, as (supply, speed / command - 1).
pub fn errors(blocks: &[BlockMean]) -> Vec<(f64, f64)> {
    let largest = blocks.iter().map(|b| b.input.abs()).fold(0.0, f64::max);
    blocks
        .iter()
        .filter(|b| b.supply_v.is_finite() && b.input != 0.0)
        .filter(|b| b.input.abs() >= LEAST_COMMAND * largest)
        .map(|b| (b.supply_v, b.output / b.input - 1.0))
        .collect()
}

impl SupplyLine {
    /// Fits the line; `output` of the blocks is a speed in the unit of their `input`.
    ///
    /// The interval of the supply at which the error is zero is Fieller's (1954): exact, and
    /// unbounded where the slope is not significant.
    ///
    /// # Errors
    /// Too few blocks, or a supply that does not change.
    pub fn fit(blocks: &[BlockMean]) -> Result<SupplyLine, Problem> {
        let points = errors(blocks);
        if points.len() < LEAST {
            return Err(Problem::new(
                format!(
                    "{} blocks with a supply and at least half the largest command where {LEAST} \
                     are the least",
                    points.len()
                ),
                "a block counts where the input hardly changes over it and the one before: hold \
                 large commands for a second each, or average over less: --block 0.1",
            ));
        }
        let count = points.len() as f64;
        let mean_v = points.iter().map(|p| p.0).sum::<f64>() / count;
        let mean = points.iter().map(|p| p.1).sum::<f64>() / count;
        let square: f64 = points.iter().map(|p| (p.0 - mean_v).powi(2)).sum();
        if square <= count * 1e-6 {
            return Err(Problem::new(
                "the supply does not change",
                "record at several supply voltages",
            ));
        }
        let product: f64 = points.iter().map(|p| (p.0 - mean_v) * (p.1 - mean)).sum();
        let slope = product / square;
        let cost: f64 = points
            .iter()
            .map(|p| (p.1 - mean - slope * (p.0 - mean_v)).powi(2))
            .sum();
        let variance = cost / (count - 2.0);
        let reach = quantile_975(count - 2.0);
        let volts = || points.iter().map(|p| p.0);
        Ok(SupplyLine {
            error_per_v: IntervalEstimate::around(slope, reach * (variance / square).sqrt()),
            right_at_v: zero(
                (mean_v, mean),
                slope,
                [variance / count, variance / square],
                reach,
            ),
            range_v: (
                volts().fold(f64::INFINITY, f64::min),
                volts().fold(f64::NEG_INFINITY, f64::max),
            ),
            blocks: points.len(),
            rms: (cost / count).sqrt(),
        })
    }
}

/// Where `mean + slope (v - mean_v)` crosses zero: all v at which it is within `reach` standard
/// errors of it.
fn zero(
    (mean_v, mean): (f64, f64),
    slope: f64,
    [mean_variance, slope_variance]: [f64; 2],
    reach: f64,
) -> IntervalEstimate {
    let z = reach * reach;
    let value = mean_v - mean / slope;
    // slope^2 x^2 + 2 mean slope x + mean^2 = z (mean_variance + slope_variance x^2), x = v -
    // mean_v.
    let a = slope * slope - z * slope_variance;
    let b = mean * slope;
    let c = mean * mean - z * mean_variance;
    let root = b * b - a * c;
    if a <= 0.0 || root < 0.0 {
        return IntervalEstimate {
            value,
            low: f64::NEG_INFINITY,
            high: f64::INFINITY,
        };
    }
    IntervalEstimate {
        value,
        low: mean_v + (-b - root.sqrt()) / a,
        high: mean_v + (-b + root.sqrt()) / a,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sysid::generate::noise;

    fn measured(per_v: f64, right_at_v: f64, seed: u64) -> Vec<BlockMean> {
        let noise = noise(60, 0.02, seed);
        (0..60)
            .map(|k| {
                let supply_v = 8.0 + 3.0 * k as f64 / 59.0;
                let input = if k % 2 == 0 { 5.0 } else { -4.0 };
                BlockMean {
                    input,
                    output: input * (1.0 + per_v * (supply_v - right_at_v) + noise[k]),
                    supply_v,
                }
            })
            .collect()
    }

    #[test]
    fn intervals_hold_the_truth() {
        let held = (0..1000).map(|seed| {
            let line = SupplyLine::fit(&measured(0.1, 9.8, seed)).unwrap();
            [line.error_per_v.holds(0.1), line.right_at_v.holds(9.8)].map(usize::from)
        });
        let held = held.fold([0, 0], |sum, one| [sum[0] + one[0], sum[1] + one[1]]);
        // 950 expected, give or take 7.
        assert!(
            held.iter().all(|count| (929..=971).contains(count)),
            "{held:?}"
        );
    }

    #[test]
    fn a_supply_that_does_not_matter_is_right_nowhere_in_particular() {
        let line = SupplyLine::fit(&measured(0.0, 9.8, 1)).unwrap();
        assert!(line.error_per_v.holds(0.0));
        let width = line.right_at_v.high - line.right_at_v.low;
        assert!(width > 3.0, "{line:?}");
    }

    #[test]
    fn a_constant_supply_is_refused() {
        let mut blocks = measured(0.1, 9.8, 1);
        blocks.iter_mut().for_each(|block| block.supply_v = 9.8);
        let refused = |blocks: &[BlockMean]| SupplyLine::fit(blocks).unwrap_err().to_string();
        assert_eq!(refused(&blocks), "the supply does not change");
        assert_eq!(
            refused(&blocks[..3]),
            "3 blocks with a supply and at least half the largest command where 8 are the least"
        );
    }
}
