//! Writes `[[expression]]` tables: laws that a model file defines.

use super::{checked, document, misfit, number};
use crate::effects::expression::LawDefinition;
use crate::error::Result;
use std::path::Path;
use toml_edit::{ArrayOfTables, Item, Table};

/// The text with one more `[[expression]]` at the end of those it has; `path` only names it in
/// errors. A fit of it begins at the first of its starts.
///
/// # Errors
/// The text is no model, it defines a law of this name already, or the law is none.
pub fn add_expression(text: &str, path: &Path, law: &LawDefinition) -> Result<String> {
    let mut document = document(text, path)?;
    let mut table = Table::new();
    table.decor_mut().set_prefix("\n");
    table.insert("name", toml_edit::value(law.name.as_str()));
    table.insert(law.site.key(), toml_edit::value(law.expression.as_str()));
    let mut parameters = ArrayOfTables::new();
    for parameter in &law.parameters {
        let mut own = Table::new();
        let start = parameter.starts.first().copied().unwrap_or_default();
        own.insert("key", toml_edit::value(parameter.key.as_str()));
        own.insert("unit", toml_edit::value(parameter.unit.as_str()));
        own.insert("meaning", toml_edit::value(parameter.meaning.as_str()));
        own.insert("start", Item::Value(number(start)));
        own.insert("low", Item::Value(number(parameter.bounds.0)));
        own.insert("high", Item::Value(number(parameter.bounds.1)));
        parameters.push(own);
    }
    table.insert("parameter", Item::ArrayOfTables(parameters));
    let laws = document
        .entry("expression")
        .or_insert_with(|| Item::ArrayOfTables(ArrayOfTables::new()));
    match laws {
        Item::ArrayOfTables(tables) => tables.push(table),
        _ => return Err(misfit(path, "`expression` is no list of tables")),
    }
    checked(document, path)
}
