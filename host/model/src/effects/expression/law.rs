//! A user's law as an effect: a torque on the joint, given as an expression.

use super::super::{AtRest, Effect, EffectInfo, JointState, Slope};
use exmex::{Express, FlatEx};

/// Most values of an effect.
pub const MOST_VALUES: usize = 4;
/// Steps of the differences that linearise a law, rad and rad/s.
const STEP: f64 = 1e-6;
/// Slopes on either side that differ by more have no derivative between them.
const SMOOTH: f64 = 1e-3;

/// What a variable of the expression is filled with.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Slot {
    Angle,
    Speed,
    Drive,
    Value(usize),
}

/// An expression, ready to be evaluated.
#[derive(Debug)]
pub(super) struct Compiled {
    pub expression: FlatEx<f64>,
    /// In the order of the expression's variables.
    pub slots: Vec<Slot>,
}

/// A law of the user's.
#[derive(Debug)]
pub(super) struct ExpressionLaw {
    pub info: &'static EffectInfo,
    pub compiled: Compiled,
}

impl Compiled {
    /// The torque, N m; not a number where the expression has no value.
    pub fn value(&self, values: &[f64], at: &JointState) -> f64 {
        let mut variables = [0.0; MOST_VALUES + 3];
        let count = self.slots.len();
        for (variable, slot) in variables.iter_mut().zip(&self.slots) {
            *variable = match *slot {
                Slot::Angle => at.angle_rad,
                Slot::Speed => at.speed_rad_s,
                Slot::Drive => at.drive_nm,
                Slot::Value(index) => values.get(index).copied().unwrap_or(f64::NAN),
            };
        }
        self.expression
            .eval(&variables[..count])
            .unwrap_or(f64::NAN)
    }
}

impl Effect for ExpressionLaw {
    fn info(&self) -> &'static EffectInfo {
        self.info
    }

    fn is_users(&self) -> bool {
        true
    }

    fn torque(&self, values: &[f64], at: &JointState) -> f64 {
        self.compiled.value(values, at)
    }

    /// By differences, where both sides agree; none where the drive's torque enters.
    fn slope(&self, values: &[f64], at: &AtRest) -> Option<Slope> {
        if self.compiled.slots.contains(&Slot::Drive) {
            return None;
        }
        let torque = |angle: f64, speed: f64| {
            let state = JointState::undriven(at.angle_rad + angle, speed);
            self.compiled.value(values, &state)
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
