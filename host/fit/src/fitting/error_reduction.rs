//! Errors of a model: before a change of the model, after it, and of a perfect model.

use crate::model::MeasuredSignal;
use serde::{Serialize, Serializer};

/// How far a change of the model reduces its error: root-mean-square, all joints and motions
/// together.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct ErrorReduction {
    /// What the errors are of: the unit that all of them are in, with those of motions, parts and
    /// candidates.
    #[serde(rename = "error_unit", serialize_with = "as_unit")]
    pub quantity: MeasuredSignal,
    /// Error before, in that unit, rad where angles are measured: of the model as it was given.
    pub before_rad: f64,
    /// Error of the same model with its free values refitted; absent where that was not asked.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub refitted_rad: Option<f64>,
    /// Error after.
    pub after_rad: f64,
    /// What noise and resolution of the measurement alone leave.
    pub floor_rad: f64,
    /// Its 95 % interval; absent where it is the rounding of a known resolution.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub floor_interval_rad: Option<[f64; 2]>,
    /// Whether the figures are of motions that took no part in the fit.
    pub held_out: bool,
    /// 95 % interval of the relative reduction, 1 - after / before, by block bootstrap; absent
    /// where it was not asked.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub reduction: Option<[f64; 2]>,
}

fn as_unit<S: Serializer>(quantity: &MeasuredSignal, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.serialize_str(quantity.unit())
}
