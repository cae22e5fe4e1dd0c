//! What a robot in space looks like: the shapes of its file, its meshes read from STL.
//!
//! What cannot be drawn refuses nothing: it is listed.

mod drawn;
mod find;
mod mesh;
mod mjcf;
mod stl;
#[cfg(test)]
mod tests;
mod urdf;

pub use super::import::Solid;
pub use mesh::Mesh;
pub use stl::read_stl;

use super::Robot;
use super::import::prefixes::declared;
use super::import::space::in_space;
use super::import::tree::RobotTree;
use super::import::tree_of;
use super::import::xml::{Element, XmlFile};
use crate::error::{Error, Place, Result};
use drawn::{Described, DrawnShape, Looks};
use nalgebra::{Isometry3, Vector3};
use std::collections::HashMap;
use std::path::{Path, PathBuf};

/// Most triangles of a mesh.
pub const MOST_TRIANGLES: usize = 20_000;
/// Most triangles of all meshes of a robot.
pub const MOST_TRIANGLES_OF_ALL: usize = 100_000;

/// Most that a line names of what is not drawn.
const MOST_NAMED: usize = 3;

/// The shapes of a robot, and what of it cannot be drawn.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct RobotShapes {
    /// Those that can be drawn, in the order of the robot's bodies.
    pub shapes: Vec<LinkShape>,
    /// The meshes that they name by number, each of at most [`MOST_TRIANGLES`] triangles and all of
    /// [`MOST_TRIANGLES_OF_ALL`].
    pub meshes: Vec<Mesh>,
    /// What is not drawn, once for each body and file.
    pub not_drawn: Vec<NotDrawn>,
}

/// A shape that moves with a link.
#[derive(Debug, Clone, PartialEq)]
pub struct LinkShape {
    /// The link, counted from 0; none of the base.
    pub link: Option<usize>,
    /// Where it stands in the link's frame, of the base in the world's.
    pub pose: Isometry3<f64>,
    /// What it is.
    pub form: ShapeForm,
}

/// A shape by itself.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ShapeForm {
    /// A simple one.
    Solid(Solid),
    /// A mesh.
    Mesh {
        /// Its place among [`RobotShapes::meshes`].
        mesh: usize,
        /// By how much its coordinates are multiplied; below 0 they are mirrored.
        scale: Vector3<f64>,
    },
}

/// A shape that the file describes and that is not drawn.
#[derive(Debug, Clone, PartialEq, Eq, serde::Serialize)]
pub struct NotDrawn {
    /// What the file calls the body.
    pub link: String,
    /// The link with which it moves, counted from 0; none of the base.
    #[serde(skip)]
    pub moves_with: Option<usize>,
    /// What it calls the mesh's file, if it is of one.
    pub mesh: Option<String>,
    /// Why.
    pub why: String,
}

impl RobotShapes {
    /// The shapes of a model's robot; `model` is the model's file, beside which the robot's lies.
    ///
    /// Of a body none of whose visual shapes can be drawn those are taken that collide.
    ///
    /// # Errors
    /// A robot's file that cannot be read, or is another than when the model was read.
    pub fn read(robot: &Robot, model: &Path) -> Result<RobotShapes> {
        let path = model.parent().unwrap_or(Path::new("")).join(&robot.file);
        let text =
            std::fs::read_to_string(&path).map_err(|error| Error::file(&path, "read", error))?;
        let text = declared(&text);
        let file = XmlFile::parse(&path, &text)?;
        let (_, tree) = tree_of(file.root())?;
        let found = in_space(&tree, &robot.locked, &robot.file)?;
        if found.tree != robot.tree {
            return Err(Error::data(
                Place::file(&path),
                "the robot's file was changed meanwhile",
                "run it again",
            ));
        }
        let mut reader = Reader {
            robot: &path,
            numbers: HashMap::new(),
            found: RobotShapes::default(),
        };
        let drawn = shapes_of(file.root(), &tree)?;
        for ((body, (link, stands)), drawn) in tree.bodies.iter().zip(&found.fixed).zip(drawn) {
            reader.body(&body.name, *link, stands, drawn);
        }
        let mut found = reader.found;
        found.thin();
        Ok(found)
    }

