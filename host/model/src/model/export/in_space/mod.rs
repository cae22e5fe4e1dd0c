//! A robot in space: its own file with the values that the model changes.
//!
//! The text is changed at the bytes of single attributes, so that shapes, comments, unknown
//! elements and layout stay. What it then holds is not assumed: it is read again, and what differs
//! from the model is listed.

mod actuators;
mod bodies;
#[cfg(test)]
mod crane;
mod edits;
mod joints;
mod lacking;
#[cfg(test)]
mod tests;

use super::Exported;
use super::xml::numbers;
use crate::error::{Error, Result};
use crate::model::import::mjcf::defaults::Defaults;
use crate::model::import::mjcf::orientation::Compiler;
use crate::model::import::prefixes::{added, declared};
use crate::model::import::space::{InSpace, in_space};
use crate::model::import::tree::RobotTree;
use crate::model::import::xml::{Element, XmlFile};
use crate::model::import::{ImportPlan, JointDrives, SpacePlan, import, tree_of};
use crate::model::{Model, Robot, parse};
use edits::Edits;
use lacking::lacking;
use roxmltree::{Node, NodeId};
use std::collections::HashMap;
use std::path::Path;

/// An import rounds to twelve digits; what differs by less is no change.
const ROUNDED: f64 = 1e-11;
/// What differs by less, as a share, is the same for a simulator.
const NEAR: f64 = 1e-9;

fn is_near(own: f64, other: f64) -> bool {
    (own - other).abs() <= ROUNDED * own.abs().max(other.abs())
}

/// A computed number with the digits that an import keeps: what is beyond them is rounding of the
/// arithmetic that made it.
fn rounded(value: f64) -> f64 {
    format!("{value:.11e}").parse().unwrap_or(value)
}

/// A robot's file that is being written.
struct Source<'a> {
    format: &'static str,
    file: &'a XmlFile<'a>,
    robot: RobotTree,
    found: InSpace,
    /// Of MJCF.
    compiler: Option<Compiler>,
    /// Elements by the byte at which they begin.
    nodes: HashMap<usize, NodeId>,
}

impl<'a> Source<'a> {
    fn of(file: &'a XmlFile<'a>, robot: &Robot) -> Result<Self> {
        let root = file.root();
        let (format, tree) = tree_of(root)?;
        let found = in_space(&tree, &robot.locked, &robot.file)?;
        let elements = file.document.descendants().filter(Node::is_element);
        Ok(Source {
            format,
            file,
            robot: tree,
            found,
            compiler: (format == "mjcf").then(|| Compiler::of(root)).transpose()?,
            nodes: elements
                .map(|node| (node.range().start, node.id()))
                .collect(),
        })
    }

    fn root(&self) -> Element<'a> {
        self.file.root()
    }

    /// The element that begins at a byte; the root where none does.
    fn element(&self, at: usize) -> Element<'a> {
        let node = (self.nodes.get(&at)).and_then(|id| self.file.document.get_node(*id));
        Element {
            node: node.unwrap_or(self.root().node),
            file: self.file,
        }
    }
}

/// A model, and what a robot's file alone makes: without and with torques at joints that the file
/// does not drive.
struct Pair<'a> {
    own: &'a Model,
    free: Model,
    driven: Model,
}

impl<'a> Pair<'a> {
    /// `text` is the robot's, `path` the model's file.
    fn of(own: &'a Model, robot: &Robot, text: &str, path: &Path) -> Result<Self> {
        let read = |drives: JointDrives| {
            let plan = ImportPlan {
                drives,
                space: Some(SpacePlan {
                    robot: robot.file.clone(),
                    locked: robot.locked.clone(),
                }),
                ..ImportPlan::default()
            };
            let imported = import(text, Path::new(&robot.file), &plan)?;
            parse::model_of(&imported.toml, path, Some(text))
        };
        Ok(Pair {
            own,
            free: read(JointDrives::OfFile)?,
            driven: read(JointDrives::OrTorque)?,
        })
    }

