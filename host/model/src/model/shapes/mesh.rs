//! A surface of triangles, and a coarser one that looks the same from afar.

use std::collections::{HashMap, HashSet};

/// Cells along the longest side of the finest grid that is tried.
const FINEST: f64 = 2048.0;
/// Tries to meet a number of triangles.
const TRIES: usize = 8;

/// Triangles between shared corners.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Mesh {
    /// Corners, finite, in m.
    pub corners_m: Vec<[f32; 3]>,
    /// Numbers of three corners each, seen counter-clockwise from outside.
    pub triangles: Vec<[u32; 3]>,
}

impl Mesh {
    /// Of triangles by their corners, m; corners at one place become one, and triangles without an
    /// area go.
    pub fn of(triangles: impl IntoIterator<Item = [[f32; 3]; 3]>) -> Mesh {
        let mut mesh = Mesh::default();
        let mut numbers: HashMap<[u32; 3], u32> = HashMap::new();
        for corners in triangles {
            let triangle = corners.map(|corner| {
                // Of the two zeros one.
                let key = corner.map(|value| (value + 0.0).to_bits());
                *numbers.entry(key).or_insert_with(|| {
                    mesh.corners_m.push(corner);
                    mesh.corners_m.len() as u32 - 1
                })
            });
            if is_triangle(&triangle) {
                mesh.triangles.push(triangle);
            }
        }
        mesh
    }

    /// Its lowest and its highest coordinates, m; of no corner zeros.
    pub fn bounds_m(&self) -> [[f32; 3]; 2] {
        let Some(first) = self.corners_m.first() else {
            return [[0.0; 3]; 2];
        };
        let mut bounds = [*first; 2];
        for corner in &self.corners_m {
            for axis in 0..3 {
                bounds[0][axis] = bounds[0][axis].min(corner[axis]);
                bounds[1][axis] = bounds[1][axis].max(corner[axis]);
            }
        }
        bounds
    }

    /// A mesh of at most `most` triangles: corners within a cell of a grid become one, the finest
    /// grid that a few tries find (Rossignac and Borrel, 1993).
    pub fn thinned(&self, most: usize) -> Mesh {
        if self.triangles.len() <= most {
            return self.clone();
        }
        let mut best = Mesh::default();
        // A closed surface of n cells along has some 4 n^2 triangles.
        let mut cells = (most as f64 / 4.0).sqrt().clamp(1.0, FINEST);
        for _ in 0..TRIES {
            let tried = self.clustered(cells);
            let found = tried.triangles.len();
            let fits = found <= most;
            if fits && found > best.triangles.len() {
                best = tried;
            }
            let wanted = cells * (most as f64 / found.max(1) as f64).sqrt();
            let next = if fits { wanted * 0.99 } else { wanted * 0.95 };
            if (next / cells - 1.0).abs() < 0.02 || !(1.0..=FINEST).contains(&next) {
                break;
            }
            cells = next;
        }
        best
    }

    /// The mesh with one corner in each cell of a grid, `cells` along the longest side.
    fn clustered(&self, cells: f64) -> Mesh {
        let [low, high] = self.bounds_m();
        let longest = (0..3).fold(0.0, |most: f64, axis| {
            most.max(f64::from(high[axis]) - f64::from(low[axis]))
        });
        let cell = (longest / cells).max(f64::MIN_POSITIVE);
        let mut numbers: HashMap<[u32; 3], usize> = HashMap::new();
        let mut sums: Vec<([f64; 3], f64)> = Vec::new();
        let own: Vec<usize> = (self.corners_m.iter())
            .map(|corner| {
                let at: [u32; 3] = std::array::from_fn(|axis| {
                    ((f64::from(corner[axis]) - f64::from(low[axis])) / cell) as u32
                });
                let number = *numbers.entry(at).or_insert_with(|| {
                    sums.push(([0.0; 3], 0.0));
                    sums.len() - 1
                });
                let (sum, count) = &mut sums[number];
                for (sum, value) in sum.iter_mut().zip(corner) {
                    *sum += f64::from(*value);
                }
                *count += 1.0;
                number
            })
            .collect();
        let mean = |(sum, count): &([f64; 3], f64)| sum.map(|sum| (sum / count) as f32);
        let mut seen = HashSet::new();
        let clustered = self.triangles.iter().map(|triangle| {
            let corners = triangle.map(|corner| own[corner as usize] as u32);
            let mut sorted = corners;
            sorted.sort_unstable();
            (corners, sorted)
        });
        // What lay a cell apart now lies twice in one place.
        let kept = clustered.filter(|(own, sorted)| is_triangle(own) && seen.insert(*sorted));
        Mesh {
            triangles: kept.map(|(corners, _)| corners).collect(),
            corners_m: sums.iter().map(mean).collect(),
        }
        .without_loose_corners()
    }

    /// The mesh without corners of no triangle.
    fn without_loose_corners(self) -> Mesh {
        let mut numbers = vec![None; self.corners_m.len()];
        let mut corners_m = Vec::new();
        let triangles = self.triangles.iter().map(|triangle| {
            triangle.map(|corner| {
                *numbers[corner as usize].get_or_insert_with(|| {
                    corners_m.push(self.corners_m[corner as usize]);
                    corners_m.len() as u32 - 1
                })
            })
        });
        Mesh {
            triangles: triangles.collect(),
            corners_m,
        }
    }
}

fn is_triangle([a, b, c]: &[u32; 3]) -> bool {
    a != b && b != c && c != a
}
