//! Which robot's file a model names, and which of its links.

use super::{document, tables};
use crate::error::Result;
use std::path::Path;
use toml_edit::{ArrayOfTables, DocumentMut, Item, Table, TableLike, Value};

/// The robot's file that a model of a robot in space names; none of another text.
pub fn robot_file(text: &str) -> Option<String> {
    let document: DocumentMut = text.parse().ok()?;
    let robot = document.get("rig")?.get("robot")?;
    robot.as_str().map(str::to_string)
}

/// The text with another name of the robot's file; one that names none stays as it is. `path` only
/// names the model in errors.
///
/// # Errors
/// The text is no TOML.
pub fn set_robot_file(text: &str, path: &Path, robot: &str) -> Result<String> {
    let mut document = document(text, path)?;
    let item = document.get_mut("rig").and_then(|rig| rig.get_mut("robot"));
    if let Some(Item::Value(value)) = item {
        let decor = value.decor().clone();
        *value = Value::from(robot);
        *value.decor_mut() = decor;
    }
    Ok(document.to_string())
}

/// The table of a robot's link; a new one where its values are still those of the robot's file. Of
/// several of its name the last, which has the values.
pub(super) fn link_named<'a>(
    document: &'a mut DocumentMut,
    name: &str,
) -> Option<&'a mut dyn TableLike> {
    let links = document
        .entry("link")
        .or_insert_with(|| Item::ArrayOfTables(ArrayOfTables::new()));
    let is_own = |table: &mut dyn TableLike| table.get("name").and_then(Item::as_str) == Some(name);
    let own: Vec<bool> = tables(links).map(is_own).collect();
    let known = own.iter().rposition(|is_own| *is_own);
    let index = known.unwrap_or(own.len());
    if known.is_none() {
        let mut table = Table::new();
        table.decor_mut().set_prefix("\n");
        table.insert("name", toml_edit::value(name));
        match links {
            Item::ArrayOfTables(tables) => tables.push(table),
            Item::Value(Value::Array(array)) => array.push(table.into_inline_table()),
            _ => return None,
        }
    }
    tables(links).nth(index)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn another_name_leaves_the_rest_as_it_is() {
        let text = "# mine\n[rig]\nrobot = \"../so101.urdf\" # beside\nname = \"so\"\n";
        assert_eq!(robot_file(text).as_deref(), Some("../so101.urdf"));
        let with = set_robot_file(text, Path::new("a.toml"), "so101.urdf").unwrap();
        assert_eq!(with, text.replace("../so101.urdf", "so101.urdf"));
        let planar = "[rig]\nname = \"arm\"\n";
        assert_eq!(robot_file(planar), None);
        assert_eq!(
            set_robot_file(planar, Path::new("a.toml"), "b.urdf").unwrap(),
            planar
        );
        assert_eq!(robot_file("[rig"), None);
    }

    /// Joints that move one body have links of its name, and the last its mass.
    #[test]
    fn of_tables_of_one_name_the_last_is_the_links() {
        let text = "[[link]]\nname = \"boom\"\n[[link]]\nname = \"boom\"\nmass_kg = 1.0\n";
        let mut document: DocumentMut = text.parse().unwrap();
        let table = link_named(&mut document, "boom").unwrap();
        table.insert("mass_kg", toml_edit::value(2.0));
        assert_eq!(document.to_string(), text.replace("1.0", "2.0"));
    }
}
