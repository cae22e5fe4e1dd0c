//! What a data set calls the elements of a list of numbers.

use super::info::found;
use crate::error::{Error, Place, Result};
use serde_json::Value;
use std::path::Path;

/// Most elements of a list; a table has no more columns either.
const MOST: u64 = 4096;

/// The names of a list's elements, in their order.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ElementNames {
    /// How many elements the list has.
    pub count: usize,
    /// One each; or others, as `["motors"]` for six of them, where they are no names of elements.
    pub names: Vec<String>,
}

impl ElementNames {
    /// The names of a feature; none where it gives none.
    ///
    /// LeRobot writes a list of names, or an object of one such list (`{"motors": [..]}`), or of
    /// the place of each name (`{"x": 0, "y": 1}`).
    ///
    /// # Errors
    /// A shape that is no list's, and names that are none of these.
    pub(super) fn of(list: &str, feature: &Value, file: &Path) -> Result<Option<ElementNames>> {
        let wrong = |key: &str, value: Option<&Value>, remedy: &str| {
            let what = format!("features[{list:?}].{key}: {}", found(value));
            Error::data(Place::file(file), what, remedy)
        };
        let shape = feature.get("shape");
        let sizes = shape.and_then(Value::as_array).map(Vec::as_slice);
        let count = match sizes {
            Some([size]) => size.as_u64().filter(|size| (1..=MOST).contains(size)),
            _ => None,
        };
        let count = count.ok_or_else(|| {
            wrong(
                "shape",
                shape,
                "a list of numbers has one size there, such as [6]",
            )
        })?;
        let names = match feature.get("names") {
            None | Some(Value::Null) => return Ok(None),
            Some(names) => names_of(names).ok_or_else(|| {
                let remedy = "write a name for each element, such as [\"shoulder_pan.pos\", ..]";
                wrong("names", Some(names), remedy)
            })?,
        };
        Ok(Some(ElementNames {
            count: usize::try_from(count).unwrap_or(0),
            names,
        }))
    }

    /// Whether each element has a name of its own.
    pub fn is_whole(&self) -> bool {
        let is_first = |(index, name): (usize, &String)| !self.names[..index].contains(name);
        self.names.len() == self.count && self.names.iter().enumerate().all(is_first)
    }
}

fn names_of(value: &Value) -> Option<Vec<String>> {
    match value {
        Value::Array(all) => all
            .iter()
            .map(|name| Some(name.as_str()?.to_string()))
            .collect(),
        Value::Object(all) if all.len() == 1 && all.values().all(Value::is_array) => {
            names_of(all.values().next()?)
        }
        Value::Object(all) => {
            let place = |(name, place): (&String, &Value)| Some((place.as_u64()?, name.clone()));
            let mut places: Vec<(u64, String)> = all.iter().map(place).collect::<Option<_>>()?;
            places.sort();
            let in_order = (0..)
                .zip(&places)
                .all(|(index, (place, _))| *place == index);
            in_order.then(|| places.into_iter().map(|(_, name)| name).collect())
        }
        _ => None,
    }
}
