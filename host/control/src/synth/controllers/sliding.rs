//! Sliding mode with a boundary layer, sampled.
//!
//! The surface is s = D B'P z = 0 with P the regulator's Riccati matrix and D = (B'PB)^-1, so that
//! s counts in N m. On it the plant's remaining modes are stable. The law reaches it as
//! s(k+1) = (1 - q) s(k) - e sat(s(k) / width): u = -(D B'P A z - (1 - q) s) - e sat(s / width)
//! (Gao, Wang, Homaifa, IEEE Trans. Industrial Electronics 42 (1995) 117, with the sign smoothed to
//! a boundary layer after Slotine, Li, Applied Nonlinear Control (1991), section 7.2).

use super::best::BEST;
use super::observed::{ObservedDesign, Options, by_rows};
use super::plant::with_offsets;
use super::{ControllerDesign, ControllerInfo, DesignModel, Speeds};
use crate::error::{Error, Result};
use crate::sim::closed_loop::state_feedback::dot;
use crate::sim::closed_loop::{Controller, Measurement};
use crate::synth::{Discrete, dlqr, zoh};
use nalgebra::DMatrix;

/// q: share of the distance to the surface that is taken back each sample.
const REACHING: f64 = 0.3;

/// e: largest switched torque, N m.
const SWITCHED_NM: f64 = 0.1;

/// Width of the boundary layer, N m.
const WIDTH_NM: f64 = 0.3;

/// A law on a state: linear, and switched across a surface.
#[derive(Debug, Clone)]
pub(super) struct Surface {
    /// u = -K z.
    k: DMatrix<f64>,
    /// s = S z; none for a plain regulator.
    s: Option<DMatrix<f64>>,
    /// Both by rows.
    k_rows: Vec<f64>,
    s_rows: Vec<f64>,
}

impl Surface {
    /// u = -K z.
    pub fn regulator(k: DMatrix<f64>) -> Self {
        Surface::new(k, None)
    }

    /// Slides on B'P z = 0.
    ///
    /// # Errors
    /// Inputs that do not reach the surface.
    pub fn sliding(plant: &Discrete, riccati: &DMatrix<f64>) -> Result<Self> {
        let bp = plant.b.transpose() * riccati;
        let reach = (&bp * &plant.b).try_inverse();
        let reach = reach.ok_or_else(|| {
            Error::design(
                "the inputs do not reach the sliding surface",
                "drive other joints",
            )
        })?;
        let s = reach * bp;
        let k = &s * &plant.a - (1.0 - REACHING) * &s;
        Ok(Surface::new(k, Some(s)))
    }

    /// The same law on [angles, speeds, offsets, rest]: offsets act as the angles' negatives.
    #[must_use]
    pub fn with_offsets(self, joints: usize) -> Self {
        let spread = |matrix: &DMatrix<f64>| with_offsets(matrix, joints);
        Surface::new(spread(&self.k), self.s.as_ref().map(spread))
    }

    fn new(k: DMatrix<f64>, s: Option<DMatrix<f64>>) -> Self {
        Surface {
            k_rows: by_rows(&k),
            s_rows: s.as_ref().map(by_rows).unwrap_or_default(),
            k,
            s,
        }
    }

    /// Torques for a state.
    #[inline]
    pub fn torque(&self, state: &[f64], command_nm: &mut [f64]) {
        for (torque, row) in command_nm
            .iter_mut()
            .zip(self.k_rows.chunks_exact(state.len()))
        {
            *torque = -dot(row, state);
        }
        for (torque, row) in command_nm
            .iter_mut()
            .zip(self.s_rows.chunks_exact(state.len()))
        {
            *torque -= SWITCHED_NM * (dot(row, state) / WIDTH_NM).clamp(-1.0, 1.0);
        }
    }
}

/// Sliding mode on angles and true speeds, given the equilibrium.
#[derive(Debug)]
pub struct Sliding;

static INFO: ControllerInfo = ControllerInfo {
    id: "sliding",
    title: "sliding mode with boundary layer",
    law: "u = -K x - e sat(S x / width)",
    speeds: Speeds::True,
    known_equilibrium: true,
    reference: REFERENCE,
};

const REFERENCE: &str =
    "Gao, Wang, Homaifa (1995); Slotine, Li (1991); the paper, section V (future work)";

/// On the estimate, with offsets, delay and dead-zone inverse.
pub const OBSERVED: ObservedDesign = ObservedDesign {
    info: ControllerInfo {
        id: "sliding-observed",
        title: "sliding mode on the estimate",
        law: "u = inverse(-K z - e sat(S z / width))",
        speeds: Speeds::Estimated,
        known_equilibrium: false,
        reference: REFERENCE,
    },
    options: Options {
        sliding: true,
        // Its torques saturate: delays that it does not know do not fell it, and a bound costs it
        // 6 % of the robots under everything at once.
        largest_start: f64::INFINITY,
        ..BEST.options
    },
};

impl ControllerDesign for Sliding {
    fn info(&self) -> &ControllerInfo {
        &INFO
    }

    fn build(&self, known: &DesignModel) -> Result<Box<dyn Controller>> {
        let plant = zoh(&known.plant, known.period_s, 0.0)?;
        let (q, r) = known.weights()?;
        let surface = Surface::sliding(&plant, &dlqr(&plant, &q, &r)?.riccati)?;
        Ok(Box::new(Direct { surface }))
    }
}

/// The law on angles and speeds as read.
#[derive(Debug)]
struct Direct {
    surface: Surface,
}

impl Controller for Direct {
    fn memory_len(&self) -> usize {
        self.surface.k.ncols()
    }

    fn control(&self, memory: &mut [f64], measured: Measurement<'_>, command_nm: &mut [f64]) {
        let (angles, speeds) = memory.split_at_mut(measured.angle_rad.len());
        angles.copy_from_slice(measured.angle_rad);
        speeds.copy_from_slice(measured.speed_rad_s);
        self.surface.torque(memory, command_nm);
    }
}
