//! A mesh as text: coordinates and corners in 16 bits, Base64.

use crate::model::shapes::Mesh;
use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use serde::Serialize;

/// Steps of a coordinate from the lowest to the highest.
const STEPS: f64 = 65535.0;

/// A mesh of up to 65536 corners.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct PackedMesh {
    /// Lowest coordinates, m.
    pub low_m: [f64; 3],
    /// From the lowest to the highest, m.
    pub size_m: [f64; 3],
    /// Corners: x, y, z of each as shares of `size_m`, 16 bits, little-endian, in Base64.
    pub corners: String,
    /// Triangles: three numbers of corners each, in the same form.
    pub triangles: String,
}

impl PackedMesh {
    /// The mesh with coordinates to 1/65535 of its size; what names a corner beyond the 65536th is
    /// left out.
    pub(super) fn of(mesh: &Mesh) -> PackedMesh {
        let [low, high] = mesh.bounds_m().map(|corner| corner.map(f64::from));
        let size: [f64; 3] = std::array::from_fn(|axis| high[axis] - low[axis]);
        let share = |value: f32, axis: usize| {
            let share = (f64::from(value) - low[axis]) / size[axis].max(f64::MIN_POSITIVE);
            (share * STEPS).round() as u16
        };
        let corners = mesh.corners_m.iter().take(1 << 16);
        let corners = corners.flat_map(|corner| [0, 1, 2].map(|axis| share(corner[axis], axis)));
        let triangles = (mesh.triangles.iter())
            .filter_map(|triangle| {
                let [a, b, c] = triangle.map(|corner| u16::try_from(corner).ok());
                Some([a?, b?, c?])
            })
            .flatten();
        PackedMesh {
            low_m: low.map(rounded),
            size_m: size.map(rounded),
            corners: text(corners),
            triangles: text(triangles),
        }
    }
}

/// To a micrometre.
pub(super) fn rounded(value_m: f64) -> f64 {
    (value_m * 1e6).round() / 1e6
}

fn text(numbers: impl Iterator<Item = u16>) -> String {
    let bytes: Vec<u8> = numbers.flat_map(u16::to_le_bytes).collect();
    STANDARD.encode(bytes)
}
