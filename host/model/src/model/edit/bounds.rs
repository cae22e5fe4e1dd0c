//! Bounds within which values are fitted, under `[fit.bounds]`.

use super::{checked, document, misfit};
use crate::error::Result;
use crate::model::{Model, ParameterPath};
use std::path::Path;
use toml_edit::{Array, DocumentMut, Item, Table, TableLike};

/// The text with these bounds, `None` for those that are lifted; `path` only names it in errors.
///
/// # Errors
/// The text is no model, has no such value, the bounds leave no room, or the value lies outside.
pub fn set_bounds(
    text: &str,
    path: &Path,
    bounds: &[(ParameterPath, Option<(f64, f64)>)],
) -> Result<String> {
    let model = Model::parse(text, path)?;
    let mut document = document(text, path)?;
    let is_needless = |bounds: Option<&dyn TableLike>| bounds.is_none_or(|table| table.is_empty());
    let table = table(&mut document).ok_or_else(|| misfit(path, "`fit.bounds` is no table"))?;
    for (address, bounds) in bounds {
        let key = address.to_string();
        // A robot in space may have it under names.
        let is_other = |own: &str| {
            own != key && ParameterPath::read(own, &model).is_ok_and(|own| own == *address)
        };
        let keys = table.iter().map(|(own, _)| own.to_string());
        for other in keys.filter(|own| is_other(own)).collect::<Vec<_>>() {
            table.remove(&other);
        }
        match bounds {
            Some((low, high)) => {
                let ends = Array::from_iter([*low, *high]);
                table.insert(&key, toml_edit::value(ends));
            }
            None => {
                table.remove(&key);
            }
        }
    }
    let fit = document.get_mut("fit").and_then(Item::as_table_like_mut);
    if let Some(fit) = fit
        && is_needless(fit.get("bounds").and_then(Item::as_table_like))
    {
        fit.remove("bounds");
        if fit.is_empty() {
            document.remove("fit");
        }
    }
    checked(document, path)
}

/// The table of bounds, made where there is none.
fn table(document: &mut DocumentMut) -> Option<&mut dyn TableLike> {
    let fit = document
        .entry("fit")
        .or_insert_with(|| Item::Table(Table::new()));
    let fit = fit.as_table_like_mut()?;
    if fit.get("bounds").is_none() {
        fit.insert("bounds", Item::Table(Table::new()));
    }
    fit.get_mut("bounds")?.as_table_like_mut()
}
