//! Shapes of even density as robots' files describe them.

use nalgebra::Vector3;
use std::f64::consts::PI;

/// A simple shape about its centre; what is long is so along z. Lengths in m, all above 0.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Solid {
    /// A box.
    Box {
        /// Half its edges.
        half_m: Vector3<f64>,
    },
    /// A ball where its radii are equal.
    Ellipsoid {
        /// Along its axes.
        radii_m: Vector3<f64>,
    },
    /// A cylinder.
    Cylinder {
        /// Of its circle.
        radius_m: f64,
        /// Half its height.
        half_m: f64,
    },
    /// A cylinder between two half balls.
    Capsule {
        /// Of cylinder and balls.
        radius_m: f64,
        /// Half the cylinder's height.
        half_m: f64,
    },
}

impl Solid {
    /// Volume, m^3, and moments of inertia about its axes per mass, m^2.
    pub(super) fn volume(&self) -> (f64, Vector3<f64>) {
        match *self {
            Solid::Box { half_m: half } => (8.0 * half.product(), squares(half) / 3.0),
            Solid::Ellipsoid { radii_m: radii } => {
                (4.0 / 3.0 * PI * radii.product(), squares(radii) / 5.0)
            }
            Solid::Cylinder {
                radius_m: r,
                half_m: half,
            } => {
                let across = r * r / 4.0 + half * half / 3.0;
                let moments = Vector3::new(across, across, r * r / 2.0);
                (2.0 * PI * r * r * half, moments)
            }
            Solid::Capsule {
                radius_m: r,
                half_m: half,
            } => capsule(r, half),
        }
    }
}

/// b^2 + c^2 and so on round.
fn squares(sides: Vector3<f64>) -> Vector3<f64> {
    let own = sides.component_mul(&sides);
    Vector3::new(own.y + own.z, own.x + own.z, own.x + own.y)
}

/// Volume, and moments per mass: a cylinder of height 2 h between two half balls.
fn capsule(r: f64, h: f64) -> (f64, Vector3<f64>) {
    let (cylinder, balls) = (2.0 * PI * r * r * h, 4.0 / 3.0 * PI * r.powi(3));
    let volume = cylinder + balls;
    // A half ball's centre of mass lies 3 r / 8 above its flat side.
    let across =
        cylinder * (r * r / 4.0 + h * h / 3.0) + balls * (0.4 * r * r + h * h + 0.75 * h * r);
    let about = cylinder * r * r / 2.0 + balls * 0.4 * r * r;
    (volume, Vector3::new(across, across, about) / volume)
}
