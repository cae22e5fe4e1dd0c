//! The plane in which a chain moves.

use super::tree::{JointMotion, RobotTree};
use crate::error::{Error, Result};
use nalgebra::{Isometry3, Vector3};
use std::f64::consts::{PI, TAU};

/// Axes further apart than this are not parallel, rad; files round to six digits.
pub(super) const PARALLEL_RAD: f64 = 1e-5;
/// Gravity less than this is none, m/s^2.
const NO_GRAVITY_M_S2: f64 = 1e-6;

/// An angle within half a turn either way.
pub(super) fn wrapped(angle_rad: f64) -> f64 {
    let angle = angle_rad.rem_euclid(TAU);
    if angle > PI { angle - TAU } else { angle }
}

/// A direction across slides, of which one alone moves in the plane of gravity.
fn across(along: &[Vector3<f64>], gravity_m_s2: &Vector3<f64>) -> Vector3<f64> {
    let first = along[0];
    let longest = |others: &[Vector3<f64>]| {
        let normals = others.iter().map(|other| first.cross(other));
        let longest = normals.max_by(|a, b| a.norm().total_cmp(&b.norm()));
        longest.filter(|normal| normal.norm() > PARALLEL_RAD)
    };
    let normal = longest(&along[1..]).or_else(|| longest(&[*gravity_m_s2]));
    let other = || match first.x.abs() < 0.9 {
        true => Vector3::x(),
        false => Vector3::y(),
    };
    normal.unwrap_or_else(|| first.cross(&other())).normalize()
}

/// The plane: x to the right, up against gravity, the axis towards the one who looks.
pub(super) struct Frame {
    pub axis: Vector3<f64>,
    right: Vector3<f64>,
    up: Vector3<f64>,
    pub gravity_m_s2: f64,
}

impl Frame {
    /// The plane across the axes of the chosen bodies' joints.
    ///
    /// # Errors
    /// Axes that are not parallel.
    pub fn of(
        tree: &RobotTree,
        chosen: &[usize],
        poses: &[Isometry3<f64>],
        file: &str,
    ) -> Result<Self> {
        let axis_of = |body: usize| poses[body] * tree.bodies[body].joints[0].axis;
        let slides = |body: usize| tree.bodies[body].joints[0].motion == JointMotion::Slide;
        let hinge = chosen.iter().copied().find(|&body| !slides(body));
        let name = |body: usize| &tree.bodies[body].joints[0].name;
        let Some(first) = hinge else {
            let along: Vec<Vector3<f64>> = chosen.iter().map(|&body| axis_of(body)).collect();
            let axis = across(&along, &tree.gravity_m_s2);
            return match along
                .iter()
                .all(|along| along.dot(&axis).abs() < PARALLEL_RAD)
            {
                true => Ok(Frame::about(axis, tree)),
                false => Err(Error::usage(
                    format!("{file}: the slides named lie in no plane"),
                    "a chain here is planar: choose slides in one plane by --joints",
                )),
            };
        };
        let axis = axis_of(first);
        for &body in chosen {
            if slides(body) {
                if axis_of(body).dot(&axis).abs() > PARALLEL_RAD {
                    return Err(Error::usage(
                        format!(
                            "{file}: joint {} slides out of the plane in which {} turns",
                            name(body),
                            name(first)
                        ),
                        "a chain here is planar: choose other joints by --joints",
                    ));
                }
                continue;
            }
            let apart = axis_of(body).cross(&axis).norm().min(1.0).asin();
            if apart > PARALLEL_RAD {
                return Err(Error::usage(
                    format!(
                        "{file}: joints {} and {} turn about axes {:.1} degrees apart",
                        name(first),
                        name(body),
                        apart.to_degrees()
                    ),
                    "a chain here is planar: choose joints with parallel axes by --joints",
                ));
            }
        }
        Ok(Frame::about(axis, tree))
    }

    /// The plane across an axis.
    fn about(axis: Vector3<f64>, tree: &RobotTree) -> Self {
        let within = tree.gravity_m_s2 - axis * axis.dot(&tree.gravity_m_s2);
        let gravity_m_s2 = within.norm();
        let up = match gravity_m_s2 > NO_GRAVITY_M_S2 {
            true => -within / gravity_m_s2,
            // Any direction across the axis.
            false => {
                let other = if axis.x.abs() < 0.9 {
                    Vector3::x()
                } else {
                    Vector3::y()
                };
                axis.cross(&other).normalize()
            }
        };
        Frame {
            axis,
            right: up.cross(&axis),
            up,
            gravity_m_s2: if gravity_m_s2 > NO_GRAVITY_M_S2 {
                gravity_m_s2
            } else {
                0.0
            },
        }
    }

    /// Length of a vector in the plane, m, and its angle from hanging, rad, counter-clockwise.
    pub fn seen(&self, vector: &Vector3<f64>) -> (f64, f64) {
        let (x, y) = (self.right.dot(vector), self.up.dot(vector));
        (x.hypot(y), x.atan2(-y))
    }
}
