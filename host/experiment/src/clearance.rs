//! How near the links of a robot in space come to each other and to the plane that it stands on.

use crate::dynamics::{SpatialLink, SpatialTree};
use crate::model::Model;
use crate::motion::Motion;
use crate::sim::Plant;
use nalgebra::{Isometry3, Point3, Vector3};

/// What an experiment with a robot in space may not fall short of.
///
/// A link is a capsule: its centre lines run from its joint to its centre of mass and on to the
/// joints that it carries, its radius is that of a solid cylinder with its least moment of inertia.
/// Such a shape is a guess, so what logs went through is allowed, too. The base is no part of it.
#[derive(Debug, Clone, PartialEq)]
pub struct Clearance {
    lines: Vec<CentreLines>,
    /// Against free fall; none where nothing falls.
    up: Option<Vector3<f64>>,
    /// Two links that no joint and no short link joins, and the least distance of their centre
    /// lines, m.
    apart_m: Vec<((usize, usize), f64)>,
    /// Per link, the least height of its centre lines over the base's origin, m.
    above_m: Vec<f64>,
    /// Per joint, between which angles its end stops let it turn, rad.
    ranges_rad: Vec<Option<(f64, f64)>>,
}

/// Centre lines of a link, in its frame: from its joint to these points.
#[derive(Debug, Clone, PartialEq)]
struct CentreLines {
    ends: Vec<Point3<f64>>,
}

/// Sine of the angle by which an axis may be off the vertical and still be upright.
const UPRIGHT: f64 = 0.02;

/// A line between two points.
type Line = [Point3<f64>; 2];

impl Clearance {
    /// Of a robot in space: that capsules neither meet nor dip under the base's origin, or what
    /// these motions went through where that is less; none of a planar chain.
    pub fn of_logs(model: &Model, motions: &[Motion]) -> Option<Clearance> {
        let tree = model.tree()?;
        let links = 0..tree.len();
        let up = (-tree.gravity_m_s2).try_normalize(0.0);
        let radii_m: Vec<f64> = tree.links.iter().map(radius_m).collect();
        let above = tree.links.iter().zip(&radii_m);
        let above_m = above.map(|(link, radius_m)| {
            if stays_level(link, up) {
                f64::NEG_INFINITY
            } else {
                *radius_m
            }
        });
        // Two links with a short one between them are near in every pose.
        let are_near = |a: usize, b: usize| {
            let between = tree.links[b].parent;
            let grandparent = between.and_then(|between| tree.links[between].parent);
            let is_short = tree.links[b].place.translation.vector.norm() < radii_m[a] + radii_m[b];
            between == Some(a) || grandparent == Some(a) && is_short
        };
        let pairs = links
            .clone()
            .flat_map(|b| (0..b).map(move |a| (a, b)))
            .filter(|&(a, b)| !are_near(a, b));
        let mut clearance = Clearance {
            lines: links
                .clone()
                .map(|link| CentreLines::of(&tree, link))
                .collect(),
            up,
            apart_m: pairs
                .map(|(a, b)| ((a, b), radii_m[a] + radii_m[b]))
                .collect(),
            above_m: above_m.collect(),
            ranges_rad: model
                .robot
                .as_ref()
                .map_or(Vec::new(), |r| r.ranges.clone()),
        };
        for motion in motions {
            let plant = Plant::new(model, motion);
            for angle_rad in coordinates(&plant, motion) {
                clearance.allow(&angle_rad, &tree.poses(&angle_rad));
            }
        }
        Some(clearance)
    }

    /// The same over a plane at another height over the base's origin, m, or over none.
    pub fn over(mut self, floor_m: Option<f64>) -> Clearance {
        let floor_m = floor_m.unwrap_or(f64::NEG_INFINITY);
        self.above_m.iter_mut().for_each(|least| *least += floor_m);
        self
    }

    /// Allows what joints at these angles and links in these poses come to.
    fn allow(&mut self, angle_rad: &[f64], poses: &[Isometry3<f64>]) {
        for (range, angle) in self.ranges_rad.iter_mut().zip(angle_rad) {
            *range = range.map(|(low, high)| (low.min(*angle), high.max(*angle)));
        }
        let lines: Vec<Vec<Line>> = self.lines_at(poses);
        for ((a, b), least) in &mut self.apart_m {
            *least = least.min(nearest_m(&lines[*a], &lines[*b]));
        }
        for (link, least) in self.above_m.iter_mut().enumerate() {
            *least = least.min(height_m(&lines[link], self.up));
        }
    }

