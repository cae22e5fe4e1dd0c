//! Choosing the steps of a fixed-point law: powers of two, from declared ranges.
//!
//! With k = K (state step) 2^shift / (input step), a row of gains only knows the scale 2^shift /
//! (input step). It is made as large as gains and sum allow: every gain fits a word, and sum |k|
//! 2^(bits-1) + |bias| < 2^(2 bits-1), so that no states whatever overflow the sum. The shift is
//! then the least that lets the input reach its range, for each place more makes a step of the
//! input twice as coarse. Whole bytes would save an 8-bit machine next to nothing
//! (docs/measured/bench-firmware.md) and cost up to seven places.

use super::error::DesignError;
use super::fixed_law::FixedLaw;
use nalgebra::DMatrix;

/// What a fixed-point law must cover, in SI.
#[derive(Debug, Clone, PartialEq)]
pub struct Ranges {
    /// Largest departure of each state from the operating point.
    pub state: Vec<f64>,
    /// Largest magnitude of each input: also its limit.
    pub input: Vec<f64>,
}

/// The words of a fixed-point law.
#[derive(Debug, Clone, PartialEq)]
pub struct Format {
    /// Word length, 8 to 32; 16 is what ships.
    pub bits: u32,
    /// SI value of one step of each state, where a sensor sets it; powers of two otherwise.
    pub state_step: Option<Vec<f64>>,
    /// SI value of one step of each input, where a drive sets it.
    pub input_step: Option<Vec<f64>>,
}

impl Default for Format {
    fn default() -> Self {
        Format {
            bits: 16,
            state_step: None,
            input_step: None,
        }
    }
}

/// The gains `k` (m x n) about the operating point `x0`, `u0` (SI) in fixed point.
///
/// # Errors
/// Ranges that are no positive numbers or do not fit the words.
pub fn quantise(
    k: &DMatrix<f64>,
    x0: &[f64],
    u0: &[f64],
    ranges: &Ranges,
    format: &Format,
) -> Result<FixedLaw, DesignError> {
    let bits = format.bits;
    if !(8..=32).contains(&bits) {
        return Err(DesignError::request(
            format!("a word of {bits} bits"),
            "choose 8 to 32 bits",
        ));
    }
    positive("range", "state", &ranges.state, k.ncols())?;
    positive("range", "input", &ranges.input, k.nrows())?;
    let word = largest_word(bits);
    let reach: Vec<f64> = x0
        .iter()
        .zip(&ranges.state)
        .map(|(x, range)| x.abs() + range)
        .collect();
    let state_step = steps("state", format.state_step.as_deref(), &reach, word)?;
    let mut law = FixedLaw {
        bits,
        k: DMatrix::zeros(k.nrows(), k.ncols()),
        bias: Vec::new(),
        shift: Vec::new(),
        limits: Vec::new(),
        x0: x0
            .iter()
            .zip(&state_step)
            .map(|(x, step)| (x / step).round() as i64)
            .collect(),
        state_step,
        input_step: Vec::new(),
    };
    if let Some(given) = &format.input_step {
        steps("input", Some(given), &ranges.input, word)?;
    }
    for i in 0..k.nrows() {
        let row = GainRow {
            weights: (0..k.ncols())
                .map(|j| k[(i, j)] * law.state_step[j])
                .collect(),
            u0: u0[i],
            range: ranges.input[i],
            bits,
        };
        let (shift, step) = match &format.input_step {
            Some(given) => row.shift_for(given[i], i)?,
            None => row.shift_and_step(),
        };
        let scale = 2f64.powi(shift as i32) / step;
        for (j, weight) in row.weights.iter().enumerate() {
            law.k[(i, j)] = (weight * scale).round() as i64;
        }
        let half = if shift == 0 { 0 } else { 1_i64 << (shift - 1) };
        // The operating point is kept to the fraction that the sum has.
        law.bias.push((u0[i] * scale).round() as i64 + half);
        law.shift.push(shift);
        let limit = (ranges.input[i] / step).round().min(word) as i64;
        law.limits.push([-limit, limit]);
        law.input_step.push(step);
    }
    Ok(law)
}

