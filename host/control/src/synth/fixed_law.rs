//! A control law in fixed point of any word length, and what its rounding costs.
//!
//! With 16 bits it is [`handstand_shared::law::control`] bit for bit; other lengths are for
//! studies.

use super::eigen::{largest, poles};
use super::error::DesignError;
use super::gains::Gains;
use super::system::Discrete;
use handstand_shared::crc::crc32;
use handstand_shared::gains::VERSION;
use nalgebra::DMatrix;

/// u = sat(u0 - K (x - x0)) in words of `bits` bits, summed in twice as many.
#[derive(Debug, Clone, PartialEq)]
pub struct FixedLaw {
    /// Word length, 8 to 32.
    pub bits: u32,
    /// Gains, m x n, in steps of input step / state step / 2^shift.
    pub k: DMatrix<i64>,
    /// Input at the operating point times 2^shift, and the half that makes the shift round; one per
    /// input.
    pub bias: Vec<i64>,
    /// Places by which the sum is shifted right; one per input.
    pub shift: Vec<u32>,
    /// Limits of the inputs, in their steps.
    pub limits: Vec<[i64; 2]>,
    /// Operating point, in steps of the states.
    pub x0: Vec<i64>,
    /// SI value of one step of each state.
    pub state_step: Vec<f64>,
    /// SI value of one step of each input.
    pub input_step: Vec<f64>,
}

/// What fixed point costs, per input in SI.
#[derive(Debug, Clone)]
pub struct Loss {
    /// Most that rounded gains change the input within the declared ranges.
    pub gain_error: Vec<f64>,
    /// Most that rounded states and operating points change it.
    pub state_error: Vec<f64>,
    /// Most that its own rounding changes it.
    pub input_error: Vec<f64>,
    /// Bits between the largest sum that any states can make and overflow.
    pub margin_bits: Vec<f64>,
    /// Spectral radius of A - B K as designed.
    pub radius: f64,
    /// Spectral radius of A - B K_q with the rounded gains.
    pub radius_fixed: f64,
}

impl FixedLaw {
    /// The rounded gains in SI, m x n.
    pub fn gain(&self) -> DMatrix<f64> {
        DMatrix::from_fn(self.k.nrows(), self.k.ncols(), |i, j| {
            self.k[(i, j)] as f64 * self.input_step[i]
                / (self.state_step[j] * 2f64.powi(self.shift[i] as i32))
        })
    }

    /// Inputs in steps for states in steps; states beyond a word are clipped to it.
    pub fn raw(&self, x: &[i64]) -> Vec<i64> {
        let most = 1_i64 << (self.bits - 1);
        let departure = |(x, x0): (&i64, &i64)| (x - x0).clamp(-most, most - 1);
        let departure: Vec<i64> = x.iter().zip(&self.x0).map(departure).collect();
        let row = |i: usize| {
            let products = self.k.row(i);
            let sum: i64 = products.iter().zip(&departure).map(|(k, x)| k * x).sum();
            let [low, high] = self.limits[i];
            ((self.bias[i] - sum) >> self.shift[i]).clamp(low, high)
        };
        (0..self.k.nrows()).map(row).collect()
    }

    /// States in steps, rounded and clipped to a word.
    pub fn states(&self, x: &[f64]) -> Vec<i64> {
        let most = 2f64.powi(self.bits as i32 - 1);
        let step = |(x, step): (&f64, &f64)| (x / step).round().clamp(-most, most - 1.0) as i64;
        x.iter().zip(&self.state_step).map(step).collect()
    }

    /// Inputs in SI for states in SI: what the law does in a loop.
    pub fn control(&self, x: &[f64]) -> Vec<f64> {
        let raw = self.raw(&self.states(x));
        let si = |(u, step): (&i64, &f64)| *u as f64 * step;
        raw.iter().zip(&self.input_step).map(si).collect()
    }

    /// Largest magnitude of each input's sum for any states at all.
    pub fn peaks(&self) -> Vec<u128> {
        let most = 1_u128 << (self.bits - 1);
        let peak = |i: usize| {
            let gains = self.k.row(i);
            let sum: u128 = gains.iter().map(|k| u128::from(k.unsigned_abs())).sum();
            sum * most + u128::from(self.bias[i].unsigned_abs())
        };
        (0..self.k.nrows()).map(peak).collect()
    }

    /// What rounding costs for states within `state_range` of `x0`, before limits act.
    ///
    /// # Errors
    /// As [`poles`].
    pub fn loss(
        &self,
        plant: &Discrete,
        gains: &Gains,
        x0: &[f64],
        u0: &[f64],
        state_range: &[f64],
    ) -> Result<Loss, DesignError> {
        let rounded = self.gain();
        let (m, n) = rounded.shape();
        let per_input = |of: &dyn Fn(usize, usize) -> f64| -> Vec<f64> {
            (0..m).map(|i| (0..n).map(|j| of(i, j)).sum()).collect()
        };
        let point_off = |j: usize| (self.x0[j] as f64 * self.state_step[j] - x0[j]).abs();
        let overflow = 2f64.powi(2 * self.bits as i32 - 1);
        let radius = |k: &DMatrix<f64>| -> Result<f64, DesignError> {
            Ok(largest(&poles(&(&plant.a - &plant.b * k))?))
        };
        Ok(Loss {
            gain_error: per_input(&|i, j| {
                (rounded[(i, j)] - gains.k[(i, j)]).abs() * state_range[j]
            }),
            state_error: per_input(&|i, j| {
                rounded[(i, j)].abs() * (0.5 * self.state_step[j] + point_off(j))
            }),
            input_error: (0..m)
                .map(|i| {
                    let scale = 2f64.powi(self.shift[i] as i32);
                    let half = (scale / 2.0).floor();
                    let at = (self.bias[i] as f64 - half) / scale * self.input_step[i];
                    let shifted = if self.shift[i] == 0 { 0.0 } else { 0.5 };
                    shifted * self.input_step[i] + (at - u0[i]).abs()
                })
                .collect(),
            margin_bits: self
                .peaks()
                .iter()
                .map(|peak| (overflow / *peak as f64).log2())
                .collect(),
            radius: radius(&gains.k)?,
            radius_fixed: radius(&rounded)?,
        })
    }

    /// The canonical bytes of a 16-bit table: those of
    /// [`handstand_shared::gains::GainTable::bytes`].
    pub fn bytes(&self) -> Vec<u8> {
        let (m, n) = self.k.shape();
        let word = |value: i64| (value as i16).to_le_bytes();
        let mut bytes = vec![VERSION, m as u8, n as u8];
        for i in 0..m {
            bytes.extend(self.k.row(i).iter().flat_map(|k| word(*k)));
            bytes.extend((self.bias[i] as i32).to_le_bytes());
            bytes.push(self.shift[i] as u8);
            bytes.extend(self.limits[i].into_iter().flat_map(word));
        }
        bytes.extend(self.x0.iter().flat_map(|x| word(*x)));
        bytes
    }

    /// CRC-32 of the canonical bytes.
    pub fn fingerprint(&self) -> u32 {
        crc32(&self.bytes())
    }
}