    /// What of it a motion of the model does not keep, in words that read on from "the model".
    /// Samples at which not every joint's angle is known say nothing.
    pub fn broken_by(&self, model: &Model, motion: &Motion) -> Option<String> {
        let tree = model.tree()?;
        let plant = Plant::new(model, motion);
        coordinates(&plant, motion).find_map(|angle_rad| {
            let lines = self.lines_at(&tree.poses(&angle_rad));
            let mut ranges = self.ranges_rad.iter().zip(&angle_rad);
            let beyond = ranges.position(|(range, angle)| is_beyond(*range, *angle));
            let mut apart = self.apart_m.iter();
            let near = apart.find(|((a, b), least)| nearest_m(&lines[*a], &lines[*b]) < *least);
            let mut above = self.above_m.iter().zip(&lines);
            let low = above.position(|(least, lines)| height_m(lines, self.up) < *least);
            let link = |link: usize| {
                let robot = model.robot.as_ref();
                robot.map_or("a link", |robot| robot.links[link].as_str())
            };
            if let Some(joint) = beyond {
                let joint = model.joint_name(joint).unwrap_or("a joint");
                Some(format!("turns {joint} beyond its end stop"))
            } else if let Some(((a, b), _)) = near {
                let (a, b) = (link(*a), link(*b));
                Some(format!("brings {a} and {b} too near to each other"))
            } else {
                low.map(|at| format!("dips {} into the plane that it stands on", link(at)))
            }
        })
    }

    fn lines_at(&self, poses: &[Isometry3<f64>]) -> Vec<Vec<Line>> {
        let placed = self.lines.iter().zip(poses).map(|(lines, pose)| {
            let joint = Point3::from(pose.translation.vector);
            let ends = lines.ends.iter().map(|end| [joint, pose * end]);
            ends.collect()
        });
        placed.collect()
    }
}

impl CentreLines {
    fn of(tree: &SpatialTree, link: usize) -> CentreLines {
        let children = tree.links.iter().filter(|next| next.parent == Some(link));
        let joints = children.map(|next| Point3::from(next.place.translation.vector));
        let mut ends: Vec<Point3<f64>> = joints.collect();
        // What ends with no joint reaches as far beyond its centre of mass.
        let beyond = if ends.is_empty() { 2.0 } else { 1.0 };
        ends.push(Point3::from(beyond * tree.links[link].com_m));
        CentreLines { ends }
    }
}

/// Radius of the solid cylinder whose moment about its axis is the link's least, m.
fn radius_m(link: &SpatialLink) -> f64 {
    let least_kg_m2 = link.inertia_kg_m2.symmetric_eigenvalues().min().max(0.0);
    if link.mass_kg > 0.0 {
        (2.0 * least_kg_m2 / link.mass_kg).sqrt()
    } else {
        0.0
    }
}

/// Whether a link of the base turns about the vertical, and so comes no lower than it stands.
fn stays_level(link: &SpatialLink, up: Option<Vector3<f64>>) -> bool {
    let axis = link.place * link.axis.into_inner();
    let is_upright = up.is_some_and(|up| axis.cross(&up).norm() < UPRIGHT);
    link.parent.is_none() && !link.slides && is_upright
}

fn is_beyond(range: Option<(f64, f64)>, angle: f64) -> bool {
    range.is_some_and(|(low, high)| !(low..=high).contains(&angle))
}

/// The angles of the links' joints at each sample at which all are known, rad.
fn coordinates<'a>(plant: &'a Plant, motion: &'a Motion) -> impl Iterator<Item = Vec<f64>> + 'a {
    (0..motion.len()).filter_map(|sample| {
        let readings = motion.position_rad.iter().map(|joint| joint[sample]);
        let readings: Vec<f64> = readings.collect();
        let is_known = readings.iter().all(|reading| reading.is_finite());
        is_known.then(|| plant.decode_rad(&readings))
    })
}

/// The least height of lines; infinite where nothing falls.
fn height_m(lines: &[Line], up: Option<Vector3<f64>>) -> f64 {
    let Some(up) = up else {
        return f64::INFINITY;
    };
    let ends = lines.iter().flatten().map(|end| end.coords.dot(&up));
    ends.fold(f64::INFINITY, f64::min)
}

/// The least distance of these lines from those.
fn nearest_m(these: &[Line], those: &[Line]) -> f64 {
    let pairs = these.iter().flat_map(|a| those.iter().map(move |b| (a, b)));
    pairs.fold(f64::INFINITY, |least, (a, b)| least.min(distance_m(a, b)))
}

/// Least distance of two lines between points: Ericson, Real-Time Collision Detection (2005),
/// section 5.1.9.
fn distance_m([a, a_end]: &Line, [b, b_end]: &Line) -> f64 {
    let (along_a, along_b, between) = (a_end - a, b_end - b, a - b);
    let (aa, bb, ab) = (
        along_a.norm_squared(),
        along_b.norm_squared(),
        along_a.dot(&along_b),
    );
    let (ar, br) = (along_a.dot(&between), along_b.dot(&between));
    let share = |of: f64, whole: f64| {
        if whole > 0.0 {
            (of / whole).clamp(0.0, 1.0)
        } else {
            0.0
        }
    };
    // Where they are parallel any place of the first serves.
    let mut on_a = share(ab * br - ar * bb, aa * bb - ab * ab);
    let on_b = share(ab * on_a + br, bb);
    on_a = share(ab * on_b - ar, aa);
    (between + along_a * on_a - along_b * on_b).norm()
}

#[cfg(test)]
mod tests;
