//! A user's law as an effect: a torque on the joint, given as an expression.

use super::super::{AtRest, JointState, Law, Slope};
use super::program::{Program, Slot};

/// Most values of an effect.
pub const MOST_VALUES: usize = 4;
/// Steps of the differences that linearise a law, rad and rad/s.
const STEP: f64 = 1e-6;
/// Slopes on either side that differ by more have no derivative between them.
const SMOOTH: f64 = 1e-3;

/// A law of the user's.
#[derive(Debug)]
pub(super) struct ExpressionLaw {
    pub program: Program,
}

impl Law for ExpressionLaw {
    fn is_users(&self) -> bool {
        true
    }

    fn torque(&self, values: &[f64], at: &JointState) -> f64 {
        self.program.value(values, at)
    }

    /// By differences, where both sides agree; none where the drive's torque enters.
    fn slope(&self, values: &[f64], at: &AtRest) -> Option<Slope> {
        if self.program.has(Slot::Drive) {
            return None;
        }
        let torque = |angle: f64, speed: f64| {
            let state = JointState::undriven(at.angle_rad + angle, speed);
            self.program.value(values, &state)
        };
        let here = torque(0.0, 0.0);
        let derivative = |ahead: f64, behind: f64| {
            let (right, left) = ((ahead - here) / STEP, (here - behind) / STEP);
            let size = right.abs().max(left.abs()).max(1e-6);
            ((right - left).abs() <= SMOOTH * size).then_some(0.5 * (right + left))
        };
        Some(Slope {
            per_rad: derivative(torque(STEP, 0.0), torque(-STEP, 0.0))?,
            per_rad_s: derivative(torque(0.0, STEP), torque(0.0, -STEP))?,
            ..Slope::NONE
        })
    }
}
