//! The same law in whole numbers of a given word length, as a small controller computes it.
//!
//! States and torques are words of `bits`, each with a power of two as its step, chosen so that the declared range
//! fits; gains are words too, their products summed in two words and brought to the torque's step by one shift that
//! rounds. The shift is the largest for which no sum can overflow.

use super::{Controller, Seen, StateFeedback};
use crate::error::{Error, Result};

/// Largest magnitudes that words must hold; beyond, they saturate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ranges {
    /// Of an angle, rad.
    pub angle_rad: f64,
    /// Of a speed, rad/s.
    pub speed_rad_s: f64,
    /// Of a torque, N m.
    pub torque_nm: f64,
}

/// u = -K (x - x0) in words.
#[derive(Debug, Clone, PartialEq)]
pub struct FixedFeedback {
    bits: u32,
    /// Step of each state, SI.
    step: Vec<f64>,
    /// State that is held, in steps.
    hold: Vec<i64>,
    torque_step_nm: f64,
    rows: Vec<Row>,
}

#[derive(Debug, Clone, PartialEq)]
struct Row {
    gains: Vec<i64>,
    feed: i64,
    /// Places to the right; to the left below 0, where the word is too short for the gains.
    shift: i32,
}

impl FixedFeedback {
    /// `law` in words of `bits`, 4 to 32.
    ///
    /// # Errors
    /// Word lengths out of range, gains that fit no word.
    pub fn new(law: &StateFeedback, ranges: Ranges, bits: u32) -> Result<Self> {
        if !(4..=32).contains(&bits) {
            return Err(Error::usage(
                format!("words of {bits} bits"),
                "give a word length from 4 to 32 bits",
            ));
        }
        let joints = law.hold.len() / 2;
        let states = law.gains.first().map_or(0, Vec::len);
        let range = |state: usize| match state {
            _ if state < joints => ranges.angle_rad,
            _ if state < 2 * joints => ranges.speed_rad_s,
            _ => ranges.torque_nm,
        };
        let step: Vec<f64> = (0..states).map(|state| step(range(state), bits)).collect();
        let torque_step_nm = self::step(ranges.torque_nm, bits);
        let rows = law.gains.iter().zip(&law.feed_nm).map(|(gains, feed)| {
            let scaled: Vec<f64> = gains
                .iter()
                .zip(&step)
                .map(|(gain, step)| gain * step / torque_step_nm)
                .collect();
            Row::new(&scaled, feed / torque_step_nm, bits)
        });
        Ok(FixedFeedback {
            bits,
            hold: law
                .hold
                .iter()
                .zip(&step)
                .map(|(x, step)| word(x / step, bits))
                .collect(),
            rows: rows.collect::<Result<_>>()?,
            step,
            torque_step_nm,
        })
    }
}

impl Row {
    /// Gains in steps of torque per step of state.
    fn new(scaled: &[f64], feed: f64, bits: u32) -> Result<Row> {
        let bits = bits as i32;
        let largest = 2f64.powi(2 * bits - 1);
        for shift in (-bits..2 * bits).rev() {
            let gains: Vec<f64> = scaled
                .iter()
                .map(|k| (k * 2f64.powi(shift)).round())
                .collect();
            let half = if shift > 0 { 2f64.powi(shift - 1) } else { 0.0 };
            let feed = (feed * 2f64.powi(shift)).round() + half;
            let sum: f64 = gains.iter().map(|k| k.abs()).sum();
            let fits = gains.iter().all(|k| k.abs() < 2f64.powi(bits - 1));
            if fits && sum * 2f64.powi(bits - 1) + feed.abs() < largest {
                return Ok(Row {
                    gains: gains.iter().map(|k| *k as i64).collect(),
                    feed: feed as i64,
                    shift,
                });
            }
        }
        Err(Error::design(
            format!("the gains do not fit words of {bits} bits"),
            "take longer words or smaller ranges",
        ))
    }
}

/// Smallest power of two with which `range` fits a signed word.
fn step(range: f64, bits: u32) -> f64 {
    2f64.powf((range / 2f64.powi(bits as i32 - 1)).log2().ceil())
}

/// The nearest word.
#[inline]
fn word(value: f64, bits: u32) -> i64 {
    let most = 1_i64 << (bits - 1);
    // A cast saturates, and makes nothing of what is no number.
    (value.round() as i64).clamp(-most, most - 1)
}

impl Controller for FixedFeedback {
    fn memory_len(&self) -> usize {
        self.step.len() - self.hold.len()
    }

    fn control(&self, memory: &mut [f64], seen: Seen<'_>, torque_nm: &mut [f64]) {
        let most = 1_i64 << (self.bits - 1);
        let x = seen
            .angle_rad
            .iter()
            .chain(seen.speed_rad_s)
            .chain(memory.iter());
        let hold = self.hold.iter().copied().chain(std::iter::repeat(0));
        for (torque, row) in torque_nm.iter_mut().zip(&self.rows) {
            let mut sum = row.feed;
            for (((x, step), hold), gain) in
                x.clone().zip(&self.step).zip(hold.clone()).zip(&row.gains)
            {
                let departure = word(x / step, self.bits) - hold;
                sum -= gain * departure.clamp(-most, most - 1);
            }
            let shifted = match row.shift {
                right if right >= 0 => sum >> right,
                left => sum << -left,
            };
            *torque = shifted.clamp(-most, most - 1) as f64 * self.torque_step_nm;
        }
        super::state_feedback::remember(memory, torque_nm);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const RANGES: Ranges = Ranges {
        angle_rad: 0.8,
        speed_rad_s: 20.0,
        torque_nm: 8.0,
    };

    fn law() -> StateFeedback {
        StateFeedback::new(
            3,
            vec![
                vec![
                    -75.758443, -32.187228, -11.454290, -13.004784, -6.2134254, -2.3441985,
                ],
                vec![
                    -62.056988, -26.928273, -9.0350845, -10.653945, -5.1619377, -1.8225471,
                ],
            ],
        )
        .holding(&[0.01, -0.02, 0.0])
    }

    fn torque(controller: &dyn Controller, angle_rad: &[f64], speed_rad_s: &[f64]) -> [f64; 2] {
        let mut torque = [0.0; 2];
        let seen = Seen {
            angle_rad,
            speed_rad_s,
        };
        controller.control(&mut [], seen, &mut torque);
        torque
    }

    #[test]
    fn longer_words_come_nearer_to_the_law() {
        let state = ([0.02, -0.03, 0.01], [0.3, -0.5, 0.4]);
        let exact = torque(&law(), &state.0, &state.1);
        let off = |bits: u32| {
            let fixed = FixedFeedback::new(&law(), RANGES, bits).unwrap();
            let found = torque(&fixed, &state.0, &state.1);
            (found[0] - exact[0]).abs().max((found[1] - exact[1]).abs())
        };
        assert!(
            off(32) < 1e-6 && off(16) < 0.02 && off(8) > off(16),
            "{} {} {}",
            off(8),
            off(16),
            off(32)
        );
    }

    #[test]
    fn it_saturates_and_never_overflows() {
        for bits in [4, 8, 16, 31, 32] {
            let fixed = FixedFeedback::new(&law(), RANGES, bits).unwrap();
            for angle in [1e9, -1e9, f64::INFINITY, f64::NAN] {
                let found = torque(&fixed, &[angle; 3], &[angle; 3]);
                assert!(found.iter().all(|t| t.abs() <= 8.0), "{bits} {found:?}");
            }
        }
    }
}
