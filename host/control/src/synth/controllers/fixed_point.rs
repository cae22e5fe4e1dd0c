//! A fixed-point law in a loop: the table that is exported, in the arithmetic that the board has.

use crate::sim::closed_loop::state_feedback::remember;
use crate::sim::closed_loop::{Controller, Measurement};
use crate::synth::{FixedLaw, Sums};
use handstand_shared::law::RowRef;

/// Bits of the words that ship.
const SHIPPED_BITS: u32 = 16;

/// u = sat(u0 - K (x - x0)) of states rounded to their steps. Words of 16 bits are computed by
/// [`handstand_shared::law`], bit for bit what firmware and C header compute; other lengths are for
/// studies.
#[derive(Debug, Clone)]
pub struct FixedPointFeedback {
    law: FixedLaw,
    /// Sums of angles among the states, which it keeps as the caller of the exported law does.
    sums: Option<Sums>,
    /// The pose about which a loop's measurements count, SI: angles, then speeds of 0.
    pose: Vec<f64>,
    /// Past inputs at the beginning, SI.
    past: Vec<f64>,
    /// The table in words, where they are those that ship.
    words: Option<Words>,
}

/// A table in words of 16 bits.
#[derive(Debug, Clone)]
struct Words {
    k: Vec<Vec<i16>>,
    x0: Vec<i16>,
}

impl FixedPointFeedback {
    /// The law in a loop about `x0`, SI: angles, speeds, sums, then past inputs as they are before
    /// the first sample.
    pub fn new(law: FixedLaw, sums: Option<Sums>, x0: &[f64], joints: usize) -> FixedPointFeedback {
        let (pose, rest) = x0.split_at(2 * joints);
        let past = &rest[sums.as_ref().map_or(0, |sums| sums.joints.len())..];
        let word = |value: &i64| *value as i16;
        let words = (law.bits == SHIPPED_BITS).then(|| Words {
            k: law
                .k
                .row_iter()
                .map(|row| row.iter().map(word).collect())
                .collect(),
            x0: law.x0.iter().map(word).collect(),
        });
        FixedPointFeedback {
            pose: pose.to_vec(),
            past: past.to_vec(),
            words,
            sums,
            law,
        }
    }

    fn sum_count(&self) -> usize {
        self.sums.as_ref().map_or(0, |sums| sums.joints.len())
    }

    /// Inputs in steps for states in steps.
    fn raw(&self, x: &[i64], mut input: impl FnMut(usize, i64)) {
        let law = &self.law;
        let Some(words) = &self.words else {
            let inputs = law.raw(x).into_iter().enumerate();
            return inputs.for_each(|(i, u)| input(i, u));
        };
        let x: Vec<i16> = x.iter().map(|x| *x as i16).collect();
        for (i, k) in words.k.iter().enumerate() {
            let row = RowRef {
                k,
                bias: law.bias[i] as i32,
                shift: law.shift[i] as u8,
                limits: law.limits[i].map(|limit| limit as i16),
            };
            input(i, row.input(&words.x0, &x).into());
        }
    }
}

impl Controller for FixedPointFeedback {
    fn memory_len(&self) -> usize {
        self.sum_count() + self.past.len()
    }

    fn reset(&self, memory: &mut [f64]) {
        let (sums, past) = memory.split_at_mut(self.sum_count());
        sums.fill(0.0);
        past.copy_from_slice(&self.past);
    }

    fn control(&self, memory: &mut [f64], measured: Measurement<'_>, command: &mut [f64]) {
        let departures = measured.angle_rad.iter().chain(measured.speed_rad_s);
        let own = self.pose.iter().zip(departures).map(|(x0, x)| x0 + x);
        // Sums are kept in integers, which a float of this width holds exactly.
        let (kept, past) = memory.split_at_mut(self.sum_count());
        let mut sums: Vec<i64> = kept.iter().map(|sum| *sum as i64).collect();
        let x = own.chain(kept.iter().copied()).chain(past.iter().copied());
        let mut x = self.law.states(&x.collect::<Vec<f64>>());
        if let Some(counted) = &self.sums {
            let places = x[counted.first..].iter_mut();
            for (x, state) in places.zip(counted.states(&sums)) {
                *x = state;
            }
        }
        let mut is_limited = false;
        self.raw(&x, |i, u| {
            is_limited |= self.law.limits[i].contains(&u);
            command[i] = u as f64 * self.law.input_step[i];
        });
        remember(past, command);
        if let Some(counted) = self.sums.as_ref().filter(|_| !is_limited) {
            counted.add(&mut sums, &x, &self.law.x0);
            for (kept, sum) in kept.iter_mut().zip(&sums) {
                *kept = *sum as f64;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::Model;
    use crate::sim::closed_loop::{Measurement, stream};
    use crate::synth::{Design, Request, Time};
    use rand::Rng as _;
    use std::path::Path;

    /// The words that ship and the wide integers of the proof say the same, past inputs and all.
    #[test]
    fn words_say_what_wide_integers_say() {
        let text = include_str!("../../../../models/handstand.toml");
        let model = Model::parse(text, Path::new("handstand.toml")).unwrap();
        let request = Request {
            time: Time::Sampled {
                ts_s: 0.01,
                delay_s: Some(0.013),
            },
            ..Request::standard(&model)
        };
        let design = Design::of(&model, &request).unwrap();
        let law = design.fixed.as_ref().unwrap().law.clone();
        let words = FixedPointFeedback::new(law.clone(), None, &design.x0, 3);
        assert!(words.words.is_some() && words.memory_len() == 4);
        let mut random = stream(7, 0);
        let mut memory = vec![0.0; words.memory_len()];
        words.reset(&mut memory);
        for _ in 0..2000 {
            let mut draw = |most: f64| -> [f64; 3] {
                std::array::from_fn(|_| random.random_range(-most..=most))
            };
            let (angle_rad, speed_rad_s) = (draw(0.03), draw(0.2));
            let mut x = design.x0.clone();
            for (x, off) in x.iter_mut().zip(angle_rad.iter().chain(&speed_rad_s)) {
                *x += off;
            }
            x[6..].copy_from_slice(&memory);
            let measured = Measurement {
                angle_rad: &angle_rad,
                speed_rad_s: &speed_rad_s,
            };
            let mut command = [0.0; 2];
            words.control(&mut memory, measured, &mut command);
            assert_eq!(command.to_vec(), law.control(&x));
            assert_eq!(memory[..2], command);
        }
    }
}
