//! The fixed-point law in the loop: what the board computes, bit for bit, if its words have 16 bits.

use crate::closed_loop::state_feedback::remember;
use crate::closed_loop::{Controller, Seen};
use crate::synth::FixedLaw;

/// A law on angles and speeds, and on past torques if it has columns for them.
#[derive(Debug, Clone)]
pub(super) struct FixedController {
    law: FixedLaw,
    /// Numbers of past torques.
    past: usize,
}

impl FixedController {
    /// `measured` states come from sensors, the others are past torques.
    pub(super) fn new(law: FixedLaw, measured: usize) -> Self {
        FixedController {
            past: law.state_step.len() - measured,
            law,
        }
    }
}

impl Controller for FixedController {
    fn memory_len(&self) -> usize {
        self.past
    }

    fn control(&self, memory: &mut [f64], seen: Seen<'_>, torque_nm: &mut [f64]) {
        let x = [seen.angle_rad, seen.speed_rad_s, memory].concat();
        torque_nm.copy_from_slice(&self.law.control(&x));
        remember(memory, torque_nm);
    }
}
