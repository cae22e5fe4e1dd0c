//! Writes effects and values into a model file's text; comments and layout stay.

use super::path::ParameterPath;
use super::{EffectInstance, Model};
use crate::error::{Error, Place, Result};
use std::path::Path;
use toml_edit::{Array, ArrayOfTables, DocumentMut, InlineTable, Item, Table, TableLike, Value};

/// How an effect's values came about, written as `[effect.fitted]`.
#[derive(Debug, Clone, PartialEq)]
pub struct Fitted {
    /// Key of the parameter, and the interval's low and high end in its unit.
    pub intervals: Vec<(String, f64, f64)>,
    /// Name and SHA-256 of every log it was fitted to.
    pub logs: Vec<(String, String)>,
    /// Error without the effect, in `error_unit`.
    pub error_before: f64,
    /// Error with the effect, in `error_unit`.
    pub error_after: f64,
    /// Unit of both errors: `rad`.
    pub error_unit: String,
}

/// The text with one more `[[effect]]` at the end of those it has; `path` only names it in errors.
///
/// Where `[fit]` names what is free, the effect's values join that list, so that later fits and diagnoses refit
/// them; without such a list the values of all effects are free anyway.
///
/// # Errors
/// The text is no model, it holds the effect at that joint already, or the effect does not suit it.
pub fn add_effect(
    text: &str,
    path: &Path,
    effect: &EffectInstance,
    fitted: Option<&Fitted>,
) -> Result<String> {
    Model::parse(text, path)?;
    let mut document = document(text, path)?;
    let mut table = Table::new();
    table.decor_mut().set_prefix("\n");
    let card = effect.effect.card();
    table.insert("kind", toml_edit::value(card.id));
    if let Some(joint) = effect.joint {
        table.insert("joint", toml_edit::value(joint as i64 + 1));
    }
    for (parameter, value) in card.parameters.iter().zip(&effect.values) {
        table.insert(parameter.key, Item::Value(number(*value)));
    }
    if let Some(fitted) = fitted {
        table.insert("fitted", Item::Table(provenance(fitted)));
    }
    let effects = document
        .entry("effect")
        .or_insert_with(|| Item::ArrayOfTables(ArrayOfTables::new()));
    match effects {
        Item::ArrayOfTables(tables) => tables.push(table),
        Item::Value(Value::Array(array)) => array.push(table.into_inline_table()),
        _ => return Err(misfit(path, "`effect` is no list of tables")),
    }
    set_free(&mut document, effect);
    checked(document, path)
}

