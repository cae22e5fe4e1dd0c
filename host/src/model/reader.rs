//! Reads TOML tables with every complaint at its line and column.

use super::limits::Limits;
use super::source::Source;
use super::suggest::{split_unit, suggest};
use crate::error::{Error, Result};
use std::ops::Range;
use toml_edit::{Item, TableLike, Value};

/// One table of the file, named for messages: `[rig]`, `[[link]] 2`.
pub(crate) struct Table<'a> {
    source: &'a Source<'a>,
    name: String,
    items: &'a dyn TableLike,
    span: Option<Range<usize>>,
}

impl<'a> Table<'a> {
    /// The whole document.
    pub fn root(source: &'a Source<'a>, document: &'a toml_edit::Document<&'a str>) -> Self {
        Table {
            source,
            name: "the file".into(),
            items: document.as_table(),
            span: None,
        }
    }

    /// Refuses every key that is not among `known`.
    ///
    /// # Errors
    /// The first unknown key, with the nearest known one or the unit that is wanted.
    pub fn only(&self, known: &[&str]) -> Result<()> {
        let Some((key, _)) = self.items.iter().find(|(key, _)| !known.contains(key)) else {
            return Ok(());
        };
        let span = self.key_span(key);
        let other_unit = known.iter().find_map(|known| {
            let (stem, unit) = split_unit(known)?;
            let rest = key.strip_prefix(stem)?;
            (rest.is_empty() || rest.starts_with('_')).then_some((known, unit, rest))
        });
        Err(match other_unit {
            Some((known, unit, "")) => self.source.error(
                span,
                format!("key `{key}` does not say its unit"),
                format!("write `{known}`, in {unit}"),
            ),
            Some((known, unit, rest)) => self.source.error(
                span,
                format!("key `{key}` ends in `{rest}`, not in the unit wanted"),
                format!("write `{known}`, in {unit}"),
            ),
            None => self.source.error(
                span,
                format!("unknown key `{key}` in {}", self.name),
                suggest(key, known),
            ),
        })
    }

    /// Whether the key is there.
    pub fn has(&self, key: &str) -> bool {
        self.items.contains_key(key)
    }

    /// The number under `key`, if there is one.
    ///
    /// # Errors
    /// No number, not finite, or outside `limits`.
    pub fn number(&self, key: &str, limits: Limits) -> Result<Option<f64>> {
        let Some(item) = self.items.get(key) else {
            return Ok(None);
        };
        let number = match item.as_value() {
            Some(Value::Float(float)) => *float.value(),
            Some(Value::Integer(integer)) => *integer.value() as f64,
            _ => return Err(self.wrong_type(key, "a number")),
        };
        if !number.is_finite() {
            let what = format!("`{key}` is {number}, which no rig has");
            return Err(self.bad(key, what, limits.wish()));
        }
        if !limits.allow(number) {
            let what = format!("`{key}` = {number} is impossible");
            return Err(self.bad(key, what, limits.wish()));
        }
        Ok(Some(number))
    }

    /// The number under `key`, which must be there.
    ///
    /// # Errors
    /// As [`Table::number`], and when it is absent.
    pub fn required_number(&self, key: &str, limits: Limits) -> Result<f64> {
        self.number(key, limits)?.ok_or_else(|| self.lacks(key))
    }

    /// The whole number from 1 under `key` as an index from 0, if there is one.
    ///
    /// # Errors
    /// Anything but a whole number from 1 to `count`.
    pub fn index(&self, key: &str, count: usize) -> Result<Option<usize>> {
        let Some(item) = self.items.get(key) else {
            return Ok(None);
        };
        let number = item
            .as_integer()
            .ok_or_else(|| self.wrong_type(key, "a whole number"))?;
        match usize::try_from(number) {
            Ok(number) if (1..=count).contains(&number) => Ok(Some(number - 1)),
            _ => Err(self.bad(
                key,
                format!("there is no {key} {number}"),
                format!("{key}s count from 1 to {count} here"),
            )),
        }
    }

