//! Values that motions tell only relative to the masses of the file.
//!
//! Every torque, force, mass and moment of inertia of a rig multiplied by one factor leaves each
//! acceleration what it was. So angles alone never tell that factor: something must set it whose
//! size is known apart from the motion. A logged torque does, a motor's stall torque that the file
//! gives, an effect's value that the file gives, and a mass that its owner has measured. Where
//! only masses and inertias of the file do, every value that was fitted is as right as they are.

use super::findings::Diagnosis;
use super::names::{listed, value_name};
use super::values::values_of;
use crate::fitting::FittedValue;
use crate::model::{Drive, LinkField, Model, ParameterPath};

/// Warns of fitted values that are known only relative to masses and inertias of the file; `known`
/// are values of the file that were measured.
pub(super) fn warning(
    diagnosis: &Diagnosis,
    model: &Model,
    known: &[ParameterPath],
) -> Option<String> {
    let effects = diagnosis.effects.iter();
    let added = effects.flat_map(|effect| &effect.parameters);
    let fitted: Vec<&FittedValue> = diagnosis.base.iter().chain(added).collect();
    let scaling = fitted.iter().filter(|value| scales(&value.unit));
    let scaling: Vec<String> = scaling.map(|value| value.path.clone()).collect();
    let is_fitted = |path: &ParameterPath| scaling.contains(&path.to_string());
    let references = references(model, known, &is_fitted)?;
    let first = references.first()?;
    let masses = match references.as_slice() {
        [_] | [_, _] => {
            let names = references.iter().map(|path| value_name(&path.to_string()));
            listed(names.collect())
        }
        _ => "the masses and inertias of the links".to_string(),
    };
    let (scale, they) = match scaling.len() {
        0 => return None,
        1 => ("scales", "it"),
        _ => ("scale", "they"),
    };
    Some(format!(
        "{} {scale} with {masses}, which these logs do not determine: with twice the mass {they} \
         would be twice as large, and the motion the same. Weigh what moves, put it into the file, \
         and say so by `--known {first}`",
        listed(scaling)
    ))
}

/// The masses and inertias of the file that alone set the scale of all torques; none where
/// something else does.
fn references(
    model: &Model,
    known: &[ParameterPath],
    is_fitted: &dyn Fn(&ParameterPath) -> bool,
) -> Option<Vec<ParameterPath>> {
    // A law of the user's may hold a torque that is no value.
    let mut effects = model.effects.iter();
    let is_set = model
        .joints
        .iter()
        .any(|joint| joint.drive == Drive::Torque)
        || known.iter().any(|path| scales(path.unit()))
        || effects.any(|effect| effect.effect.is_users());
    let mut given = values_of(model);
    given.retain(|path| scales(path.unit()) && path.get(model) != Some(0.0) && !is_fitted(path));
    let inertial = |path: &ParameterPath| {
        let fields = [LinkField::Mass, LinkField::Inertia];
        matches!(path, ParameterPath::Link { field, .. } if fields.contains(field))
    };
    (!is_set && given.iter().all(inertial)).then_some(given)
}

/// Whether a value of this unit is multiplied when all torques, forces and masses are.
fn scales(unit: &str) -> bool {
    unit.starts_with('N') || unit.starts_with("kg")
}

#[cfg(test)]
mod tests;