/// The text with these values in place of the old ones, rounded to six digits.
///
/// # Errors
/// The text is no model, has no such parameter, or a value is impossible there.
pub fn set_values(text: &str, path: &Path, values: &[(ParameterPath, f64)]) -> Result<String> {
    let model = Model::parse(text, path)?;
    let mut document = document(text, path)?;
    for (parameter, value) in values {
        let table = parameter
            .get(&model)
            .and_then(|_| owner(&mut document, *parameter))
            .ok_or_else(|| misfit(path, &format!("there is no `{parameter}`")))?;
        put(table, parameter.key(), number(*value));
    }
    checked(document, path)
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
        Err(Error::Data { what, remedy, .. }) => Err(Error::data(Place::file(path), what, remedy)),
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

/// The table that holds the parameter.
fn owner(document: &mut DocumentMut, path: ParameterPath) -> Option<&mut dyn TableLike> {
    match path {
        ParameterPath::Link { index, .. } => tables(document.get_mut("link")?).nth(index),
        ParameterPath::Joint { index, .. } => tables(document.get_mut("joint")?).nth(index),
        ParameterPath::Effect { id, joint, .. } => tables(document.get_mut("effect")?).find(|t| {
            let at = t.get("joint").and_then(Item::as_integer);
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

/// Adds the effect's values to the list of free ones, if there is one, in the list's own layout.
fn set_free(document: &mut DocumentMut, effect: &EffectInstance) {
    let list = document
        .get_mut("fit")
        .and_then(Item::as_table_like_mut)
        .and_then(|fit| fit.get_mut("free"))
        .and_then(Item::as_array_mut);
    let Some(list) = list else {
        return;
    };
    let values = ParameterPath::of_effect(effect).zip(&effect.values);
    for (path, _) in values.filter(|(_, value)| value.is_finite()) {
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

fn provenance(fitted: &Fitted) -> Table {
    let mut table = Table::new();
    let mut intervals = InlineTable::new();
    for (key, low, high) in &fitted.intervals {
        intervals.insert(
            key,
            Value::Array([number(*low), number(*high)].into_iter().collect()),
        );
    }
    let mut logs = Array::new();
    for (name, sha256) in &fitted.logs {
        let mut log = InlineTable::new();
        log.insert("name", name.as_str().into());
        log.insert("sha256", sha256.as_str().into());
        logs.push(log);
    }
    table.insert("intervals", toml_edit::value(intervals));
    table.insert("logs", toml_edit::value(logs));
    table.insert("error_before", Item::Value(number(fitted.error_before)));
    table.insert("error_after", Item::Value(number(fitted.error_after)));
    table.insert("error_unit", toml_edit::value(fitted.error_unit.as_str()));
    table
}

/// The number with six significant digits, with an exponent where zeros would be counted.
fn number(value: f64) -> Value {
    let rounded: f64 = format!("{value:.5e}").parse().unwrap_or(value);
    format!("{rounded:?}")
        .parse()
        .unwrap_or_else(|_| rounded.into())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::effects;

    const MODEL: &str = include_str!("testdata/full.toml");

    fn path() -> &'static Path {
        Path::new("full.toml")
    }

    fn effect(id: &str, joint: usize, value: f64) -> EffectInstance {
        EffectInstance {
            effect: effects::named(id).unwrap(),
            joint: Some(joint),
            values: vec![value],
        }
    }

    fn fitted() -> Fitted {
        Fitted {
            intervals: vec![("torque_nm".into(), 0.018, 0.022)],
            logs: vec![("drop \"1\".csv".into(), "ab12".into())],
            error_before: 0.012_345_678,
            error_after: 0.0021,
            error_unit: "rad".into(),
        }
    }

    #[test]
    fn an_added_effect_is_there_and_every_old_line_too() {
        let added = effect("coulomb", 1, 0.019_876_543_2);
        let text = add_effect(MODEL, path(), &added, Some(&fitted())).unwrap();
        let model = Model::parse(&text, path()).unwrap();
        let last = model.effects.last().unwrap();
        assert_eq!(last.effect.card().id, "coulomb");
        assert_eq!((last.joint, last.values[0]), (Some(1), 0.019_876_5));
        let mut lines = text.lines();
        for old in MODEL.lines().filter(|line| !line.starts_with("free")) {
            assert!(lines.any(|line| line == old), "kept in order: {old}");
        }
        assert!(text.contains(
            "[[effect]]\nkind = \"coulomb\"\njoint = 2\ntorque_nm = 0.0198765\n\n[effect.fitted]\n"
        ));
        assert!(text.contains("error_before = 0.0123457\n"), "{text}");
        assert!(
            text.contains("intervals = { torque_nm = [0.018, 0.022] }\n"),
            "{text}"
        );
    }

    #[test]
    fn an_added_effect_is_free_where_the_model_lists_what_is() {
        let old = r#"["link1.inertia_kg_m2", "joint2.gain_per_rad", "coulomb@1.torque_nm"]"#;
        let one = "[\n  \"link1.com_m\", # of the bob\n]";
        for (list, said) in [
            (old, r#"torque_nm", "coulomb@2.torque_nm"]"#),
            ("[]", r#"free = ["coulomb@2.torque_nm"]"#),
            (
                one,
                "\"link1.com_m\", # of the bob\n  \"coulomb@2.torque_nm\",\n]\n",
            ),
            (
                "[\n  \"link1.com_m\" # of the bob\n]",
                "\"link1.com_m\", # of the bob\n  \"coulomb@2.torque_nm\"\n]\n",
            ),
            (
                "[\n  # none yet\n]",
                "# none yet\n\"coulomb@2.torque_nm\"\n]\n",
            ),
        ] {
            let bare = MODEL.replace(old, list);
            let text = add_effect(&bare, path(), &effect("coulomb", 1, 0.02), None).unwrap();
            assert!(text.contains(said), "{text}");
            let model = Model::parse(&text, path()).unwrap();
            let last = model.free.last().map(ToString::to_string);
            assert_eq!(last.as_deref(), Some("coulomb@2.torque_nm"), "{text}");
        }
    }

    #[test]
    fn the_first_effect_of_a_file_gets_its_heading() {
        let start = MODEL.find("[[effect]]").unwrap();
        let end = MODEL.find("[fit]").unwrap();
        let log = MODEL.find("[log]").unwrap();
        assert!(end < log);
        let bare = format!("{}{}", &MODEL[..start], &MODEL[log..]);
        let text = add_effect(&bare, path(), &effect("delay", 1, 0.03), None).unwrap();
        assert!(text.starts_with(&bare), "{text}");
        assert_eq!(Model::parse(&text, path()).unwrap().effects.len(), 1);
    }

    #[test]
    fn effects_that_do_not_suit_the_model_are_refused() {
        for (effect, what) in [
            (effect("coulomb", 0, 0.1), "there twice"),
            (effect("delay", 0, 0.1), "driven joints only"),
            (effect("coulomb", 5, 0.1), "no joint 6"),
            (effect("coulomb", 1, -0.1), "impossible"),
            (effect("coulomb", 1, f64::NAN), "NaN"),
        ] {
            let error = add_effect(MODEL, path(), &effect, None).unwrap_err();
            assert!(error.to_string().contains(what), "{error}");
        }
    }

    #[test]
    fn set_values_change_only_their_numbers() {
        let values: Vec<(ParameterPath, f64)> = [
            ("link1.com_m", 0.101_234_567),
            ("joint2.gain_per_rad", 9.5),
            ("coulomb@1.torque_nm", 1.234_567_89e-7),
            ("link2.length_m", 0.2),
        ]
        .map(|(text, value)| (text.parse().unwrap(), value))
        .to_vec();
        let text = set_values(MODEL, path(), &values).unwrap();
        assert!(text.contains("com_m = 0.101235 # weighed on a knife edge\n"));
        assert!(text.contains("torque_nm = 1.23457e-7 # felt by hand\n"));
        let model = Model::parse(&text, path()).unwrap();
        for (path, value) in &values {
            let found = path.get(&model).unwrap();
            assert!((found / value - 1.0).abs() < 1e-5, "{path}: {found}");
        }
        assert_eq!(text.lines().count(), MODEL.lines().count() + 1);
        assert_eq!(set_values(MODEL, path(), &[]).unwrap(), MODEL);
    }

    #[test]
    fn values_with_no_place_or_impossible_are_refused() {
        for (parameter, value, what) in [
            ("coulomb@2.torque_nm", 0.1, "no `coulomb@2.torque_nm`"),
            ("link3.mass_kg", 0.1, "no `link3.mass_kg`"),
            ("joint1.stall_torque_nm", 0.1, "no `joint1"),
            ("link1.mass_kg", -0.1, "impossible"),
            ("link1.mass_kg", f64::INFINITY, "inf"),
        ] {
            let values = [(parameter.parse().unwrap(), value)];
            let error = set_values(MODEL, path(), &values).unwrap_err();
            assert!(error.to_string().contains(what), "{error}");
        }
    }
}
