//! A user's law as an effect: a torque or a friction of the joint, given as an expression.

use super::super::{AtRest, FrictionState, JointState, Law, Slope};
use super::LawSite;
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
    pub site: LawSite,
}

impl Law for ExpressionLaw {
    fn is_users(&self) -> bool {
        true
    }

    fn torque(&self, values: &[f64], at: &JointState) -> f64 {
        match self.site {
            LawSite::Torque => self.program.value(values, &at.into()),
            LawSite::Friction => 0.0,
        }
    }

    /// What of it would push is no friction.
    fn friction(&self, values: &[f64], at: &FrictionState) -> f64 {
        match self.site {
            LawSite::Torque => 0.0,
            LawSite::Friction => self.program.value(values, &at.into()),
        }
    }

    /// By differences, where both sides agree; none where the drive enters, and of friction.
    fn slope(&self, values: &[f64], at: &AtRest) -> Option<Slope> {
        let drives = [Slot::Drive, Slot::Input].map(|slot| self.program.has(slot));
        if self.site == LawSite::Friction || drives.contains(&true) {
            return None;
        }
        let torque = |angle: f64, speed: f64| {
            let state = JointState::undriven(at.angle_rad + angle, speed);
            self.program.value(values, &(&state).into())
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
