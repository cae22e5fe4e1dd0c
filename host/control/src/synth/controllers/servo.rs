//! The servo between command and torque, and the regulator that has it in its model.

use super::observed::{ObservedDesign, Options};
use super::{ControllerInfo, Speeds};
use crate::sim::closed_loop::{Controller, Measurement};

/// A servo's answer to a command, sampled: y(k) = sum b_i u(k-i) - sum a_i y(k-i), of gain 1 at
/// rest.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ServoLag {
    /// b_1.
    pub b: f64,
    /// a_1 and a_2.
    pub a: [f64; 2],
}

impl ServoLag {
    /// The paper's equation 2, 0.06217 z / (z^2 - 1.469 z + 0.5544) at 10 ms, scaled to gain 1:
    /// from commanded to effective torque as from commanded to actual speed. Its pole pair lies at
    /// 34 ms.
    pub const PAPER: ServoLag = ServoLag {
        b: 1.0 - 1.469 + 0.5544,
        a: [-1.469, 0.5544],
    };

    /// The next two states [y(k+1), -a_2 y(k)] under a command.
    #[inline]
    pub fn next(&self, state: [f64; 2], command: f64) -> [f64; 2] {
        [
            self.b * command - self.a[0] * state[0] + state[1],
            -self.a[1] * state[0],
        ]
    }
}

/// A controller whose commands reach the robot through such servos.
#[derive(Debug)]
pub struct ThroughServos<'a> {
    /// The controller.
    pub inner: Box<dyn Controller + 'a>,
    /// Its servos.
    pub servo: ServoLag,
    /// How many.
    pub drives: usize,
    /// The servos take no larger commands, N m.
    pub limit_nm: f64,
}

impl Controller for ThroughServos<'_> {
    fn memory_len(&self) -> usize {
        self.inner.memory_len() + 2 * self.drives
    }

    fn reset(&self, memory: &mut [f64]) {
        let (servos, inner) = memory.split_at_mut(2 * self.drives);
        servos.fill(0.0);
        self.inner.reset(inner);
    }

    fn control(&self, memory: &mut [f64], measured: Measurement<'_>, command_nm: &mut [f64]) {
        let (servos, inner) = memory.split_at_mut(2 * self.drives);
        self.inner.control(inner, measured, command_nm);
        for (torque, state) in command_nm.iter_mut().zip(servos.chunks_exact_mut(2)) {
            let command = torque.clamp(-self.limit_nm, self.limit_nm);
            *torque = state[0];
            state.copy_from_slice(&self.servo.next([state[0], state[1]], command));
        }
    }
}

/// The regulator with servo, delay and offsets in its model.
pub const SERVO_MODEL: ObservedDesign = ObservedDesign {
    info: ControllerInfo {
        id: "servo-model",
        title: "LQG with the servo in its model",
        law: "u = -K [x, servo, past u], all estimated",
        speeds: Speeds::Estimated,
        known_equilibrium: false,
        reference: "the paper, equation 2 and section V (future work)",
    },
    options: Options {
        offsets: true,
        delay: true,
        servo: true,
        ..Options::PAPER
    },
};
