//! `[uncertainty]`: what is known beforehand of values that may still be off.

use super::fit::{infinite, twice, value_at};
use crate::error::Result;
use crate::model::limits::Limits;
use crate::model::reader::Table;
use crate::model::{Model, ParameterPath, UncertainValue};

/// Below a thousandth nothing moves, and beyond its own size nothing is known.
const UNCERTAINTY: Limits = Limits::within(1e-6, 1.0);
const GIVEN: Limits = Limits::within(-1e6, 1e6);
/// The key that gives every value without one of its own what is typical of its kind.
pub(in crate::model) const TYPICAL: &str = "typical";
/// Keys of a value whose owner believed in another number than the file has now.
pub(in crate::model) const UNCERTAINTY_KEY: &str = "uncertainty";
pub(in crate::model) const GIVEN_KEY: &str = "given";

/// What the section says; nothing where there is none. What `[fit]` frees has no prior, unless it
/// is a value of an effect with one of its own here.
pub(super) fn read(root: &Table, model: &Model) -> Result<Vec<UncertainValue>> {
    let Some(section) = root.table("uncertainty")? else {
        return Ok(Vec::new());
    };
    let mut uncertain: Vec<UncertainValue> = Vec::new();
    for key in section.keys().into_iter().filter(|key| *key != TYPICAL) {
        let (path, value) = value_at(&section, key, section.key_span(key), model)?;
        let is_link_or_joint = !matches!(path, ParameterPath::Effect { .. });
        if !value.is_finite() {
            return Err(infinite(key).at(section.place_of(key)));
        }
        if uncertain.iter().any(|known| known.path == path) {
            return Err(twice(key).at(section.place_of_key(key)));
        }
        if is_link_or_joint && model.free.contains(&path) {
            return Err(section.bad_key(
                key,
                format!("`{key}` is free, and so it can have no uncertainty"),
                "free is what is not known beforehand: keep it under `[fit] free`, or here",
            ));
        }
        uncertain.push(one(&section, key, path, value)?);
    }
    if section.flag(TYPICAL)? {
        let known: Vec<ParameterPath> = uncertain.iter().map(|known| known.path).collect();
        let mut typical = model.typically_uncertain();
        typical.retain(|value| !known.contains(&value.path) && !model.free.contains(&value.path));
        uncertain.extend(typical);
    }
    Ok(uncertain)
}

/// One value: its uncertainty, or a table of that and of what was believed.
fn one(section: &Table, key: &str, path: ParameterPath, value: f64) -> Result<UncertainValue> {
    if !section.is_table(key) {
        return Ok(UncertainValue {
            path,
            given: value,
            uncertainty: section.required_number(key, UNCERTAINTY)?,
        });
    }
    let own = section.required_table(key)?;
    own.only(&[UNCERTAINTY_KEY, GIVEN_KEY])?;
    Ok(UncertainValue {
        path,
        given: own.number(GIVEN_KEY, GIVEN)?.unwrap_or(value),
        uncertainty: own.required_number(UNCERTAINTY_KEY, UNCERTAINTY)?,
    })
}
