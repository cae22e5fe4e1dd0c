//! A robot in space as drawn: its joints' frames, and what is seen of each link.

use super::packed::{PackedMesh, rounded};
use super::surface::surface;
use crate::dynamics::{SpatialLink, SpatialTree};
use crate::model::Model;
use crate::model::shapes::{LinkShape, RobotShapes, ShapeForm, Solid};
use nalgebra::{Isometry3, Point3, Translation3, UnitQuaternion, Vector3};
use serde::Serialize;

/// A bone shorter than this is none, m.
const NO_BONE_M: f64 = 1e-6;
/// Radius of a link without mass, as a share of the robot's reach, and what the heaviest has more.
const RADIUS: (f64, f64) = (0.011, 0.026);
/// Radius of the base beside the stoutest link's, and of every second link beside what it would be:
/// surfaces in one place would flicker.
const BASE: f64 = 1.2;
const SLIMMER: f64 = 0.94;
/// A last link ends in the middle of what is farther out than this share of its length.
const OUTER: f64 = 0.9;
/// Most of a radius, as a share of the link's longest bone.
const STOUTEST: f64 = 0.3;

/// A tree of links in space.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct DrawnTree {
    /// Against gravity, in the base's frame.
    pub up: [f64; 3],
    /// Links, each behind the one that carries it.
    pub links: Vec<TreeLink>,
    /// From the base's origin to its joints, m.
    pub base_bones_m: Vec<[f64; 3]>,
    /// What is seen.
    pub parts: Vec<DrawnPart>,
    /// The surfaces of the parts.
    pub meshes: Vec<PackedMesh>,
}

/// A link and the joint that carries it.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct TreeLink {
    /// The link that carries it, counted from 0; none of the base.
    pub parent: Option<usize>,
    /// Where its frame stands in the parent's while the joint is at 0: x, y, z, m, and a unit
    /// quaternion x, y, z, w.
    pub place: [f64; 7],
    /// About what the joint turns, or along what it slides, in the link's frame.
    pub axis: [f64; 3],
    /// Whether it slides.
    pub slides: bool,
    /// Mass, kg.
    pub mass_kg: f64,
    /// Centre of mass in the link's frame, m.
    pub com_m: [f64; 3],
    /// From the frame's origin to the joints that it carries, or to its end, m.
    pub bones_m: Vec<[f64; 3]>,
    /// Radius of capsules along the bones, m.
    pub radius_m: f64,
    /// Whether it carries no joint: its bone's end is a tip.
    pub is_last: bool,
}

/// A surface that moves with a link.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct DrawnPart {
    /// The link, counted from 0; none of the base.
    pub link: Option<usize>,
    /// Which of the meshes.
    pub mesh: usize,
    /// Where it stands in the link's frame, as [`TreeLink::place`].
    pub pose: [f64; 7],
    /// By how much its coordinates are multiplied.
    pub scale: [f64; 3],
}

impl DrawnTree {
    /// A robot with these shapes; links without one, or of which some cannot be drawn, are
    /// capsules. None of a planar chain.
    pub(super) fn of(model: &Model, shapes: &RobotShapes) -> Option<DrawnTree> {
        let tree = model.tree()?;
        let bones = (0..tree.len()).map(|i| bones(&tree, shapes, i));
        let bones: Vec<Vec<Vector3<f64>>> = bones.collect();
        let base_bones = joints(&tree, None);
        let radii = radii(&tree, &bones, &base_bones);
        let links = tree.links.iter().zip(&bones).zip(&radii).enumerate();
        let links = links.map(|(index, ((link, bones), radius))| TreeLink {
            parent: link.parent,
            place: seven(&link.place),
            axis: link.axis.into_inner().into(),
            slides: link.slides,
            mass_kg: link.mass_kg,
            com_m: link.com_m.map(rounded).into(),
            bones_m: bones.iter().map(|bone| bone.map(rounded).into()).collect(),
            radius_m: rounded(*radius),
            is_last: is_last(&tree, index),
        });
        let up = tree.gravity_m_s2.try_normalize(1e-9).map(|down| -down);
        let mut drawn = DrawnTree {
            up: up.unwrap_or(Vector3::z()).into(),
            links: links.collect(),
            base_bones_m: base_bones
                .iter()
                .map(|bone| bone.map(rounded).into())
                .collect(),
            parts: Vec::new(),
            meshes: shapes.meshes.iter().map(PackedMesh::of).collect(),
        };
        drawn.add_shapes(shapes);
        let stoutest = radii.iter().copied().fold(0.0, f64::max);
        let base = std::iter::once((None, &base_bones, BASE * stoutest));
        let own = bones.iter().zip(&radii).enumerate();
        let own = own.map(|(index, (bones, radius))| (Some(index), bones, *radius));
        for (link, bones, radius_m) in base.chain(own) {
            let is_seen = shapes.shapes.iter().any(|shape| shape.link == link);
            // What is seen of it may be a small part.
            let lacks = shapes
                .not_drawn
                .iter()
                .any(|lacks| lacks.moves_with == link);
            if !is_seen || lacks {
                drawn.add_capsules(link, bones, radius_m);
            }
        }
        Some(drawn)
    }

