//! Writes effects, values and how logs are read into a model file's text; comments and layout stay.

mod reading;

pub use reading::{changed_lines, set_reading};

mod bounds;
mod columns;
mod expression;
mod provenance;
mod robot;
#[cfg(test)]
mod tests;
mod uncertainty;

pub use bounds::set_bounds;
pub use columns::{ChosenColumn, ColumnChoice, set_log_columns};
pub use expression::add_expression;
pub use provenance::{FitRecord, renew_provenance};
pub use robot::{robot_file, set_robot_file};
pub use uncertainty::keep_given;

use super::field::{JOINT_INERTIA, LinkField};
use super::path::ParameterPath;
use super::{EffectInstance, Model};
use crate::effects::Scope;
use crate::error::{Error, Place, Result};
use std::path::Path;
use toml_edit::{Array, ArrayOfTables, DocumentMut, Item, Table, TableLike, Value};

/// The text with one more `[[effect]]` at the end of those it has; `path` only names it in errors.
///
/// Where `[fit]` names what is free, the effect's values join that list, so that later fits and
/// diagnoses refit them; without such a list the values of all effects are free anyway.
///
/// # Errors
/// The text is no model, it holds the effect at that joint already, or the effect does not suit it.
pub fn add_effect(
    text: &str,
    path: &Path,
    effect: &EffectInstance,
    fitted: Option<&FitRecord>,
) -> Result<String> {
    Model::parse(text, path)?;
    let mut document = document(text, path)?;
    let mut table = Table::new();
    table.decor_mut().set_prefix("\n");
    let info = effect.effect.info();
    table.insert("kind", toml_edit::value(info.id));
    match effect.joint {
        Some(joint) => {
            table.insert("joint", toml_edit::value(joint as i64 + 1));
        }
        None if info.scope != Scope::WholeRig => {
            table.insert("joint", toml_edit::value("all"));
        }
        None => {}
    }
    for (parameter, value) in info.parameters.iter().zip(&effect.values) {
        table.insert(parameter.key, Item::Value(number(*value)));
    }
    if let Some(fitted) = fitted {
        table.insert(
            "fitted",
            Item::Table(fitted.table(|path| path.key().to_string())),
        );
    }
    let effects = document
        .entry("effect")
        .or_insert_with(|| Item::ArrayOfTables(ArrayOfTables::new()));
    match effects {
        Item::ArrayOfTables(tables) => tables.push(table),
        Item::Value(Value::Array(array)) => array.push(table.into_inline_table()),
        _ => return Err(misfit(path, "`effect` is no list of tables")),
    }
    set_free(&mut document, effect, fitted);
    checked(document, path)
}

/// The text with these values in place of the old ones, rounded to six digits.
///
/// # Errors
/// The text is no model, has no such parameter, or a value is impossible there.
pub fn set_values(text: &str, path: &Path, values: &[(ParameterPath, f64)]) -> Result<String> {
    with_values(text, path, values, number)
}

/// As [`set_values`], with every digit: what is read back is what was set.
///
/// # Errors
/// As [`set_values`].
pub fn set_values_exactly(
    text: &str,
    path: &Path,
    values: &[(ParameterPath, f64)],
) -> Result<String> {
    with_values(text, path, values, Value::from)
}

fn with_values(
    text: &str,
    path: &Path,
    values: &[(ParameterPath, f64)],
    written: fn(f64) -> Value,
) -> Result<String> {
    let model = Model::parse(text, path)?;
    let mut document = document(text, path)?;
    for (parameter, value) in values {
        let table = parameter
            .get(&model)
            .and_then(|_| owner(&mut document, *parameter, &model))
            .ok_or_else(|| misfit(path, &format!("there is no `{parameter}`")))?;
        if let ParameterPath::Link { index, .. } = parameter {
            about_centre_of_mass(table, model.links[*index].inertia_kg_m2);
        }
        put(table, parameter.key(), written(*value));
    }
    checked(document, path)
}

/// The text of a model from beside one file as it is to stand beside another: where their folders
/// differ, it names a robot's file by its whole path.
///
/// # Errors
/// The text is no model.
pub fn moved(text: &str, from: &Path, to: &Path) -> Result<String> {
    let folder = |path: &Path| {
        std::path::absolute(path)
            .ok()?
            .parent()
            .map(Path::to_path_buf)
    };
    let mut document = document(text, from)?;
    let robot = document.get_mut("rig").and_then(|rig| rig.get_mut("robot"));
    let named = robot.as_ref().and_then(|robot| robot.as_str());
    let (Some(named), Some(home)) = (named.map(str::to_string), folder(from)) else {
        return Ok(text.to_string());
    };
    if folder(to) == Some(home.clone()) || Path::new(&named).is_absolute() {
        return Ok(text.to_string());
    }
    if let Some(robot) = robot {
        *robot = toml_edit::value(home.join(named).display().to_string());
    }
    Ok(document.to_string())
}

/// The text with this integration step, s.
///
/// # Errors
/// The text is no model, or the step is impossible.
pub fn set_step(text: &str, path: &Path, step_s: f64) -> Result<String> {
    let mut document = document(text, path)?;
    let rig = document.get_mut("rig").and_then(Item::as_table_like_mut);
    let rig = rig.ok_or_else(|| misfit(path, "there is no `rig`"))?;
    put(rig, "step_s", number(step_s));
    checked(document, path)
}

