//! Why a TOML file is refused: the data, its sentence, and the remedy.

use super::limits::Limits;
use super::suggest::suggest;
use crate::effects::split_unit;
use crate::error::Reason;
use std::borrow::Cow;
use std::fmt;

/// What is wrong with the syntax, a key, or a value of a TOML file.
#[derive(Debug, Clone, PartialEq)]
pub enum TomlReason {
    /// Not TOML.
    Syntax {
        /// The parser's message.
        message: String,
    },
    /// A key that the table does not have.
    UnknownKey {
        /// The key found.
        key: String,
        /// The table, as `[[link]] 1`.
        table: String,
        /// The keys that it has.
        known: Vec<String>,
    },
    /// A required key is absent.
    MissingKey {
        /// The key.
        key: String,
        /// The table, as `[[link]] 1`.
        table: String,
    },
    /// A value of another type.
    WrongType {
        /// Its key.
        key: String,
        /// The type found, as `integer`.
        found: &'static str,
        /// What it must be, as `a number`.
        expected: String,
    },
    /// An element of an array of texts is of another type.
    NoText {
        /// Key of the array.
        key: String,
        /// The type found.
        found: &'static str,
    },
    /// An empty text.
    EmptyText {
        /// Its key.
        key: String,
    },
    /// A number outside its range, or not finite.
    OutOfRange {
        /// Its key.
        key: String,
        /// The number found.
        value: f64,
        /// Its range.
        limits: Limits,
    },
    /// A number with a fraction where a whole one is required.
    NotWhole {
        /// Its key.
        key: String,
        /// The number found.
        value: f64,
    },
    /// A name that is not among the alternatives.
    UnknownName {
        /// Its key.
        key: String,
        /// The name found.
        found: String,
        /// The alternatives.
        known: Vec<String>,
    },
    /// A count from 1 beyond what there is.
    NoSuchIndex {
        /// Its key, which is also what it counts.
        key: String,
        /// The number found.
        number: i64,
        /// How many there are.
        count: usize,
    },
}

use TomlReason::*;

impl fmt::Display for TomlReason {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Syntax { message } => write!(f, "not TOML: {message}"),
            UnknownKey { key, table, known } => match other_unit(key, known) {
                Some((.., "")) => write!(f, "key `{key}` does not say its unit"),
                Some((.., end)) => write!(f, "key `{key}` ends in `{end}`, not in the unit wanted"),
                None => write!(f, "unknown key `{key}` in {table}"),
            },
            MissingKey { key, table } => write!(f, "{table} lacks `{key}`"),
            WrongType { key, found, .. } => write!(f, "`{key}` is {}", with_article(found)),
            NoText { key, found } => write!(f, "`{key}` holds {}", with_article(found)),
            EmptyText { key } => write!(f, "`{key}` is empty"),
            OutOfRange { key, value, .. } if value.is_finite() => {
                write!(f, "`{key}` = {value} is impossible")
            }
            OutOfRange { key, value, .. } => write!(f, "`{key}` is {value}, which no rig has"),
            NotWhole { key, value } => write!(f, "`{key}` = {value} is not whole"),
            UnknownName { key, found, .. } => write!(f, "`{key}` cannot be `{found}`"),
            NoSuchIndex { key, number, .. } => write!(f, "there is no {key} {number}"),
        }
    }
}

impl Reason for TomlReason {
    fn remedy(&self) -> Cow<'_, str> {
        Cow::Owned(match self {
            Syntax { .. } => {
                "write `key = value` lines under `[table]` headings; text needs quotes".into()
            }
            UnknownKey { key, known, .. } => match other_unit(key, known) {
                Some((known, unit, _)) => format!("write `{known}`, in {unit}"),
                None => suggest(key, known),
            },
            MissingKey { key, .. } => match split_unit(key) {
                Some((_, unit)) => format!("add `{key} = ...`, in {unit}"),
                None => format!("add `{key}`"),
            },
            WrongType { expected, .. } => format!("it must be {expected}"),
            NoText { .. } => "put text in quotes there".into(),
            EmptyText { .. } => "give it a name".into(),
            OutOfRange { limits, .. } => format!("give a number {limits}"),
            NotWhole { .. } => "give a whole number".into(),
            UnknownName { found, known, .. } => suggest(found, known),
            NoSuchIndex { key, count, .. } => format!("{key}s count from 1 to {count} here"),
        })
    }
}

/// The known key that has this stem, its unit, and what `key` ends in instead.
fn other_unit<'a>(key: &'a str, known: &'a [String]) -> Option<(&'a str, &'static str, &'a str)> {
    known.iter().find_map(|known| {
        let (stem, unit) = split_unit(known)?;
        let end = key.strip_prefix(stem)?;
        (end.is_empty() || end.starts_with('_')).then_some((known.as_str(), unit, end))
    })
}

fn with_article(kind: &str) -> String {
    let vowel = kind.starts_with(['a', 'e', 'i', 'o', 'u']);
    format!("{} {kind}", if vowel { "an" } else { "a" })
}
