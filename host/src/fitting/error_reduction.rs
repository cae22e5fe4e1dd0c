//! Position errors, rad: before a change of the model, after it, and of a perfect model.

use serde::Serialize;

/// How far a change of the model reduces its error: root-mean-square, all joints and motions
/// together.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct ErrorReduction {
    /// Error before, rad: of the model as it was given.
    pub before_rad: f64,
    /// Error of the same model with its free values refitted, rad; absent where that was not asked.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub refitted_rad: Option<f64>,
    /// Error after, rad.
    pub after_rad: f64,
    /// What noise and resolution of the measurement alone leave, rad.
    pub floor_rad: f64,
    /// Whether the figures are of motions that took no part in the fit.
    pub held_out: bool,
    /// 95 % interval of the relative reduction, 1 - after / before, by block bootstrap; absent
    /// where it was not asked.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub reduction: Option<[f64; 2]>,
}