/// A moment about the joint as that about the centre of mass, which is what a fit changes or keeps.
fn about_centre_of_mass(table: &mut dyn TableLike, inertia_kg_m2: f64) {
    if table.remove(JOINT_INERTIA).is_some() {
        put(table, LinkField::Inertia.key(), number(inertia_kg_m2));
    }
}

fn document(text: &str, path: &Path) -> Result<DocumentMut> {
    text.parse()
        .map_err(|error: toml_edit::TomlError| misfit(path, error.message()))
}

/// The document as text, if it is still a model.
fn checked(document: DocumentMut, path: &Path) -> Result<String> {
    let text = document.to_string();
    match Model::parse(&text, path) {
        Ok(_) => Ok(text),
        // Its line is one of a text that will not be written.
        Err(Error::Data { problem, .. }) => Err(problem.at(Place::file(path))),
        Err(error) => Err(error),
    }
}

fn misfit(path: &Path, what: &str) -> Error {
    Error::data(
        Place::file(path),
        what,
        "name a parameter or effect of this model file",
    )
}

/// The table that holds the parameter of a model.
fn owner<'a>(
    document: &'a mut DocumentMut,
    path: ParameterPath,
    model: &Model,
) -> Option<&'a mut dyn TableLike> {
    match path {
        ParameterPath::Link { index, .. } => match &model.robot {
            Some(robot) => robot::link_named(document, robot.links.get(index)?),
            None => tables(document.get_mut("link")?).nth(index),
        },
        ParameterPath::Joint { index, .. } => tables(document.get_mut("joint")?).nth(index),
        ParameterPath::Effect { id, joint, .. } => tables(document.get_mut("effect")?).find(|t| {
            // Neither a number stands there where it acts on all, nor where it acts on the rig.
            let at = t.get("joint");
            let named = at
                .and_then(Item::as_str)
                .and_then(|name| model.joint_named(name));
            let at = at
                .and_then(Item::as_integer)
                .or(named.map(|joint| joint as i64 + 1));
            t.get("kind").and_then(Item::as_str) == Some(id) && at == joint.map(|j| j as i64 + 1)
        }),
    }
}

/// The tables of `[[name]]` or `name = [{...}]`.
fn tables(item: &mut Item) -> Box<dyn Iterator<Item = &mut dyn TableLike> + '_> {
    match item {
        Item::ArrayOfTables(tables) => {
            Box::new(tables.iter_mut().map(|table| table as &mut dyn TableLike))
        }
        Item::Value(Value::Array(array)) => Box::new(
            array
                .iter_mut()
                .filter_map(Value::as_inline_table_mut)
                .map(|table| table as &mut dyn TableLike),
        ),
        _ => Box::new(std::iter::empty()),
    }
}

/// Replaces the value and keeps what is written around it.
fn put(table: &mut dyn TableLike, key: &str, mut value: Value) {
    match table.get_mut(key).and_then(Item::as_value_mut) {
        Some(old) => {
            *value.decor_mut() = old.decor().clone();
            *old = value;
        }
        None => {
            table.insert(key, Item::Value(value));
        }
    }
}

/// Adds the effect's values, those that were fitted where some were, to the list of free ones, if
/// there is one, in the list's own layout.
fn set_free(document: &mut DocumentMut, effect: &EffectInstance, fitted: Option<&FitRecord>) {
    let list = document
        .get_mut("fit")
        .and_then(Item::as_table_like_mut)
        .and_then(|fit| fit.get_mut("free"))
        .and_then(Item::as_array_mut);
    let Some(list) = list else {
        return;
    };
    let is_fitted = |path: &ParameterPath| {
        fitted.is_none_or(|record| record.intervals.iter().any(|(own, ..)| own == path))
    };
    let values = ParameterPath::of_effect(effect).zip(&effect.values);
    for (path, _) in values.filter(|(path, value)| value.is_finite() && is_fitted(path)) {
        append(list, &path.to_string());
    }
}

/// One more entry, begun as the last one; comments stay with the entries they follow.
fn append(list: &mut Array, text: &str) {
    let mut begin = match list.len() {
        0 => "",
        _ => " ",
    };
    let mut between = String::new();
    let trailing = list.trailing().as_str().unwrap_or_default().to_string();
    let last = list
        .len()
        .checked_sub(1)
        .and_then(|last| list.get_mut(last));
    let prefix = last
        .as_ref()
        .and_then(|last| last.decor().prefix()?.as_str());
    let prefix = prefix.unwrap_or_default().to_string();
    if let Some(line) = prefix.rfind('\n') {
        begin = &prefix[line..];
    }
    if let Some(last) = last {
        let after = last.decor().suffix().and_then(|after| after.as_str());
        between.push_str(after.unwrap_or_default().trim_end());
        last.decor_mut().set_suffix("");
    }
    if trailing.contains('#') {
        let end = trailing.rfind('\n').unwrap_or(0);
        between.push_str(&trailing[..end]);
        list.set_trailing(&trailing[end..]);
    } else if begin.starts_with('\n') && !trailing.contains('\n') {
        list.set_trailing("\n");
    }
    let mut value = Value::from(text);
    if between.contains('#') && !begin.starts_with('\n') {
        begin = "\n";
    }
    value.decor_mut().set_prefix(format!("{between}{begin}"));
    list.push_formatted(value);
}

/// The number with six significant digits, with an exponent where zeros would be counted.
fn number(value: f64) -> Value {
    let rounded: f64 = format!("{value:.5e}").parse().unwrap_or(value);
    format!("{rounded:?}")
        .parse()
        .unwrap_or_else(|_| rounded.into())
}
