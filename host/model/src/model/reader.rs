//! Reads TOML tables: each refused key or value with its line and column.
//!
//! Read by hand over `toml_edit`, not derived with `serde`. A trial with `toml` 1 and
//! `serde_path_to_error` gave table, line and column for plain structs. Inside tables with a tag it
//! did not, because serde buffers what stands beside the tag and forgets the spans: a wrong
//! `stall_torque_nm` of the second `[[joint]]` was reported at the first one's heading, and a
//! passive joint's was accepted in silence. Joints, effects (whose keys come from their
//! description) and columns (whose keys come from their dimension) are such tables: 35 of the 68
//! refusals in `parse/tests.rs` that are not of syntax. They would need visitors of their own, and
//! the other 33 their reason picked out of serde's English sentence: by estimate as much code as
//! this file has.

use super::limits::Limits;
use super::source::TomlSource;
use super::suggest::suggest;
use crate::effects::split_unit;
use crate::error::{Error, Place, Result};
use std::ops::Range;
use toml_edit::{Item, TableLike, Value};

/// One table of the file, named for messages: `[rig]`, `[[link]] 2`.
pub struct Table<'a> {
    source: &'a TomlSource<'a>,
    /// How messages call it.
    pub name: String,
    items: &'a dyn TableLike,
    span: Option<Range<usize>>,
}

impl<'a> Table<'a> {
    /// The whole document.
    pub fn root(source: &'a TomlSource<'a>, document: &'a toml_edit::Document<&'a str>) -> Self {
        Table {
            source,
            name: "the file".into(),
            items: document.as_table(),
            span: None,
        }
    }

    /// Refuses every key that is not among `known`.
    pub fn only(&self, known: &[&str]) -> Result<()> {
        match self.items.iter().find(|(key, _)| !known.contains(key)) {
            None => Ok(()),
            Some((key, _)) => {
                let (what, remedy) = match other_unit(key, known) {
                    Some((known, unit, end)) => (
                        match end {
                            "" => format!("key `{key}` does not say its unit"),
                            end => format!("key `{key}` ends in `{end}`, not in the unit wanted"),
                        },
                        format!("write `{known}`, in {unit}"),
                    ),
                    None => (
                        format!("unknown key `{key}` in {}", self.name),
                        suggest(key, known),
                    ),
                };
                Err(self.bad_key(key, what, remedy))
            }
        }
    }

    /// Whether the key is there.
    pub fn has(&self, key: &str) -> bool {
        self.items.contains_key(key)
    }

    /// What `read` makes of the item under `key`, if there is one; refused as not `expected` if it
    /// makes nothing of it.
    fn get<T>(
        &self,
        key: &str,
        expected: &str,
        read: impl FnOnce(&'a Item) -> Option<T>,
    ) -> Result<Option<T>> {
        let Some(item) = self.items.get(key) else {
            return Ok(None);
        };
        read(item).map(Some).ok_or_else(|| {
            self.bad(
                key,
                format!("`{key}` is {}", with_article(item.type_name())),
                format!("it must be {expected}"),
            )
        })
    }

    /// The value read from `key`, which must be there.
    pub fn required<T>(&self, key: &str, value: Option<T>) -> Result<T> {
        value.ok_or_else(|| self.lacks(key))
    }

    /// The number under `key`, if there is one: finite and within `limits`.
    pub fn number(&self, key: &str, limits: Limits) -> Result<Option<f64>> {
        let number = self.get(key, "a number", |item| {
            let whole = || item.as_integer().map(|integer| integer as f64);
            item.as_float().or_else(whole)
        })?;
        match number.filter(|number| !limits.allow(*number)) {
            None => Ok(number),
            Some(value) => {
                let what = if value.is_finite() {
                    format!("`{key}` = {value} is impossible")
                } else {
                    format!("`{key}` is {value}, which no rig has")
                };
                Err(self.bad(key, what, format!("give a number {limits}")))
            }
        }
    }

    /// The number under `key`, which must be there.
    pub fn required_number(&self, key: &str, limits: Limits) -> Result<f64> {
        self.required(key, self.number(key, limits)?)
    }

    /// The whole number under `key`, if there is one.
    pub fn whole(&self, key: &str, limits: Limits) -> Result<Option<f64>> {
        match self.number(key, limits)? {
            Some(value) if value.fract() != 0.0 => Err(self.bad(
                key,
                format!("`{key}` = {value} is not whole"),
                "give a whole number",
            )),
            number => Ok(number),
        }
    }

    /// The whole number from 1 to `count` under `key` as an index from 0, if there is one.
    pub fn index(&self, key: &str, count: usize) -> Result<Option<usize>> {
        let Some(number) = self.get(key, "a whole number", Item::as_integer)? else {
            return Ok(None);
        };
        match usize::try_from(number) {
            Ok(index @ 1..) if index <= count => Ok(Some(index - 1)),
            _ => Err(self.bad(
                key,
                format!("there is no {key} {number}"),
                format!("{key}s count from 1 to {count} here"),
            )),
        }
    }

    /// Whether this text stands under `key`.
    pub fn is_text(&self, key: &str, text: &str) -> bool {
        self.items.get(key).and_then(Item::as_str) == Some(text)
    }

    /// The text under `key`, if there is one; never empty.
    pub fn text(&self, key: &str) -> Result<Option<&'a str>> {
        match self.get(key, "text in quotes", Item::as_str)? {
            Some("") => Err(self.bad(key, format!("`{key}` is empty"), "give it a name")),
            text => Ok(text),
        }
    }

