//! `[uncertainty]` beside values that a fit changes.

use super::{checked, document, misfit, number};
use crate::error::Result;
use crate::model::parse::uncertainty::{GIVEN_KEY, UNCERTAINTY_KEY};
use crate::model::{Model, ParameterPath, UncertainValue};
use std::path::Path;
use toml_edit::{InlineTable, Item};

/// The text with what its owner believed of these values written beside their uncertainty, where
/// `known` still takes it for known; of the others the owner believes what the file will say.
/// Values that a fit changes stay priors about what was believed, not about the fit before.
///
/// # Errors
/// The text is no model.
pub fn keep_given(
    text: &str,
    path: &Path,
    values: &[ParameterPath],
    known: &Model,
) -> Result<String> {
    let model = Model::parse(text, path)?;
    let mut uncertain = model.uncertain.clone();
    uncertain.retain(|value| values.contains(&value.path));
    if uncertain.is_empty() {
        return Ok(text.to_string());
    }
    let mut document = document(text, path)?;
    let section = document.get_mut("uncertainty");
    let section = section.and_then(Item::as_table_like_mut);
    let section = section.ok_or_else(|| misfit(path, "`uncertainty` is no table"))?;
    for value in uncertain {
        // A robot in space may have it under names.
        let is_own = |key: &str| ParameterPath::read(key, &model).is_ok_and(|p| p == value.path);
        let own = section.iter().map(|(key, _)| key.to_string());
        let own = own.into_iter().find(|key| is_own(key));
        let key = own.unwrap_or_else(|| value.path.to_string());
        section.insert(&key, toml_edit::value(entry(&value, known)));
    }
    checked(document, path)
}

fn entry(value: &UncertainValue, known: &Model) -> toml_edit::Value {
    let uncertainty = number(value.uncertainty);
    if known.uncertain(value.path).is_none() {
        return uncertainty;
    }
    let mut table = InlineTable::new();
    table.insert(UNCERTAINTY_KEY, uncertainty);
    table.insert(GIVEN_KEY, number(value.given));
    table.into()
}
