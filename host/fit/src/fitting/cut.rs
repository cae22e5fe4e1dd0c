//! Motions cut into windows.
//!
//! A window begins where the samples tell its start state: at a knock, or where a joint starts to
//! move, the speed jumps, and what the samples around it say of the speed is true of neither side.

use super::horizon::{Horizon, Window};
use super::window_start::{REACH_S, StartDoubt};
use crate::motion::Motion;

/// A start that the samples around it contradict by more than so many standard deviations is moved
/// to where they do so by fewer than that.
const DOUBTFUL: f64 = 3.0;
const CERTAIN: f64 = 1.0;
/// How many samples tell whether those of a motion are doubtful at all.
const LOOKED_AT: usize = 41;
/// By how much, at most, in parts of a window.
const MOVED: f64 = 0.3;

/// Windows as long as the horizon and the motion's own, in which its errors stay small, allow.
pub(super) fn cut_evenly(motions: &[Motion], stable: &[Horizon], horizon: Horizon) -> Vec<Window> {
    let mut windows = Vec::new();
    for (motion, (log, stable)) in motions.iter().zip(stable).enumerate() {
        let pieces = match stable.shorter(horizon) {
            Horizon::Whole => 1,
            Horizon::Seconds(seconds) => {
                let most = (log.len() / 5).max(1);
                ((log.duration_s() / seconds).round() as usize).clamp(1, most)
            }
        };
        let edge = |piece: usize| piece * log.len() / pieces;
        windows.extend((0..pieces).map(|piece| Window {
            motion,
            samples: edge(piece)..edge(piece + 1),
        }));
    }
    windows
}

/// The same, begun where the samples tell the start; `sigma` is each joint's noise.
pub(super) fn cut(
    motions: &[Motion],
    stable: &[Horizon],
    sigma: &[f64],
    horizon: Horizon,
) -> Vec<Window> {
    let mut windows = cut_evenly(motions, stable, horizon);
    for of_motion in windows.chunk_by_mut(|a, b| a.motion == b.motion) {
        let log = &motions[of_motion[0].motion];
        let pieces = of_motion.len() as f64;
        let most = (MOVED * log.len() as f64 / pieces) as usize;
        // Less far than a knock is seen, no place is better; nor where the noise is so low that
        // every swing is more than a parabola.
        let far = MOVED * log.duration_s() / pieces >= REACH_S;
        if !far || of_motion.len() == 1 || usual_doubt(log, sigma) > DOUBTFUL {
            continue;
        }
        for next in 1..of_motion.len() {
            let start = certain_start(log, sigma, of_motion[next].samples.start, most);
            of_motion[next - 1].samples.end = start;
            of_motion[next].samples.start = start;
        }
    }
    windows
}

/// By how many standard deviations the samples around one contradict it, in the middle of all.
fn usual_doubt(log: &Motion, sigma: &[f64]) -> f64 {
    let samples = (0..LOOKED_AT).map(|k| k * log.len().saturating_sub(1) / (LOOKED_AT - 1));
    let mut doubts: Vec<f64> = samples
        .map(|sample| StartDoubt::at(log, sigma, sample).doubt)
        .collect();
    doubts.sort_by(f64::total_cmp);
    doubts[LOOKED_AT / 2]
}

/// `even` where little contradicts the start state there; else the nearest sample, at most `most`
/// away, at which nothing does and no other joint seems at rest; the least contradicted one where
/// all are.
fn certain_start(log: &Motion, sigma: &[f64], even: usize, most: usize) -> usize {
    let start = StartDoubt::at(log, sigma, even);
    let mut least = (start.doubt, even);
    if start.doubt <= DOUBTFUL {
        return even;
    }
    for sample in (1..=most).flat_map(|off| [even + off, even - off]) {
        let found = StartDoubt::at(log, sigma, sample);
        if found.at_rest > start.at_rest {
            continue;
        }
        if found.doubt <= CERTAIN {
            return sample;
        }
        if found.doubt < least.0 {
            least = (found.doubt, sample);
        }
    }
    least.1
}

#[cfg(test)]
mod tests {
    use super::*;

    const SIGMA_RAD: f64 = 1e-3;

    /// Windows of a second of a motion of 4 s, read at 100 Hz, that turns at 1 rad/s, back at 1.5
    /// rad/s from `knock_s` on, as read with errors up to `noise_rad`.
    fn starts(knock_s: f64, noise_rad: f64) -> Vec<usize> {
        let time_s: Vec<f64> = (0..400).map(|k| f64::from(k) / 100.0).collect();
        let angle = |(k, &t): (usize, &f64)| {
            let error = noise_rad * (37.0 * (k * k % 101) as f64).sin();
            t - 2.5 * (t - knock_s).max(0.0) + error
        };
        let motion = Motion {
            position_rad: vec![time_s.iter().enumerate().map(angle).collect()],
            time_s,
            ..Motion::default()
        };
        let windows = cut(
            &[motion],
            &[Horizon::Whole],
            &[SIGMA_RAD],
            Horizon::Seconds(1.0),
        );
        assert_eq!(windows.last().map(|w| w.samples.end), Some(400));
        windows.iter().map(|w| w.samples.start).collect()
    }

    #[test]
    fn noise_alone_moves_no_start() {
        assert_eq!(starts(5.0, SIGMA_RAD), [0, 100, 200, 300]);
    }

    #[test]
    fn a_start_at_a_knock_moves_beyond_the_samples_that_see_it() {
        for knock_s in [1.99, 2.0, 2.01] {
            let starts = starts(knock_s, SIGMA_RAD);
            assert_eq!((starts[1], starts[3]), (100, 300));
            let off_s = (starts[2] as f64 / 100.0 - knock_s).abs();
            assert!((0.03..0.2).contains(&off_s), "{knock_s} {starts:?}");
        }
    }
}