    fn add_shapes(&mut self, shapes: &RobotShapes) {
        for shape in &shapes.shapes {
            match shape.form {
                ShapeForm::Mesh { mesh, scale } => self.parts.push(DrawnPart {
                    link: shape.link,
                    mesh,
                    pose: seven(&shape.pose),
                    scale: scale.into(),
                }),
                ShapeForm::Solid(solid) => self.add_solid(shape.link, &shape.pose, &solid),
            }
        }
    }

    fn add_solid(&mut self, link: Option<usize>, pose: &Isometry3<f64>, solid: &Solid) {
        let packed = PackedMesh::of(&surface(solid));
        let known = self.meshes.iter().position(|mesh| *mesh == packed);
        let mesh = known.unwrap_or(self.meshes.len());
        if known.is_none() {
            self.meshes.push(packed);
        }
        self.parts.push(DrawnPart {
            link,
            mesh,
            pose: seven(pose),
            scale: [1.0; 3],
        });
    }

    /// Capsules along bones; a ball where there is none.
    fn add_capsules(&mut self, link: Option<usize>, bones: &[Vector3<f64>], radius_m: f64) {
        for bone in bones {
            let turn = UnitQuaternion::rotation_between(&Vector3::z(), bone);
            // Half a turn about anything lays z along -z.
            let down = || UnitQuaternion::from_axis_angle(&Vector3::x_axis(), std::f64::consts::PI);
            let middle = Translation3::from(bone / 2.0);
            let pose = Isometry3::from_parts(middle, turn.unwrap_or_else(down));
            let half_m = bone.norm() / 2.0;
            self.add_solid(link, &pose, &Solid::Capsule { radius_m, half_m });
        }
        if bones.is_empty() {
            let ball = Solid::Ellipsoid {
                radii_m: Vector3::repeat(radius_m),
            };
            self.add_solid(link, &Isometry3::identity(), &ball);
        }
    }
}

fn is_last(tree: &SpatialTree, index: usize) -> bool {
    (tree.links.iter()).all(|link| link.parent != Some(index))
}

/// From a link's origin, or the base's, to the joints that it carries.
fn joints(tree: &SpatialTree, link: Option<usize>) -> Vec<Vector3<f64>> {
    let carried = tree.links.iter().filter(|next| next.parent == link);
    let mut bones: Vec<Vector3<f64>> = Vec::new();
    for bone in carried.map(|next| next.place.translation.vector) {
        let near = |other: &Vector3<f64>| (other - bone).norm() < NO_BONE_M;
        if bone.norm() > NO_BONE_M && !bones.iter().any(near) {
            bones.push(bone);
        }
    }
    bones
}

/// From a link's origin to the joints that it carries; of a last one to its end, and of one whose
/// joints are nearer than its mass, to that.
fn bones(tree: &SpatialTree, shapes: &RobotShapes, index: usize) -> Vec<Vector3<f64>> {
    let link = &tree.links[index];
    if is_last(tree, index) {
        let seen = seen_end(shapes, index, &link.com_m);
        return seen.or_else(|| end(link)).into_iter().collect();
    }
    let mut bones = joints(tree, Some(index));
    let longest = bones.iter().map(Vector3::norm).fold(0.0, f64::max);
    if link.com_m.norm() > 2.0 * longest && link.com_m.norm() > NO_BONE_M {
        bones.push(link.com_m);
    }
    bones
}