/// One input's gains times the states' steps.
struct GainRow {
    weights: Vec<f64>,
    u0: f64,
    range: f64,
    bits: u32,
}

impl GainRow {
    /// Whether gains and sum fit at this scale.
    fn fits(&self, scale: f64, shift: u32) -> bool {
        let word = 2f64.powi(self.bits as i32 - 1);
        let sizes = || self.weights.iter().map(|w| (w * scale).abs().round());
        let sum: f64 = sizes().sum();
        let most = sizes().fold(0.0, f64::max);
        let bias = (self.u0 * scale).abs().round() + 2f64.powi(shift as i32);
        most < word && sum * word + bias < 2.0 * word * word - 1.0
    }

    /// The largest scale that fits, and its split into the least shift and a step that the range
    /// needs.
    fn shift_and_step(&self) -> (u32, f64) {
        let word = largest_word(self.bits);
        let most_shift = self.bits.next_multiple_of(8);
        // The step must let the range fit, so 2^shift / step has a largest value for the longest
        // shift.
        let least_step = power_of_two_above(self.range.max(self.u0.abs()) / word);
        let mut scale = 2f64.powi(most_shift as i32) / least_step;
        while !self.fits(scale, most_shift) {
            scale /= 2.0;
        }
        let step = |shift: u32| 2f64.powi(shift as i32) / scale;
        let enough = |shift: &u32| step(*shift) >= least_step;
        let shift = (0..=most_shift).find(enough).unwrap_or(most_shift);
        (shift, step(shift))
    }

    /// The longest shift that fits with a given step.
    fn shift_for(&self, step: f64, input: usize) -> Result<(u32, f64), DesignError> {
        let fits = |shift: &u32| self.fits(2f64.powi(*shift as i32) / step, *shift);
        let shift = (0..2 * self.bits - 1).rev().find(fits).ok_or_else(|| {
            DesignError::model(
                format!(
                    "the gains of input {} overflow {} bits: the sum over the declared ranges \
                         is too large for its step of {step}",
                    input + 1,
                    self.bits
                ),
                "declare smaller ranges, or take a coarser input step",
            )
        })?;
        Ok((shift, step))
    }
}

pub(super) fn positive(
    what: &'static str,
    of: &'static str,
    values: &[f64],
    count: usize,
) -> Result<(), DesignError> {
    if values.len() != count {
        return Err(DesignError::request(
            format!(
                "{} values of {of} {what}, but there are {count} {of}s",
                values.len()
            ),
            format!("give one per {of}, or one for all"),
        ));
    }
    match values
        .iter()
        .position(|value| !(*value > 0.0 && value.is_finite()))
    {
        None => Ok(()),
        Some(at) => Err(DesignError::request(
            format!("the {what} of {of} {} is {}", at + 1, values[at]),
            "give a number above 0",
        )),
    }
}

/// Steps that let `reach` fit a word: the given ones, checked, or powers of two.
fn steps(
    of: &'static str,
    given: Option<&[f64]>,
    reach: &[f64],
    word: f64,
) -> Result<Vec<f64>, DesignError> {
    let Some(given) = given else {
        return Ok(reach
            .iter()
            .map(|reach| power_of_two_above(reach / word))
            .collect());
    };
    positive("step", of, given, reach.len())?;
    let beyond = given
        .iter()
        .zip(reach)
        .position(|(step, reach)| reach / step > word);
    match beyond {
        None => Ok(given.to_vec()),
        Some(at) => Err(DesignError::model(
            format!(
                "{of} {} reaches {:.0} steps of {}, but a word holds {word}",
                at + 1,
                reach[at] / given[at],
                given[at]
            ),
            "declare a smaller range, or a coarser step",
        )),
    }
}

/// The largest number that a word of so many bits holds.
pub(super) fn largest_word(bits: u32) -> f64 {
    2f64.powi(bits as i32 - 1) - 1.0
}

pub(super) fn power_of_two_above(value: f64) -> f64 {
    2f64.powi(value.log2().ceil() as i32)
}

#[cfg(test)]
mod tests;
