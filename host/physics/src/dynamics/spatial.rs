//! A tree of rigid links in space: hinges and slides about any axis, on a fixed base.

mod at_pose;
mod carried;
mod equations;
mod small;

pub use at_pose::TreeAtPose;
pub use equations::{SpatialEquations, SpatialWorkspace};

use nalgebra::{Isometry3, Matrix3, Point3, Unit, UnitQuaternion, Vector3};

/// A tree on a fixed base. A joint's number is that of the link it carries.
///
/// Where a joint slides, its place among the angles, rad, is a displacement, m, that among the
/// speeds, rad/s, one in m/s, and that among the torques, N m, a force, N.
#[derive(Debug, Clone, PartialEq)]
pub struct SpatialTree {
    /// Links, each behind the one that carries it.
    pub links: Vec<SpatialLink>,
    /// Acceleration of free fall, m/s^2, in the base's frame.
    pub gravity_m_s2: Vector3<f64>,
}

/// One link and the joint that carries it.
#[derive(Debug, Clone, PartialEq)]
pub struct SpatialLink {
    /// The link that carries it, a smaller number than its own; none of the base.
    pub parent: Option<usize>,
    /// Where its frame stands in the parent's while the joint is at 0.
    pub place: Isometry3<f64>,
    /// About what the joint turns, or along what it slides, in the link's frame.
    pub axis: Unit<Vector3<f64>>,
    /// Whether it slides.
    pub slides: bool,
    /// Mass, kg.
    pub mass_kg: f64,
    /// Centre of mass in the link's frame, m.
    pub com_m: Vector3<f64>,
    /// Moments of inertia about the centre of mass along the link's axes, kg m^2.
    pub inertia_kg_m2: Matrix3<f64>,
    /// Rotor's inertia reflected through the gear, kg m^2: counts in the joint's own acceleration
    /// only. Of a slide in kg.
    pub armature_kg_m2: f64,
}

impl SpatialLink {
    /// Where the link's frame stands in the parent's.
    fn stands(&self, coordinate: f64) -> Isometry3<f64> {
        if self.slides {
            let along = self.axis.into_inner() * coordinate;
            return self.place * Isometry3::translation(along.x, along.y, along.z);
        }
        self.place * UnitQuaternion::from_axis_angle(&self.axis, coordinate)
    }
}

impl SpatialTree {
    /// Number of links.
    pub fn len(&self) -> usize {
        self.links.len()
    }

    /// Whether there is no link.
    pub fn is_empty(&self) -> bool {
        self.links.is_empty()
    }

    /// Adds a point mass to a link, at this place in its frame, m.
    pub fn bolt_on(&mut self, link: usize, mass_kg: f64, at_m: Vector3<f64>) {
        let Some(link) = self.links.get_mut(link) else {
            return;
        };
        let total_kg = link.mass_kg + mass_kg;
        let com_m = (link.mass_kg * link.com_m + mass_kg * at_m) / total_kg;
        link.inertia_kg_m2 +=
            about(link.mass_kg, link.com_m - com_m) + about(mass_kg, at_m - com_m);
        (link.mass_kg, link.com_m) = (total_kg, com_m);
    }

    /// Poses of the links' frames in the base's.
    pub fn poses(&self, angle_rad: &[f64]) -> Vec<Isometry3<f64>> {
        let mut poses: Vec<Isometry3<f64>> = Vec::with_capacity(self.links.len());
        for (link, coordinate) in self.links.iter().zip(angle_rad) {
            let parent = link.parent.map_or_else(Isometry3::identity, |p| poses[p]);
            poses.push(parent * link.stands(*coordinate));
        }
        poses
    }

    /// Kinetic and potential energy, J; the potential is zero with all masses at the base.
    pub fn energy_j(&self, angle_rad: &[f64], speed_rad_s: &[f64]) -> (f64, f64) {
        let poses = self.poses(angle_rad);
        let (mut kinetic, mut potential) = (0.0, 0.0);
        // Of each link's frame in the base's axes: its angular velocity, and its origin's.
        let mut speeds: Vec<[Vector3<f64>; 2]> = Vec::with_capacity(self.links.len());
        for (i, link) in self.links.iter().enumerate() {
            let at = poses[i].translation.vector;
            let (mut turning, mut shifting) = (Vector3::zeros(), Vector3::zeros());
            if let Some(parent) = link.parent {
                let [turns, shifts] = speeds[parent];
                turning = turns;
                shifting = shifts + turns.cross(&(at - poses[parent].translation.vector));
            }
            let own = poses[i] * link.axis.into_inner() * speed_rad_s[i];
            *(if link.slides {
                &mut shifting
            } else {
                &mut turning
            }) += own;
            speeds.push([turning, shifting]);
            let com = poses[i] * Point3::from(link.com_m);
            let com_m_s = shifting + turning.cross(&(com.coords - at));
            let turns = poses[i].inverse_transform_vector(&turning);
            kinetic += 0.5
                * (link.mass_kg * com_m_s.norm_squared()
                    + turns.dot(&(link.inertia_kg_m2 * turns))
                    + link.armature_kg_m2 * speed_rad_s[i] * speed_rad_s[i]);
            potential -= link.mass_kg * self.gravity_m_s2.dot(&com.coords);
        }
        (kinetic, potential)
    }
}

/// Moments of inertia of a point mass about a point from which it lies `arm_m`, kg m^2.
fn about(mass_kg: f64, arm_m: Vector3<f64>) -> Matrix3<f64> {
    mass_kg * (Matrix3::from_diagonal_element(arm_m.norm_squared()) - arm_m * arm_m.transpose())
}

#[cfg(test)]
mod tests;
