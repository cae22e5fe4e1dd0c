//! What an MJCF's bodies look like: `<geom>`, filled from classes, meshes by name.

use super::drawn::{Described, Drawn, DrawnShape, Looks};
use crate::error::Result;
use crate::model::import::mjcf::defaults::{Attributes, Defaults};
use crate::model::import::mjcf::geometry::{pose, solid};
use crate::model::import::mjcf::orientation::Compiler;
use crate::model::import::xml::Element;
use nalgebra::{Isometry3, Vector3};
use std::collections::HashMap;
use std::path::Path;

/// Bodies and frames within each other, as the import reads them.
const DEEPEST: usize = 400;
/// Groups from here on are not shown by MuJoCo's own viewer unless asked: shapes that collide.
const COLLISION_GROUP: f64 = 3.0;

/// The file, and what it says once for all.
pub(super) struct Bodies<'a> {
    compiler: Compiler,
    defaults: Defaults<'a>,
    /// Where meshes lie.
    folder: &'a Path,
    /// Their elements by their names.
    meshes: HashMap<String, Element<'a>>,
    /// Per body, by the byte at which its element begins.
    found: HashMap<usize, Vec<Described>>,
}

/// The shapes of all bodies by the byte at which their elements begin. What stands in the world
/// itself is no part of the robot.
///
/// # Errors
/// Settings and classes that the import refuses, too.
pub(super) fn shapes<'a>(root: Element<'a>) -> Result<HashMap<usize, Vec<Described>>> {
    let folder = |compiler: Element<'a>| compiler.text("meshdir").or(compiler.text("assetdir"));
    let folder = root.all("compiler").filter_map(folder).last();
    let mut bodies = Bodies {
        compiler: Compiler::of(root)?,
        defaults: Defaults::of(root)?,
        folder: Path::new(folder.unwrap_or("")),
        meshes: HashMap::new(),
        found: HashMap::new(),
    };
    for mesh in root.all("asset").flat_map(|assets| assets.all("mesh")) {
        let stem = mesh
            .text("file")
            .and_then(|file| Path::new(file).file_stem());
        let stem = stem.map(|stem| stem.to_string_lossy().into_owned());
        if let Some(name) = mesh.text("name").map(str::to_string).or(stem) {
            bodies.meshes.insert(name, mesh);
        }
    }
    for world in root.all("worldbody") {
        bodies.children(world, None, &Isometry3::identity(), None, 0)?;
    }
    Ok(bodies.found)
}

impl<'a> Bodies<'a> {
    /// The mesh of this name that a shape asks for.
    fn mesh(&self, name: &str, shape: &Attributes) -> Result<DrawnShape> {
        let unknown = || {
            let what = format!("there is no mesh \"{name}\"");
            shape.element.wrong(what, "mend the name")
        };
        let mesh = *self.meshes.get(name).ok_or_else(unknown)?;
        let own = self.defaults.attributes(mesh, None)?;
        let file = mesh.required("file")?;
        Ok(DrawnShape::Mesh {
            name: self.folder.join(file).to_string_lossy().into_owned(),
            scale: own.vector("scale")?.unwrap_or(Vector3::repeat(1.0)),
        })
    }

    /// The shapes within an element, whose frame has this pose in its body's.
    fn children(
        &mut self,
        element: Element<'a>,
        body: Option<usize>,
        frame: &Isometry3<f64>,
        class: Option<&str>,
        depth: usize,
    ) -> Result<()> {
        if depth > DEEPEST {
            return Ok(());
        }
        for child in element.elements() {
            let class = child.text("childclass").or(class);
            match (child.tag(), body) {
                ("body", _) => {
                    let at = Some(child.at());
                    self.children(child, at, &Isometry3::identity(), class, depth + 1)?;
                }
                ("frame", _) => {
                    let own = pose(&Attributes::own(child), &self.compiler)?;
                    self.children(child, body, &(frame * own), class, depth + 1)?;
                }
                ("geom", Some(body)) => {
                    let own = self.defaults.attributes(child, class);
                    let looks = own.as_ref().map_or(Looks::Visual, looks);
                    let shape = own.and_then(|own| self.shape(&own, frame));
                    if let Some(shape) = shape.transpose() {
                        self.found.entry(body).or_default().push((looks, shape));
                    }
                }
                _ => {}
            }
        }
        Ok(())
    }

    /// The shape of a `<geom>`; none of what is not seen, of planes and of height fields.
    fn shape(&self, own: &Attributes, frame: &Isometry3<f64>) -> Result<Option<Drawn>> {
        let kind = own.text("type").unwrap_or("sphere");
        let opacity = own.numbers("rgba")?.and_then(|rgba| rgba.get(3).copied());
        if ["plane", "hfield"].contains(&kind) || opacity == Some(0.0) {
            return Ok(None);
        }
        let (pose, shape) = match own.text("mesh") {
            Some(name) => (pose(own, &self.compiler)?, self.mesh(name, own)?),
            None => {
                let (pose, solid) = solid(own, &self.compiler)?;
                (pose, DrawnShape::Solid(solid))
            }
        };
        Ok(Some(Drawn {
            pose: frame * pose,
            shape,
        }))
    }
}

/// What a shape is for, by its group.
fn looks(own: &Attributes) -> Looks {
    match own.number("group") {
        Ok(Some(group)) if group >= COLLISION_GROUP => Looks::Collision,
        _ => Looks::Visual,
    }
}