/// Where the shapes of a link end, towards its centre of mass: the middle of what lies farthest
/// out. None where it has none, or they lie around its origin.
fn seen_end(shapes: &RobotShapes, link: usize, com_m: &Vector3<f64>) -> Option<Vector3<f64>> {
    let own = shapes
        .shapes
        .iter()
        .filter(|shape| shape.link == Some(link));
    let points: Vec<Vector3<f64>> = own.flat_map(|shape| corners(shapes, shape)).collect();
    let farthest = || {
        points
            .iter()
            .copied()
            .max_by(|a, b| a.norm().total_cmp(&b.norm()))
    };
    let along = com_m.try_normalize(NO_BONE_M);
    let along = along.or_else(|| farthest()?.try_normalize(NO_BONE_M))?;
    let most = points
        .iter()
        .map(|point| point.dot(&along))
        .fold(0.0, f64::max);
    if most < NO_BONE_M {
        return None;
    }
    let outer = points
        .iter()
        .filter(|point| point.dot(&along) >= OUTER * most);
    let sum = outer
        .clone()
        .fold(Vector3::zeros(), |sum, point| sum + point);
    Some(sum / outer.count() as f64)
}

/// The corners of a shape in its link's frame, m.
fn corners(shapes: &RobotShapes, shape: &LinkShape) -> Vec<Vector3<f64>> {
    let solid;
    let (mesh, scale) = match &shape.form {
        ShapeForm::Solid(own) => {
            solid = surface(own);
            (&solid, Vector3::repeat(1.0))
        }
        ShapeForm::Mesh { mesh, scale } => match shapes.meshes.get(*mesh) {
            Some(mesh) => (mesh, *scale),
            None => return Vec::new(),
        },
    };
    let corners = mesh.corners_m.iter().map(|corner| {
        let own = Vector3::from(corner.map(f64::from)).component_mul(&scale);
        (shape.pose * Point3::from(own)).coords
    });
    corners.collect()
}

/// Where a last link ends: an even rod with its mass and its largest moment of inertia ends so far
/// behind its centre of mass. None where it has neither length nor centre.
fn end(link: &SpatialLink) -> Option<Vector3<f64>> {
    let moments = link.inertia_kg_m2.symmetric_eigen();
    let most = moments.eigenvalues.max().max(0.0);
    let half_m = if link.mass_kg > 0.0 {
        (3.0 * most / link.mass_kg).sqrt()
    } else {
        0.0
    };
    let along = link.com_m.try_normalize(NO_BONE_M).unwrap_or_else(|| {
        // Centred on the joint, it lies along the axis of its least moment.
        moments
            .eigenvectors
            .column(moments.eigenvalues.imin())
            .into()
    });
    // A rod behind the joint is at most twice as long as its centre is far.
    let beyond = if link.com_m.norm() > NO_BONE_M {
        half_m.min(2.0 * link.com_m.norm())
    } else {
        half_m
    };
    let end = along * (link.com_m.norm() + beyond);
    (end.norm() > NO_BONE_M).then_some(end)
}

/// Radius of each link: heavier ones are stouter, short ones at most so.
fn radii(tree: &SpatialTree, bones: &[Vec<Vector3<f64>>], base_bones: &[Vector3<f64>]) -> Vec<f64> {
    let longest = |bones: &[Vector3<f64>]| bones.iter().map(Vector3::norm).fold(0.0, f64::max);
    // From the base's origin to each link's end, along the bones.
    let mut reached: Vec<f64> = Vec::with_capacity(tree.len());
    for (link, own) in tree.links.iter().zip(bones) {
        let before = match link.parent {
            None => 0.0,
            Some(parent) => reached[parent] - longest(&bones[parent]),
        };
        reached.push(before + link.place.translation.vector.norm() + longest(own));
    }
    let reach = reached.into_iter().fold(longest(base_bones), f64::max);
    let reach = if reach > NO_BONE_M { reach } else { 1.0 };
    let masses = tree.links.iter().map(|link| link.mass_kg);
    let heaviest = masses.clone().fold(f64::MIN_POSITIVE, f64::max);
    masses
        .zip(bones)
        .enumerate()
        .map(|(index, (mass, bones))| {
            let radius = reach * (RADIUS.0 + RADIUS.1 * (mass.max(0.0) / heaviest).sqrt());
            let radius = match longest(bones) {
                0.0 => radius,
                bone => radius.min((STOUTEST * bone).max(RADIUS.0 * reach)),
            };
            if index % 2 == 0 {
                radius
            } else {
                SLIMMER * radius
            }
        })
        .collect()
}

/// x, y, z, and a unit quaternion x, y, z, w.
fn seven(pose: &Isometry3<f64>) -> [f64; 7] {
    let at = pose.translation.vector;
    let turn = pose.rotation.coords;
    [at.x, at.y, at.z, turn.x, turn.y, turn.z, turn.w].map(|value| (value * 1e9).round() / 1e9)
}

#[cfg(test)]
mod tests;
