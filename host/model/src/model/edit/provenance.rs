//! Where fitted values came from: `[effect.fitted]` beside an effect's values, `[fit.fitted]` for
//! those of links and drives.

use super::{checked, document, misfit, number, owner};
use crate::error::Result;
use crate::model::{Model, ParameterPath};
use std::path::Path;
use toml_edit::{Array, InlineTable, Item, Table, TableLike, Value};

/// How values came about.
#[derive(Debug, Clone, PartialEq)]
pub struct FitRecord {
    /// Address, and the 95 % interval's low and high end in the value's unit.
    pub intervals: Vec<(ParameterPath, f64, f64)>,
    /// Name and SHA-256 of every log they were fitted to.
    pub logs: Vec<(String, String)>,
    /// Error before: without the effect that was added, or of the model as it was; in `error_unit`.
    pub error_before: f64,
    /// Error after, in `error_unit`.
    pub error_after: f64,
    /// Unit of both errors: `rad`.
    pub error_unit: String,
    /// The longest windows of the fit that were asked for, s; none where whole motions were.
    pub horizon_s: Option<f64>,
}

impl FitRecord {
    /// The part of it that is about some of the values.
    pub fn about(&self, wanted: impl Fn(ParameterPath) -> bool) -> FitRecord {
        let mut part = self.clone();
        part.intervals.retain(|(path, ..)| wanted(*path));
        part
    }

    /// As a table; `key` names a value in it.
    pub(super) fn table(&self, key: impl Fn(ParameterPath) -> String) -> Table {
        let mut table = Table::new();
        let mut intervals = InlineTable::new();
        for (path, low, high) in &self.intervals {
            let ends = [number(*low), number(*high)].into_iter().collect();
            intervals.insert(key(*path), Value::Array(ends));
        }
        let mut logs = Array::new();
        for (name, sha256) in &self.logs {
            let mut log = InlineTable::new();
            log.insert("name", name.as_str().into());
            log.insert("sha256", sha256.as_str().into());
            logs.push(log);
        }
        table.insert("intervals", toml_edit::value(intervals));
        table.insert("logs", toml_edit::value(logs));
        table.insert("error_before", Item::Value(number(self.error_before)));
        table.insert("error_after", Item::Value(number(self.error_after)));
        table.insert("error_unit", toml_edit::value(self.error_unit.as_str()));
        if let Some(horizon_s) = self.horizon_s {
            table.insert("horizon_s", Item::Value(number(horizon_s)));
        }
        table
    }
}

/// The text with the record in place of what it said of the origin of these values: beside each
/// effect whose values it names, and once for those of links and drives.
///
/// # Errors
/// The text is no model, or has no such value.
pub fn renew_provenance(text: &str, path: &Path, record: &FitRecord) -> Result<String> {
    let model = Model::parse(text, path)?;
    let mut document = document(text, path)?;
    for effect in &model.effects {
        let paths: Vec<ParameterPath> = ParameterPath::of_effect(effect).collect();
        let own = record.about(|path| paths.contains(&path));
        let Some((first, ..)) = own.intervals.first() else {
            continue;
        };
        let table = owner(&mut document, *first, &model)
            .ok_or_else(|| misfit(path, &format!("there is no `{first}`")))?;
        replace(table, own.table(|path| path.key().to_string()));
    }
    let rest = record.about(|path| !matches!(path, ParameterPath::Effect { .. }));
    if !rest.intervals.is_empty() {
        let fit = document.entry("fit").or_insert_with(|| {
            let mut table = Table::new();
            table.set_implicit(true);
            Item::Table(table)
        });
        let fit = fit
            .as_table_like_mut()
            .ok_or_else(|| misfit(path, "`fit` is no table"))?;
        replace(fit, rest.table(|path| path.to_string()));
    }
    checked(document, path)
}

/// Puts a table under `fitted`, where the old one stood.
fn replace(holder: &mut dyn TableLike, new: Table) {
    match holder.get_mut("fitted").and_then(Item::as_table_mut) {
        Some(old) => {
            old.clear();
            for (key, item) in new {
                old.insert(&key, item);
            }
        }
        None => {
            holder.insert("fitted", Item::Table(new));
        }
    }
}