    /// The text under `key`, which must be there.
    pub fn required_text(&self, key: &str) -> Result<&'a str> {
        self.required(key, self.text(key)?)
    }

    /// The alternative named under `key`, if there is one.
    pub fn choice<T: Copy>(&self, key: &str, choices: &[(&str, T)]) -> Result<Option<T>> {
        let Some(text) = self.text(key)? else {
            return Ok(None);
        };
        match choices.iter().find(|(name, _)| *name == text) {
            Some((_, value)) => Ok(Some(*value)),
            None => {
                let known: Vec<&str> = choices.iter().map(|(name, _)| *name).collect();
                let what = format!("`{key}` cannot be `{text}`");
                Err(self.bad(key, what, suggest(text, &known)))
            }
        }
    }

    /// Whether `key` is true; absent is false.
    pub fn flag(&self, key: &str) -> Result<bool> {
        let flag = self.get(key, "true or false", Item::as_bool)?;
        Ok(flag.unwrap_or(false))
    }

    /// The texts of the array under `key`, each with its span.
    #[expect(clippy::type_complexity, reason = "a text and its span")]
    pub fn texts(&self, key: &str) -> Result<Option<Vec<(&'a str, Option<Range<usize>>)>>> {
        let Some(array) = self.get(key, "an array of texts", Item::as_array)? else {
            return Ok(None);
        };
        let texts = array.iter().map(|value| {
            value
                .as_str()
                .map(|text| (text, value.span()))
                .ok_or_else(|| {
                    Error::data(
                        self.place(value.span()),
                        format!("`{key}` holds {}", with_article(value.type_name())),
                        "put text in quotes there",
                    )
                })
        });
        texts.collect::<Result<_>>().map(Some)
    }

    /// The numbers of the list under `key`, row by row: a list of numbers, or of such lists.
    pub fn rows(&self, key: &str) -> Result<Option<Vec<Vec<f64>>>> {
        let numbers =
            |value: &Value| -> Option<Vec<f64>> { value.as_array()?.iter().map(number).collect() };
        let rows = |item: &Item| {
            let value = item.as_value()?;
            let row = numbers(value).map(|row| vec![row]);
            row.or_else(|| value.as_array()?.iter().map(numbers).collect())
        };
        self.get(key, "a list of numbers, or of such lists", rows)
    }

    /// The two numbers under `key`, the first one `-inf` and the second one `inf` at most.
    pub fn pair(&self, key: &str) -> Result<Option<(f64, f64)>> {
        self.get(key, "two numbers, as `[0.1, 0.2]`", |item| {
            let array = item.as_array().filter(|array| array.len() == 2)?;
            Some((number(array.get(0)?)?, number(array.get(1)?)?))
        })
    }

    /// Its keys, in the file's order.
    pub fn keys(&self) -> Vec<&'a str> {
        self.items.iter().map(|(key, _)| key).collect()
    }

    /// Whether the item under `key` is a list.
    pub fn is_list(&self, key: &str) -> bool {
        let item = self.items.get(key);
        item.is_some_and(|item| item.is_array() || item.is_array_of_tables())
    }

    /// Whether the item under `key` is a table.
    pub fn is_table(&self, key: &str) -> bool {
        self.items.get(key).is_some_and(Item::is_table_like)
    }

    /// The table under `key`, if there is one.
    pub fn table(&self, key: &str) -> Result<Option<Table<'a>>> {
        let table = self.get(key, "a table", |item| Some((item, item.as_table_like()?)))?;
        Ok(table.map(|(item, items)| Table {
            source: self.source,
            name: format!("[{}]", self.child(key)),
            items,
            span: item.span().or_else(|| self.key_span(key)),
        }))
    }

    /// The table under `key`, which must be there.
    pub fn required_table(&self, key: &str) -> Result<Table<'a>> {
        self.required(key, self.table(key)?)
    }

    /// The tables `[[key]]` or `key = [{...}]`; none when absent.
    pub fn tables(&self, key: &str) -> Result<Vec<Table<'a>>> {
        let child = self.child(key);
        let expected = format!("written as `[[{child}]]`");
        let tables = self.get(key, &expected, |item| match item {
            Item::None => Some(Vec::new()),
            Item::ArrayOfTables(tables) => {
                let tables = tables
                    .iter()
                    .map(|table| (table as &dyn TableLike, table.span()));
                Some(tables.collect())
            }
            Item::Value(Value::Array(array)) => array
                .iter()
                .map(|value| Some((value.as_inline_table()? as &dyn TableLike, value.span())))
                .collect(),
            _ => None,
        })?;
        let named = |(number, (items, span))| Table {
            source: self.source,
            name: format!("[[{child}]] {}", number + 1),
            items,
            span,
        };
        Ok(tables
            .into_iter()
            .flatten()
            .enumerate()
            .map(named)
            .collect())
    }

    /// Refuses the value under `key`.
    pub fn bad(&self, key: &str, what: impl Into<String>, remedy: impl Into<String>) -> Error {
        Error::data(self.place_of(key), what, remedy)
    }

    /// Refuses the key itself.
    pub fn bad_key(&self, key: &str, what: impl Into<String>, remedy: impl Into<String>) -> Error {
        Error::data(self.place_of_key(key), what, remedy)
    }

    /// Refuses the table as a whole.
    pub fn bad_table(&self, what: impl Into<String>, remedy: impl Into<String>) -> Error {
        Error::data(self.place(self.span.clone()), what, remedy)
    }

    /// `key` is missing.
    pub fn lacks(&self, key: &str) -> Error {
        let remedy = match split_unit(key) {
            Some((_, unit)) => format!("add `{key} = ...`, in {unit}"),
            None => format!("add `{key}`"),
        };
        self.bad_table(format!("{} lacks `{key}`", self.name), remedy)
    }

    /// Where `span` begins.
    pub fn place(&self, span: Option<Range<usize>>) -> Place {
        self.source.place(span)
    }

    /// Where the value under `key` stands.
    pub fn place_of(&self, key: &str) -> Place {
        let value = self.items.get(key).and_then(Item::span);
        self.place(value.or_else(|| self.key_span(key)))
    }

    /// Where a character of the text under `key` stands, counted from 0.
    pub fn place_of_character(&self, key: &str, at: usize) -> Place {
        let value = self.items.get(key).and_then(Item::span);
        self.place(value.map(|value| self.source.character(value, at)))
    }

    /// Where the key stands.
    pub fn place_of_key(&self, key: &str) -> Place {
        self.place(self.key_span(key))
    }

    /// What its key spans.
    pub fn key_span(&self, key: &str) -> Option<Range<usize>> {
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

/// A number, whole or not.
fn number(value: &Value) -> Option<f64> {
    let whole = || value.as_integer().map(|integer| integer as f64);
    value.as_float().or_else(whole)
}

/// The known key that has this stem, its unit, and what `key` ends in instead.
fn other_unit<'k>(key: &'k str, known: &[&'k str]) -> Option<(&'k str, &'static str, &'k str)> {
    known.iter().find_map(|known| {
        let (stem, unit) = split_unit(known)?;
        let end = key.strip_prefix(stem)?;
        (end.is_empty() || end.starts_with('_')).then_some((*known, unit, end))
    })
}

fn with_article(kind: &str) -> String {
    let vowel = kind.starts_with(['a', 'e', 'i', 'o', 'u']);
    format!("{} {kind}", if vowel { "an" } else { "a" })
}
