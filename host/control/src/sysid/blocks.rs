//! Motions in short blocks of time: means of command and output, for static maps.

use super::record::OutputQuantity;
use crate::motion::Motion;

/// Most the input may change over a block and the one before, as a share of its whole range: more
/// is a step, and what follows one is not rest.
const STEP: f64 = 0.05;

/// Means over a stretch of time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BlockMean {
    /// Raw command, SI of its kind.
    pub input: f64,
    /// Measured output, SI: a mean, or the speed from the first angle to the last, rad/s.
    pub output: f64,
    /// SupplyLine, V; not a number where it was not logged.
    pub supply_v: f64,
}

/// Joint `joint` (from 0) of the motions in blocks of `block_s` seconds, but for blocks in or right
/// after a step of the input, and the first of a motion, whose past is not known; what is left at a
/// motion's end is dropped.
///
/// A mean over time takes the steps out that a coarse encoder puts into a speed. Blocks of a
/// passive joint: none.
pub fn blocks(
    motions: &[Motion],
    joint: usize,
    output: OutputQuantity,
    block_s: f64,
) -> Vec<BlockMean> {
    let inputs = motions.iter().filter_map(|m| m.input[joint].as_ref());
    let (low, high) = range(inputs.flatten());
    let most = STEP * (high - low);
    let mut all = Vec::new();
    for motion in motions {
        let Some(input) = &motion.input[joint] else {
            continue;
        };
        let measured = &motion.position_rad[joint];
        // The sample before a block is looked at too: its input may have acted into it.
        let (mut before, mut first) = (None, 0);
        for last in 1..motion.len() {
            let duration_s = motion.time_s[last] - motion.time_s[first];
            // Rounding of time stamps must not add a sample to some blocks.
            if duration_s < block_s * (1.0 - 1e-6) {
                continue;
            }
            let mean =
                |values: &[f64]| values[first..last].iter().sum::<f64>() / (last - first) as f64;
            let calm = |before: usize| {
                let (low, high) = range(&input[before..=last]);
                high - low <= most
            };
            if before.is_some_and(calm) {
                all.push(BlockMean {
                    input: mean(input),
                    output: match output {
                        OutputQuantity::AsMeasured => mean(measured),
                        OutputQuantity::Velocity => (measured[last] - measured[first]) / duration_s,
                    },
                    supply_v: motion.supply_v.as_ref().map_or(f64::NAN, |v| mean(v)),
                });
            }
            (before, first) = (Some(first), last);
        }
    }
    all
}

fn range<'a>(values: impl IntoIterator<Item = &'a f64>) -> (f64, f64) {
    let none = (f64::INFINITY, f64::NEG_INFINITY);
    let widened = |(low, high): (f64, f64), v: &f64| (low.min(*v), high.max(*v));
    values.into_iter().fold(none, widened)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::motion::MotionSource;

    #[test]
    fn blocks_after_a_step_are_left_out() {
        // One rad/s, then two, from sample 20 on.
        let input: Vec<f64> = (0..41).map(|k| if k < 20 { 1.0 } else { 2.0 }).collect();
        let mut angle = vec![0.0];
        for u in &input[..40] {
            angle.push(angle[angle.len() - 1] + 0.1 * u);
        }
        let motion = Motion {
            name: String::new(),
            source: MotionSource {
                path: "a.csv".into(),
                sha256: String::new(),
                lines: (1, 1),
            },
            time_s: (0..41).map(|k| 0.1 * k as f64).collect(),
            position_rad: vec![angle],
            velocity_rad_s: vec![None],
            rate_rad_s: Vec::new(),
            input: vec![Some(input)],
            supply_v: None,
            torque_on: None,
            payload_kg: 0.0,
            turned: false,
        };
        let blocks = blocks(&[motion], 0, OutputQuantity::Velocity, 0.5);
        let speeds: Vec<f64> = blocks
            .iter()
            .map(|b| (b.output * 1e9).round() / 1e9)
            .collect();
        assert_eq!(speeds, [1.0, 1.0, 2.0, 2.0, 2.0]);
        assert!(blocks.iter().all(|b| (b.input - b.output).abs() < 1e-9));
    }
}
