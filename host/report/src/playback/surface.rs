//! Simple solids as triangles.

use crate::model::shapes::{Mesh, Solid};
use nalgebra::Vector3;
use std::f64::consts::{FRAC_PI_2, TAU};

/// Corners round a circle.
const ROUND: usize = 20;
/// Rings from a ball's pole to its equator.
const RINGS: usize = 5;

/// The surface of a solid about its centre, m.
pub(super) fn surface(solid: &Solid) -> Mesh {
    let outline = match *solid {
        Solid::Box { half_m } => return cuboid(half_m),
        Solid::Ellipsoid { radii_m } => {
            let ball = turned(&half_circle(1.0, 0.0));
            let scaled = |corner: [f32; 3]| {
                let own: [f64; 3] = radii_m.into();
                std::array::from_fn(|axis| (f64::from(corner[axis]) * own[axis]) as f32)
            };
            return Mesh {
                corners_m: ball.corners_m.into_iter().map(scaled).collect(),
                ..ball
            };
        }
        Solid::Cylinder { radius_m, half_m } => vec![
            (0.0, -half_m),
            (radius_m, -half_m),
            (radius_m, half_m),
            (0.0, half_m),
        ],
        Solid::Capsule { radius_m, half_m } => half_circle(radius_m, half_m),
    };
    turned(&outline)
}

/// Half a circle from the lower pole to the upper one, its halves this far above and below the
/// centre: radius and height of each corner, m.
fn half_circle(radius_m: f64, half_m: f64) -> Vec<(f64, f64)> {
    let mut corners = Vec::with_capacity(2 * RINGS + 2);
    for (sign, rings) in [
        (-1.0, (0..=RINGS).rev().collect::<Vec<_>>()),
        (1.0, (0..=RINGS).collect()),
    ] {
        for ring in rings {
            let angle = FRAC_PI_2 * ring as f64 / RINGS as f64;
            let across = if ring == RINGS { 0.0 } else { angle.cos() };
            corners.push((radius_m * across, sign * (half_m + radius_m * angle.sin())));
        }
    }
    corners
}

/// The surface that an outline makes which turns about z, from below upwards.
fn turned(outline: &[(f64, f64)]) -> Mesh {
    let corner = |&(radius, height): &(f64, f64), step: usize| {
        let angle = TAU * (step % ROUND) as f64 / ROUND as f64;
        [radius * angle.cos(), radius * angle.sin(), height].map(|value| value as f32)
    };
    let mut triangles = Vec::new();
    for pair in outline.windows(2) {
        for step in 0..ROUND {
            let [a, b] = [step, step + 1].map(|step| corner(&pair[0], step));
            let [c, d] = [step, step + 1].map(|step| corner(&pair[1], step));
            triangles.push([a, b, d]);
            triangles.push([a, d, c]);
        }
    }
    Mesh::of(triangles)
}

fn cuboid(half_m: Vector3<f64>) -> Mesh {
    let mut triangles = Vec::new();
    for axis in 0..3 {
        let (next, last) = ((axis + 1) % 3, (axis + 2) % 3);
        for side in [-1.0, 1.0] {
            let corner = |across: f64, along: f64| {
                let mut corner = [0.0; 3];
                corner[axis] = side * half_m[axis];
                corner[next] = side * across * half_m[next];
                corner[last] = along * half_m[last];
                corner.map(|value: f64| value as f32)
            };
            let [a, b] = [corner(-1.0, -1.0), corner(1.0, -1.0)];
            let [c, d] = [corner(1.0, 1.0), corner(-1.0, 1.0)];
            triangles.push([a, b, c]);
            triangles.push([a, c, d]);
        }
    }
    Mesh::of(triangles)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    /// Volume within, m^3: above 0 where triangles are seen counter-clockwise from outside.
    fn volume(mesh: &Mesh) -> f64 {
        let corner = |number: u32| Vector3::from(mesh.corners_m[number as usize].map(f64::from));
        let of = |triangle: &[u32; 3]| {
            let [a, b, c] = triangle.map(corner);
            a.dot(&b.cross(&c)) / 6.0
        };
        mesh.triangles.iter().map(of).sum()
    }

    #[test]
    fn surfaces_are_closed_and_hold_nearly_their_volume() {
        let half = Vector3::new(0.1, 0.2, 0.3);
        let (radius_m, half_m) = (0.1, 0.4);
        let ball = 4.0 / 3.0 * PI * 1e-3;
        for (solid, wanted) in [
            (Solid::Box { half_m: half }, 8.0 * 0.006),
            (Solid::Ellipsoid { radii_m: half }, 4.0 / 3.0 * PI * 0.006),
            (Solid::Cylinder { radius_m, half_m }, PI * 0.01 * 0.8),
            (Solid::Capsule { radius_m, half_m }, PI * 0.01 * 0.8 + ball),
        ] {
            let mesh = surface(&solid);
            let found = volume(&mesh);
            assert!(
                (found / wanted - 1.0).abs() < 0.06,
                "{solid:?}: {found} {wanted}"
            );
            // Euler: of a closed surface without holes.
            let (corners, triangles) = (mesh.corners_m.len(), mesh.triangles.len());
            assert_eq!(corners + triangles, triangles / 2 * 3 + 2, "{solid:?}");
        }
    }
}
