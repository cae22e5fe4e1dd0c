//! The inverse of a dead zone.
//!
//! Commands within the zone do nothing, so none is sent: a raw command below half of the least one
//! that passes in every robot becomes 0, one above becomes that least command, and the difference
//! is carried to the next sample. On average over a few samples the torque is the raw command: a
//! first-order sigma-delta modulator, whose error lies at frequencies the robot's inertia swallows.

use super::paper;
use super::{ControllerDesign, ControllerInfo, DesignModel, Speeds};
use crate::error::Result;
use crate::sim::closed_loop::{Controller, Measurement, StateFeedback};
use crate::synth::rows;

/// Commands this much beyond the nominal zone pass every robot's own zone, which may differ by a
/// fifth.
const SURELY: f64 = 1.21;

/// The drive as a controller believes it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct AssumedDrive {
    /// Least command that surely passes, N m; 0 without a dead zone.
    pub least_nm: f64,
    /// Largest torque, N m.
    pub limit_nm: f64,
}

impl AssumedDrive {
    /// From what is known.
    pub fn of(known: &DesignModel) -> Self {
        AssumedDrive {
            least_nm: SURELY * known.dead_zone_nm,
            limit_nm: known.limit_nm,
        }
    }

    /// The applied command for a raw one; the torque it gives is the same number. `carry` is the
    /// difference so far.
    #[inline]
    pub fn command(&self, raw_nm: f64, carry_nm: &mut f64) -> f64 {
        if self.least_nm == 0.0 {
            *carry_nm = 0.0;
            return raw_nm.clamp(-self.limit_nm, self.limit_nm);
        }
        let owed = raw_nm + *carry_nm;
        let half = self.least_nm / 2.0;
        let applied = if owed.abs() < half {
            0.0
        } else {
            let size = owed.abs().max(self.least_nm).min(self.limit_nm);
            size.copysign(owed)
        };
        // What the limit holds back is not owed: it would come when it is no longer wanted.
        *carry_nm = (owed - applied).clamp(-half, half);
        applied
    }
}

/// A controller whose commands pass the dead zone.
#[derive(Debug)]
struct Inverted<C> {
    inner: C,
    drive: AssumedDrive,
    drives: usize,
}

impl<C: Controller> Controller for Inverted<C> {
    fn memory_len(&self) -> usize {
        self.drives + self.inner.memory_len()
    }

    fn reset(&self, memory: &mut [f64]) {
        let (carry, inner) = memory.split_at_mut(self.drives);
        carry.fill(0.0);
        self.inner.reset(inner);
    }

    fn control(&self, memory: &mut [f64], measured: Measurement<'_>, command_nm: &mut [f64]) {
        let (carry, inner) = memory.split_at_mut(self.drives);
        self.inner.control(inner, measured, command_nm);
        for (torque, carry) in command_nm.iter_mut().zip(carry) {
            *torque = self.drive.command(*torque, carry);
        }
    }
}

/// The paper's regulator behind the inverse.
#[derive(Debug)]
pub struct DeadZoneInverse;

static INFO: ControllerInfo = ControllerInfo {
    id: "dead-zone-inverse",
    title: "DLQR with dead-zone inverse",
    law: "u = inverse(-K (x - x_balance))",
    speeds: Speeds::True,
    known_equilibrium: true,
    reference: "Tao, Kokotovic, Adaptive Control of Systems with Actuator and Sensor \
                Nonlinearities (1996)",
};

impl ControllerDesign for DeadZoneInverse {
    fn info(&self) -> &ControllerInfo {
        &INFO
    }

    fn build(&self, known: &DesignModel) -> Result<Box<dyn Controller>> {
        Ok(Box::new(Inverted {
            inner: StateFeedback::new(known.joints(), rows(&paper::gain(known)?)),
            drive: AssumedDrive::of(known),
            drives: known.drives(),
        }))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const DRIVE: AssumedDrive = AssumedDrive {
        least_nm: 0.25,
        limit_nm: 2.0,
    };

    #[test]
    fn no_command_falls_into_the_zone_and_the_mean_is_the_wish() {
        for raw in [-0.2, -0.03, 0.01, 0.1, 0.124, 0.2, 0.7] {
            let mut carry = 0.0;
            let applied: Vec<f64> = (0..1000).map(|_| DRIVE.command(raw, &mut carry)).collect();
            assert!(applied.iter().all(|g| *g == 0.0 || g.abs() >= 0.25));
            let mean = applied.iter().sum::<f64>() / 1000.0;
            assert!((mean - raw).abs() < 1e-3, "{raw}: {mean}");
        }
    }

    #[test]
    fn the_limit_leaves_no_debt() {
        let mut carry = 0.0;
        for _ in 0..100 {
            assert_eq!(DRIVE.command(5.0, &mut carry), 2.0);
        }
        assert!(carry <= 0.125);
    }
}