    /// The text under `key`, if there is one; never empty.
    ///
    /// # Errors
    /// No text, or empty text.
    pub fn text(&self, key: &str) -> Result<Option<&'a str>> {
        let Some(item) = self.items.get(key) else {
            return Ok(None);
        };
        match item.as_str() {
            Some("") => Err(self.bad(key, format!("`{key}` is empty"), "give it a name")),
            Some(text) => Ok(Some(text)),
            None => Err(self.wrong_type(key, "text in quotes")),
        }
    }

    /// The text under `key`, which must be there.
    ///
    /// # Errors
    /// As [`Table::text`], and when it is absent.
    pub fn required_text(&self, key: &str) -> Result<&'a str> {
        self.text(key)?.ok_or_else(|| self.lacks(key))
    }

    /// The alternative named under `key`, if there is one.
    ///
    /// # Errors
    /// No text, or a name that is not among `choices`.
    pub fn choice<T: Copy>(&self, key: &str, choices: &[(&str, T)]) -> Result<Option<T>> {
        let Some(text) = self.text(key)? else {
            return Ok(None);
        };
        if let Some((_, value)) = choices.iter().find(|(name, _)| *name == text) {
            return Ok(Some(*value));
        }
        let names: Vec<&str> = choices.iter().map(|(name, _)| *name).collect();
        Err(self.bad(
            key,
            format!("`{key}` cannot be `{text}`"),
            suggest(text, &names),
        ))
    }

    /// Whether `key` is true; absent is false.
    ///
    /// # Errors
    /// Anything but `true` or `false`.
    pub fn flag(&self, key: &str) -> Result<bool> {
        match self.items.get(key) {
            None => Ok(false),
            Some(item) => item
                .as_bool()
                .ok_or_else(|| self.wrong_type(key, "true or false")),
        }
    }

    /// The texts of the array under `key`, each with where it stands.
    ///
    /// # Errors
    /// No array, or something in it that is no text.
    #[expect(clippy::type_complexity, reason = "a text and its place")]
    pub fn texts(&self, key: &str) -> Result<Option<Vec<(&'a str, Option<Range<usize>>)>>> {
        let Some(item) = self.items.get(key) else {
            return Ok(None);
        };
        let array = item
            .as_array()
            .ok_or_else(|| self.wrong_type(key, "an array of texts"))?;
        let texts = array.iter().map(|value| match value.as_str() {
            Some(text) => Ok((text, value.span())),
            None => Err(self.source.error(
                value.span(),
                format!("`{key}` holds {}", article(value.type_name())),
                "put text in quotes there",
            )),
        });
        texts.collect::<Result<_>>().map(Some)
    }

    /// The table under `key`, if there is one.
    ///
    /// # Errors
    /// Something else under that key.
    pub fn table(&self, key: &str) -> Result<Option<Table<'a>>> {
        let Some(item) = self.items.get(key) else {
            return Ok(None);
        };
        let items = item
            .as_table_like()
            .ok_or_else(|| self.wrong_type(key, "a table"))?;
        Ok(Some(Table {
            source: self.source,
            name: format!("[{}]", self.child(key)),
            items,
            span: item.span().or_else(|| self.key_span(key)),
        }))
    }

    /// The table under `key`, which must be there.
    ///
    /// # Errors
    /// As [`Table::table`], and when it is absent.
    pub fn required_table(&self, key: &str) -> Result<Table<'a>> {
        self.table(key)?.ok_or_else(|| self.lacks(key))
    }

    /// The tables `[[key]]`; none when absent.
    ///
    /// # Errors
    /// Something else under that key.
    pub fn tables(&self, key: &str) -> Result<Vec<Table<'a>>> {
        let wrong = || self.wrong_type(key, &format!("written as `[[{}]]`", self.child(key)));
        let named = |number: usize, items: &'a dyn TableLike, span| Table {
            source: self.source,
            name: format!("[[{}]] {}", self.child(key), number + 1),
            items,
            span,
        };
        match self.items.get(key) {
            None | Some(Item::None) => Ok(Vec::new()),
            Some(Item::ArrayOfTables(tables)) => Ok(tables
                .iter()
                .enumerate()
                .map(|(i, table)| named(i, table, table.span()))
                .collect()),
            Some(Item::Value(Value::Array(array))) => array
                .iter()
                .enumerate()
                .map(|(i, value)| {
                    let table = value.as_inline_table().ok_or_else(wrong)?;
                    Ok(named(i, table, value.span()))
                })
                .collect(),
            Some(_) => Err(wrong()),
        }
    }

    /// A complaint about the value under `key`.
    pub fn bad(&self, key: &str, what: impl Into<String>, remedy: impl Into<String>) -> Error {
        let item = self.items.get(key).and_then(Item::span);
        let span = item.or_else(|| self.key_span(key));
        self.source.error(span, what, remedy)
    }

    /// A complaint about the key itself.
    pub fn bad_key(&self, key: &str, what: impl Into<String>, remedy: impl Into<String>) -> Error {
        self.source.error(self.key_span(key), what, remedy)
    }

    /// A complaint about the table as a whole.
    pub fn bad_table(&self, what: impl Into<String>, remedy: impl Into<String>) -> Error {
        let what = format!("{} {}", self.name, what.into());
        self.source.error(self.span.clone(), what, remedy)
    }

    /// `key` is missing.
    pub fn lacks(&self, key: &str) -> Error {
        let remedy = match split_unit(key) {
            Some((_, unit)) => format!("add `{key} = ...`, in {unit}"),
            None => format!("add `{key}`"),
        };
        self.bad_table(format!("lacks `{key}`"), remedy)
    }

    fn wrong_type(&self, key: &str, wanted: &str) -> Error {
        let found = self.items.get(key).map_or("none", Item::type_name);
        self.bad(
            key,
            format!("`{key}` is {}", article(found)),
            format!("it must be {wanted}"),
        )
    }

    fn key_span(&self, key: &str) -> Option<Range<usize>> {
        let (key, _) = self.items.get_key_value(key)?;
        key.span().or_else(|| self.span.clone())
    }

    fn child(&self, key: &str) -> String {
        let own = self.name.trim_matches(|c: char| !c.is_alphanumeric());
        if self.name.starts_with('[') {
            format!("{own}.{key}")
        } else {
            key.to_string()
        }
    }
}

fn article(kind: &str) -> String {
    let vowel = kind.starts_with(['a', 'e', 'i', 'o', 'u']);
    format!("{} {kind}", if vowel { "an" } else { "a" })
}