    /// The file's model as far as a joint goes: one that the model drives has a torque where the
    /// file has no drive.
    fn file(&self, joint: usize) -> &Model {
        if self.own.joints[joint].drive.is_driven() {
            &self.driven
        } else {
            &self.free
        }
    }
}

/// The robot's file of a robot in space with the model's masses, friction, rotors and drives;
/// `path` is the model's file, beside which the robot's is, `format` that in which it is asked for:
/// `urdf` or `mjcf`.
///
/// What the text cannot say is listed, as is what the robot's file sets in another way. An
/// unchanged import gives the file's own text.
///
/// # Errors
/// A planar chain; another format than the robot's file has; a file that cannot be read.
pub fn robot_file(model: &Model, path: &Path, format: &str) -> Result<Exported> {
    let Some(robot) = &model.robot else {
        return Err(Error::usage(
            format!("`{}` is a planar chain: it has no robot's file", model.name),
            "export it as URDF or MJCF of its own",
        ));
    };
    let file = path.parent().unwrap_or(Path::new("")).join(&robot.file);
    let text =
        std::fs::read_to_string(&file).map_err(|source| Error::file(&file, "read", source))?;
    let declared = declared(&text);
    let xml = XmlFile::parse(&file, &declared)?;
    let source = Source::of(&xml, robot)?;
    if source.format != format {
        let own = source.format;
        return Err(Error::usage(
            format!(
                "{} is {}, not {}",
                robot.file,
                own.to_uppercase(),
                format.to_uppercase()
            ),
            format!("a robot in space is exported to its own file's format: --to {own}"),
        ));
    }
    let mut edits = Edits::of(&declared);
    let models = Pair::of(model, robot, &text, path)?;
    edit(&mut edits, &source, &models)?;
    // Prefixes that were declared to read the file are none of its own.
    if declared.len() > text.len() {
        edits.replace(added(&text, &declared), "");
    }
    let written = edits.applied();
    let read = Pair::of(model, robot, &written, path)?;
    Ok(Exported {
        not_carried: lacking(&read, source.format),
        relative_files: relative_files(source.root()),
        text: written,
    })
}

/// Changes what the model changes.
fn edit(edits: &mut Edits, source: &Source, models: &Pair) -> Result<()> {
    if let Some(own) = models.own.rig(false).tree {
        bodies::write(edits, source, &own);
        if source.format == "mjcf" {
            let (own, file) = (own.gravity_m_s2, source.found.tree.gravity_m_s2);
            if !is_near(own.norm(), file.norm()) {
                gravity(edits, source.root(), &numbers(own.as_slice()));
            }
        }
    }
    joints::write(edits, source, models);
    if source.format == "mjcf" {
        actuators::write(edits, source, models, &Defaults::of(source.root())?);
    }
    Ok(())
}

/// Writes gravity where MuJoCo takes it from: the last `<option>` that has one.
fn gravity(edits: &mut Edits, root: Element, vector: &str) {
    let has = |option: &Element| option.text("gravity").is_some();
    let own = root.all("option").filter(has).last();
    match own.or(root.first("option")) {
        Some(option) => edits.set(&option.node, "gravity", vector),
        None => edits.insert(&root.node, &format!("<option gravity=\"{vector}\"/>")),
    }
}

/// The files that elements name, but those whose names are whole.
fn relative_files(root: Element) -> Vec<String> {
    let named = root.node.descendants().flat_map(|node| {
        let keys = ["filename", "file", "meshdir", "texturedir", "assetdir"];
        keys.into_iter().filter_map(move |key| node.attribute(key))
    });
    let is_relative = |name: &&str| !name.contains("://") && !Path::new(name).is_absolute();
    let mut files: Vec<String> = Vec::new();
    for name in named.filter(is_relative) {
        if !files.iter().any(|known| known == name) {
            files.push(name.to_string());
        }
    }
    files
}