    /// What is not drawn, in one line; none where all is.
    pub fn not_drawn_text(&self) -> Option<String> {
        let first = self.not_drawn.iter().take(MOST_NAMED).map(|lacks| {
            let mesh = lacks.mesh.as_ref().map(|mesh| format!("{mesh}: "));
            format!("{} ({}{})", lacks.link, mesh.unwrap_or_default(), lacks.why)
        });
        let first: Vec<String> = first.collect();
        let more = self.not_drawn.len().saturating_sub(MOST_NAMED);
        let more = (more > 0).then(|| format!(" and {more} more"));
        (!first.is_empty()).then(|| {
            format!(
                "shapes that are not drawn, their links are capsules: {}{}",
                first.join(", "),
                more.unwrap_or_default()
            )
        })
    }

    /// Brings the meshes below their limits: the largest give way.
    fn thin(&mut self) {
        let mut counts: Vec<usize> = self.meshes.iter().map(|m| m.triangles.len()).collect();
        counts.sort_unstable();
        let (mut left, mut most) = (MOST_TRIANGLES_OF_ALL, MOST_TRIANGLES);
        for (at, count) in counts.iter().enumerate() {
            // What each of those that are left may have.
            most = (left / (counts.len() - at)).min(MOST_TRIANGLES);
            left -= count.min(&most);
        }
        for mesh in &mut self.meshes {
            if mesh.triangles.len() > most {
                *mesh = mesh.thinned(most);
            }
        }
    }
}

/// The shapes of each body of a robot.
fn shapes_of(root: Element, tree: &RobotTree) -> Result<Vec<Vec<Described>>> {
    let mut by_place: HashMap<usize, Vec<Described>> = if root.tag() == "robot" {
        let links = root.all("link");
        links.map(|link| (link.at(), urdf::shapes(link))).collect()
    } else {
        mjcf::shapes(root)?
    };
    let of = |body: usize| by_place.remove(&body).unwrap_or_default();
    Ok(tree.bodies.iter().map(|body| body.at).map(of).collect())
}

struct Reader<'a> {
    robot: &'a Path,
    /// Meshes that were read, by their files.
    numbers: HashMap<PathBuf, std::result::Result<usize, String>>,
    found: RobotShapes,
}

impl Reader<'_> {
    fn body(
        &mut self,
        name: &str,
        link: Option<usize>,
        stands: &Isometry3<f64>,
        described: Vec<Described>,
    ) {
        let (visual, collision): (Vec<_>, Vec<_>) =
            (described.into_iter()).partition(|(looks, _)| *looks == Looks::Visual);
        let before = self.found.shapes.len();
        let mut lacking = self.add(link, stands, visual);
        let instead = !lacking.is_empty() && self.found.shapes.len() == before;
        if instead {
            lacking.extend(self.add(link, stands, collision));
            if self.found.shapes.len() > before {
                lacking.clear();
            }
        }
        for (mesh, why) in lacking {
            let lacks = NotDrawn {
                link: name.to_string(),
                moves_with: link,
                mesh,
                why,
            };
            if !self.found.not_drawn.contains(&lacks) {
                self.found.not_drawn.push(lacks);
            }
        }
    }

    /// Adds shapes of a link; those that cannot be drawn by their meshes' names, and why.
    fn add(
        &mut self,
        link: Option<usize>,
        stands: &Isometry3<f64>,
        described: Vec<Described>,
    ) -> Vec<(Option<String>, String)> {
        let mut lacking = Vec::new();
        for (_, drawn) in described {
            let made = drawn.map(|own| (own.pose, self.form(&own.shape)));
            match made {
                Ok((pose, Ok(form))) => self.found.shapes.push(LinkShape {
                    link,
                    pose: stands * pose,
                    form,
                }),
                Ok((_, Err((mesh, why)))) => lacking.push((Some(mesh), why)),
                Err(error) => lacking.push((None, error.to_string())),
            }
        }
        lacking
    }

    fn form(&mut self, shape: &DrawnShape) -> std::result::Result<ShapeForm, (String, String)> {
        match shape {
            DrawnShape::Solid(solid) => Ok(ShapeForm::Solid(*solid)),
            DrawnShape::Mesh { name, scale } => {
                let mesh = self.mesh(name).map_err(|error| (name.clone(), error))?;
                Ok(ShapeForm::Mesh {
                    mesh,
                    scale: *scale,
                })
            }
        }
    }

    /// The number of a mesh, which is read when it is first named.
    fn mesh(&mut self, name: &str) -> std::result::Result<usize, String> {
        let file = find::file(name, self.robot).ok_or("no such file")?;
        if let Some(known) = self.numbers.get(&file) {
            return known.clone();
        }
        let number = find::mesh(&file).map(|mesh| {
            self.found.meshes.push(mesh);
            self.found.meshes.len() - 1
        });
        self.numbers.insert(file, number.clone());
        number
    }
}
