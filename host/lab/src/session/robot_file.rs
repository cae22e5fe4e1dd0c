//! The robot's file of a model in space: a copy of it lies in the session's folder, so that the
//! session goes on where the robot's own file is moved or edited, and can be taken along.

use super::LabSession;
use super::bring::is_robot;
use super::data::{numbered, plain_letters};
use super::saved::SavedSession;
use crate::error::{Error, Result};
use crate::model::Robot;
use crate::model::edit::{robot_file, set_robot_file};
use crate::output::write_new;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// The last part of a name of a robot's file, in letters that no file system can misread; a name
/// that ends as no robot's is given an ending.
fn plain_robot(name: &str) -> String {
    let last = name.rsplit(['/', '\\']).next().unwrap_or_default();
    let plain = plain_letters(last);
    if is_robot(Path::new(&plain)) {
        plain
    } else {
        format!("{plain}.xml")
    }
}

impl LabSession {
    /// Keeps a copy of a robot's file; the name it got. Another robot of the same name stays.
    ///
    /// # Errors
    /// The system's refusal.
    pub(super) fn keep_robot(&self, name: &str, text: &str) -> Result<String> {
        for file in numbered(&plain_robot(name)) {
            let path = self.folder().join(&file);
            match std::fs::read_to_string(&path) {
                Ok(known) if known == text => return Ok(file),
                Ok(_) => {}
                Err(why) if why.kind() == std::io::ErrorKind::NotFound => {
                    write_new(&path, text, false)?;
                    return Ok(file);
                }
                Err(why) => return Err(Error::file(&path, "read", why)),
            }
        }
        unreachable!("there is no end to the names")
    }

    /// Keeps a copy of a robot's file, and where it came from; the name it got.
    pub(super) fn keep_robot_from(&self, file: &Path, text: &str) -> Result<String> {
        let kept = self.keep_robot(&file.display().to_string(), text)?;
        let from = std::path::absolute(file).map_err(|why| Error::file(file, "read", why))?;
        self.change(|saved| {
            saved.robots_from.insert(kept.clone(), from);
            Ok(())
        })?;
        Ok(kept)
    }

    /// A robot of a model of this session, as the file it came from has it, and a place beside that
    /// file, where it still is the same: meshes lie there. Else the copy here.
    pub fn robot_with_meshes(&self, saved: &SavedSession, robot: &Robot) -> (Robot, PathBuf) {
        let here = self.folder().join(&robot.file);
        let text = |file: &Path| std::fs::read_to_string(file).ok();
        let from = saved.robots_from.get(&robot.file);
        match from.filter(|from| text(from).is_some() && text(from) == text(&here)) {
            Some(from) => {
                let mut robot = robot.clone();
                robot.file = from.display().to_string();
                (robot, from.with_file_name("model.toml"))
            }
            None => (robot.clone(), self.model_path(0)),
        }
    }

    /// A model's text whose robot is a copy in this session; `beside` is the folder of the model's
    /// file. Without it, as of a model that a browser sent, the robot has to be here already.
    ///
    /// # Errors
    /// A robot's file that is not there.
    pub(super) fn with_robot(
        &self,
        name: &Path,
        text: &str,
        beside: Option<&Path>,
    ) -> Result<String> {
        let Some(robot) = robot_file(text) else {
            return Ok(text.to_string());
        };
        let kept = match beside {
            Some(folder) => {
                let file = folder.join(&robot);
                let robot_text = std::fs::read_to_string(&file)
                    .map_err(|why| Error::file(&file, "read", why))?;
                self.keep_robot_from(&file, &robot_text)?
            }
            None => {
                let kept = plain_robot(&robot);
                if !self.folder().join(&kept).is_file() {
                    return Err(Error::usage(
                        format!(
                            "{}: its robot {robot} is not in this session",
                            name.display()
                        ),
                        format!("bring the robot's file {kept} first, or both together"),
                    ));
                }
                kept
            }
        };
        set_robot_file(text, name, &kept)
    }

    /// The robots' files that the models of these texts name, by their names.
    pub(super) fn robots_of<'a>(
        &self,
        tomls: impl Iterator<Item = &'a str>,
    ) -> BTreeMap<String, String> {
        let names = tomls.filter_map(robot_file);
        let texts = names.filter_map(|name| {
            let text = std::fs::read_to_string(self.folder().join(&name)).ok()?;
            Some((name, text))
        });
        texts.collect()
    }
}
