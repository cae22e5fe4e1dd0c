//! The plane in which a chain moves.

use super::tree::{JointMotion, RobotTree};
use nalgebra::{Isometry3, Vector3};
use std::f64::consts::{PI, TAU};

/// Axes further apart than this are not parallel, rad. Files round their angles, to 1.571 or to
/// 1.57, and joints in a row add that up.
pub(super) const PARALLEL_RAD: f64 = 3e-3;
/// Less than this is the rounding of computing, rad.
const TOLD_RAD: f64 = 1e-9;
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
    let other = || {
        if first.x.abs() < 0.9 {
            Vector3::x()
        } else {
            Vector3::y()
        }
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

/// An angle for people, in degrees and rad.
fn in_words(angle_rad: f64) -> String {
    let degrees = angle_rad.to_degrees();
    if degrees < 1.0 {
        format!("{degrees:.2e} degrees ({angle_rad:.2e} rad)")
    } else {
        format!("{degrees:.1} degrees")
    }
}

/// Why joints make no planar chain.
pub(super) struct NotPlanar(pub String);

impl Frame {
    /// The plane across the axes of the chosen bodies' joints, and how far they are off it, in
    /// words, where they are. The gravity is in the world.
    pub fn of(
        tree: &RobotTree,
        chosen: &[usize],
        poses: &[Isometry3<f64>],
        gravity_m_s2: &Vector3<f64>,
    ) -> Result<(Self, Option<String>), NotPlanar> {
        let joint = |body: usize| &tree.bodies[body].joints[0];
        let axis_of = |body: usize| poses[body] * joint(body).axis;
        let slides = |body: usize| joint(body).motion == JointMotion::Slide;
        let Some(first) = chosen.iter().copied().find(|&body| !slides(body)) else {
            return Frame::of_slides(chosen, &axis_of, gravity_m_s2);
        };
        let axis = axis_of(first);
        let (mut most_rad, mut farthest) = (TOLD_RAD, None);
        for &body in chosen {
            let off_rad = if slides(body) {
                axis_of(body).dot(&axis).abs().min(1.0).asin()
            } else {
                axis_of(body).cross(&axis).norm().min(1.0).asin()
            };
            let (own, other) = (&joint(body).name, &joint(first).name);
            if off_rad > PARALLEL_RAD {
                let off = in_words(off_rad);
                return Err(NotPlanar(if slides(body) {
                    format!("joint {own} slides {off} out of the plane in which {other} turns")
                } else {
                    format!("joints {other} and {own} turn about axes {off} apart")
                }));
            }
            if off_rad > most_rad {
                let off = in_words(off_rad);
                most_rad = off_rad;
                farthest = Some(if slides(body) {
                    format!(
                        "joint {own} slides {off} out of the plane in which {other} turns; it is \
                     taken as within"
                    )
                } else {
                    format!(
                        "joints {other} and {own} turn about axes {off} apart, which are taken as \
                     parallel"
                    )
                });
            }
        }
        Ok((Frame::about(axis, gravity_m_s2), farthest))
    }

    /// The plane of joints that only slide.
    fn of_slides(
        chosen: &[usize],
        axis_of: &dyn Fn(usize) -> Vector3<f64>,
        gravity_m_s2: &Vector3<f64>,
    ) -> Result<(Self, Option<String>), NotPlanar> {
        let along: Vec<Vector3<f64>> = chosen.iter().map(|&body| axis_of(body)).collect();
        let axis = across(&along, gravity_m_s2);
        let off = along.iter().map(|along| along.dot(&axis).abs());
        let most_rad = off.fold(0.0, f64::max).min(1.0).asin();
        let off = in_words(most_rad);
        match most_rad {
            most if most > PARALLEL_RAD => Err(NotPlanar(format!(
                "the slides named lie in no plane: they are up to {off} off one"
            ))),
            most => {
                let told = (most > TOLD_RAD)
                    .then(|| format!("the slides are up to {off} off a plane, taken as within"));
                Ok((Frame::about(axis, gravity_m_s2), told))
            }
        }
    }

    /// The plane across an axis.
    fn about(axis: Vector3<f64>, gravity_m_s2: &Vector3<f64>) -> Self {
        let within = gravity_m_s2 - axis * axis.dot(gravity_m_s2);
        let gravity_m_s2 = within.norm();
        let up = if gravity_m_s2 > NO_GRAVITY_M_S2 {
            -within / gravity_m_s2
        } else {
            let other = if axis.x.abs() < 0.9 {
                Vector3::x()
            } else {
                Vector3::y()
            };
            axis.cross(&other).normalize()
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
