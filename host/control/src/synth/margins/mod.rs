//! How robust a stable loop is: gain, phase, delay, the multiloop disk margin,
//! and the peaks of its sensitivities.
//!
//! L(z) = C (zI - A)^-1 B is the loop broken at the inputs (or at the sensors), with negative
//! feedback. All follows from S = (I + L)^-1 = I - C (zI - A + BC)^-1 B, which has no pole on the
//! circle. An eigenvalue s of S is one of L at 1/s - 1: L crosses |L| = 1 where |1 - s| = |s|, and
//! a gain g puts a pole on the circle where s = g / (g - 1).
//!
//! - Common: all inputs change alike. Single: one changes, the others stay as they are.
//! - Disk (Seiler, Packard, Gahinet, IEEE Control Systems 40 (2020) 78): all inputs change at once,
//!   each in its own way, in gain and phase. With the structured singular value mu of S - I/2 the
//!   margin is 1 / max mu, balanced between S and T.

mod crossing;
mod disk;
mod of_design;
mod response;

pub use disk::DiskMargin;
pub use of_design::{DesignMargins, SingularValues, SupplyRange, design_margins, singular_values};

use super::eigen::poles;
use super::error::DesignError;
use nalgebra::DMatrix;
use response::{Grid, Matrix, largest_singular_value};

/// A strictly proper loop transfer L = C (zI - A)^-1 B, closed by negative feedback.
#[derive(Debug, Clone, PartialEq)]
pub struct OpenLoop {
    /// N x N.
    pub a: DMatrix<f64>,
    /// N x m.
    pub b: DMatrix<f64>,
    /// m x N.
    pub c: DMatrix<f64>,
    /// Sampling time, s; none in continuous time.
    pub ts_s: Option<f64>,
}

/// Margins at one place of the loop alone.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LoopMargin {
    /// Factors of the gain between which the loop stays stable: from 0, and up to infinity, where
    /// nothing bounds it.
    pub gain: [f64; 2],
    /// Phase margin either way, rad; none where no phase is too much.
    pub phase_rad: Option<f64>,
    /// Delay margin, s; none where no delay is too much. Of sampled loops a shift of phase by
    /// frequency times delay.
    pub delay_s: Option<f64>,
}

/// The largest value of a response, and where it is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Peak {
    /// The value.
    pub value: f64,
    /// Its frequency, rad/s.
    pub frequency_rad_s: f64,
}

/// The margins of a loop.
#[derive(Debug, Clone, PartialEq)]
pub struct Margins {
    /// Of all channels together.
    pub common: LoopMargin,
    /// Of each channel alone.
    pub single: Vec<LoopMargin>,
    /// Of all channels, each in its own way.
    pub disk: DiskMargin,
    /// Largest singular value of S = (I + L)^-1.
    pub sensitivity: Peak,
    /// Largest singular value of T = L (I + L)^-1.
    pub complementary: Peak,
}

impl OpenLoop {
    /// A - BC, all channels times `gain`.
    pub(super) fn closed(&self, gain: f64) -> DMatrix<f64> {
        &self.a - gain * &self.b * &self.c
    }

    /// Whether the loop is stable with all channels times `gain`.
    fn is_stable(&self, gain: f64) -> Result<bool, DesignError> {
        let poles = poles(&self.closed(gain))?;
        Ok(match self.ts_s {
            Some(_) => poles.iter().all(|pole| pole.norm() < 1.0),
            None => poles.iter().all(|pole| pole.re < 0.0),
        })
    }

    /// The margins; none of a loop that is not stable.
    ///
    /// # Errors
    /// Entries that are no numbers.
    pub fn margins(&self) -> Result<Option<Margins>, DesignError> {
        if !self.is_stable(1.0)? {
            return Ok(None);
        }
        let grid = Grid::of(self)?;
        let channels = self.b.ncols();
        let single = (0..channels).map(|i| crossing::single(&grid, i)).collect();
        let identity = DMatrix::identity(channels, channels);
        let half = DMatrix::from_diagonal_element(channels, channels, 0.5.into());
        let (disk, frequency_rad_s) = grid.peak(
            |s| disk::upper_bound(&(s - &half)),
            |s| disk::structured_singular_value(&(s - &half)),
        );
        let peak = |of: &(dyn Fn(&Matrix) -> f64 + Sync)| {
            let (value, frequency_rad_s) = grid.peak(of, of);
            Peak {
                value,
                frequency_rad_s,
            }
        };
        Ok(Some(Margins {
            common: crossing::common(self, &grid)?,
            single,
            disk: DiskMargin {
                alpha: 1.0 / disk,
                frequency_rad_s,
            },
            sensitivity: peak(&largest_singular_value),
            complementary: peak(&|s| largest_singular_value(&(&identity - s))),
        }))
    }
}

#[cfg(test)]
mod tests;
