//! Which robot's file a model names.

use super::document;
use crate::error::Result;
use std::path::Path;
use toml_edit::{DocumentMut, Item, Value};

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
}
