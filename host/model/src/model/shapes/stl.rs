//! STL, binary and ASCII.
//!
//! A binary file has 80 bytes of header, the number of its triangles, and 50 bytes of each: a
//! normal, three corners, two bytes of attributes; numbers are 32 bits, little-endian. An ASCII
//! file has `facet`, `outer loop`, three times `vertex x y z`, `endloop`, `endfacet`.

use super::mesh::Mesh;

const HEADER: usize = 80;
const TRIANGLE: usize = 50;
/// A corner farther off is none of a robot's, m or mm.
const FARTHEST: f32 = 1e6;
/// Words that begin a line of an ASCII file and say nothing of corners.
const OTHER_WORDS: [&str; 6] = ["solid", "facet", "outer", "endloop", "endfacet", "endsolid"];

/// The surface in a file's bytes. Nothing is set aside for what the file only promises.
///
/// # Errors
/// Bytes that are no STL, fewer or more of them than the number of triangles asks for, corners that
/// are no numbers.
pub fn read_stl(bytes: &[u8]) -> Result<Mesh, String> {
    let promised = bytes
        .get(HEADER..HEADER + 4)
        .map(|count| u32::from_le_bytes([count[0], count[1], count[2], count[3]]) as usize);
    let body = bytes.get(HEADER + 4..).unwrap_or_default();
    let is_whole = promised.is_some_and(|count| count.checked_mul(TRIANGLE) == Some(body.len()));
    // Headers of binary files begin with "solid", too.
    if !is_whole && bytes.trim_ascii_start().starts_with(b"solid") {
        return ascii(bytes);
    }
    let promised = promised.ok_or("no STL")?;
    if !is_whole {
        return Err(format!(
            "says {promised} triangles and holds {} and {} bytes",
            body.len() / TRIANGLE,
            body.len() % TRIANGLE
        ));
    }
    let triangles = body.chunks_exact(TRIANGLE).map(|triangle| {
        std::array::from_fn(|corner| {
            std::array::from_fn(|axis| {
                let at = 12 + 12 * corner + 4 * axis;
                let own = [0, 1, 2, 3].map(|byte| triangle[at + byte]);
                f32::from_le_bytes(own)
            })
        })
    });
    made(triangles.collect())
}

fn ascii(bytes: &[u8]) -> Result<Mesh, String> {
    let (mut triangles, mut corners) = (Vec::new(), Vec::new());
    for (line, text) in (1..).zip(bytes.split(|byte| *byte == b'\n')) {
        let wrong = |what: &str| format!("line {line}: {what}");
        let text = String::from_utf8_lossy(text);
        let mut words = text.split_whitespace();
        match words.next() {
            Some("vertex") => {
                let numbers: Vec<f32> = words.map_while(|word| word.parse().ok()).collect();
                let [x, y, z] = numbers[..] else {
                    return Err(wrong("a vertex has three numbers"));
                };
                corners.push([x, y, z]);
            }
            Some(word) if !OTHER_WORDS.contains(&word) => {
                return Err(wrong("no part of an ASCII STL"));
            }
            Some("endloop" | "endfacet") => {
                if let [a, b, c] = corners[..] {
                    triangles.push([a, b, c]);
                } else if !corners.is_empty() {
                    return Err(wrong("a facet has three corners"));
                }
                corners.clear();
            }
            Some(_) | None => {}
        }
    }
    if corners.is_empty() {
        made(triangles)
    } else {
        Err("ends within a facet".into())
    }
}

/// The mesh of triangles that are real.
fn made(triangles: Vec<[[f32; 3]; 3]>) -> Result<Mesh, String> {
    let is_far = |value: &f32| !value.is_finite() || value.abs() > FARTHEST;
    let wrong = |triangle: &[[f32; 3]; 3]| triangle.as_flattened().iter().any(is_far);
    if let Some(at) = triangles.iter().position(wrong) {
        return Err(format!("a corner of triangle {} is no place", at + 1));
    }
    let mesh = Mesh::of(triangles);
    if mesh.triangles.is_empty() {
        Err("has no triangle".into())
    } else {
        Ok(mesh)
    }
}
