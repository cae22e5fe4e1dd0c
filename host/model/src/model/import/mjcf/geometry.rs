//! Masses of shapes of even density.

use super::defaults::Attributes;
use super::orientation::{Compiler, along};
use crate::error::Result;
use crate::model::import::tree::Inertial;
use nalgebra::{Isometry3, Matrix3, Point3, Translation3, Vector3};
use std::f64::consts::PI;

/// Of water, as in MuJoCo, kg/m^3.
const DENSITY: f64 = 1000.0;

/// A shape's mass; none of planes and height fields.
///
/// # Errors
/// Meshes and other shapes whose mass the file does not say.
pub(super) fn inertial(own: &Attributes, compiler: &Compiler) -> Result<Inertial> {
    let kind = own.text("type").unwrap_or("sphere");
    let massless = |key: &str| own.number(key).map(|value| value == Some(0.0));
    let light = massless("mass")? || own.text("mass").is_none() && massless("density")?;
    if ["plane", "hfield"].contains(&kind) || light || !counts(own, compiler)? {
        return Ok(Inertial::NONE);
    }
    if own.text("mesh").is_some() || ["mesh", "sdf"].contains(&kind) {
        let what = match own.text("mass") {
            None => "the mass of a mesh is not in the file",
            Some(_) => "of this mesh the file has the mass, not its centre and moments",
        };
        return Err(own.element.wrong(what, super::FLATTEN));
    }
    if own.text("shellinertia") == Some("true") {
        return Err(own
            .element
            .wrong("the mass of a shell is not read", super::FLATTEN));
    }
    let wrong = || {
        own.element
            .wrong(format!("the size of this {kind} is no size"), "mend size")
    };
    let mut size = own.numbers("size")?.unwrap_or_default();
    let mut pose = Isometry3::from_parts(
        Translation3::from(own.vector("pos")?.unwrap_or_default()),
        compiler.orientation(own)?.unwrap_or_default(),
    );
    if let Some(ends) = own.numbers("fromto")? {
        let [a, b, c, d, e, f] = ends[..] else {
            return Err(wrong());
        };
        let (from, to) = (Vector3::new(a, b, c), Vector3::new(d, e, f));
        // MuJoCo lays z from the second end to the first; shapes are the same both ways.
        let turn = along((from - to).try_normalize(1e-12).ok_or_else(wrong)?);
        pose = Isometry3::from_parts(Translation3::from((from + to) / 2.0), turn);
        let half = (from - to).norm() / 2.0;
        let radius = *size.first().ok_or_else(wrong)?;
        size = match kind {
            "capsule" | "cylinder" => vec![radius, half],
            _ => vec![radius, radius, half],
        };
    }
    // Writers fill up with zeros what a shape does not take.
    size.truncate(match kind {
        "sphere" => 1,
        "capsule" | "cylinder" => 2,
        _ => 3,
    });
    if size.iter().any(|size| *size <= 0.0) {
        return Err(wrong());
    }
    let (volume, moments) = match (kind, size.as_slice()) {
        ("sphere", [r]) => (4.0 / 3.0 * PI * r.powi(3), Vector3::repeat(0.4 * r * r)),
        ("ellipsoid", [a, b, c]) => (4.0 / 3.0 * PI * a * b * c, squares(*a, *b, *c) / 5.0),
        ("box", [a, b, c]) => (8.0 * a * b * c, squares(*a, *b, *c) / 3.0),
        ("cylinder", [r, half]) => {
            let across = r * r / 4.0 + half * half / 3.0;
            (
                2.0 * PI * r * r * half,
                Vector3::new(across, across, r * r / 2.0),
            )
        }
        ("capsule", [r, half]) => capsule(*r, *half),
        _ => return Err(wrong()),
    };
    let density = own.number("density")?.unwrap_or(DENSITY);
    let mass_kg = own.number("mass")?.unwrap_or(density * volume);
    if mass_kg < 0.0 {
        return Err(own.element.wrong("a mass below 0", "mend its sign"));
    }
    let shape = Inertial {
        mass_kg,
        com_m: Point3::origin(),
        inertia_kg_m2: Matrix3::from_diagonal(&(moments * mass_kg)),
    };
    Ok(shape.seen_from(&pose))
}

/// Whether a shape is of a group that has mass.
fn counts(own: &Attributes, compiler: &Compiler) -> Result<bool> {
    let Some((low, high)) = compiler.groups else {
        return Ok(true);
    };
    let group = own.number("group")?.unwrap_or(0.0);
    Ok((low..=high).contains(&group))
}

/// b^2 + c^2 and so on round.
fn squares(a: f64, b: f64, c: f64) -> Vector3<f64> {
    Vector3::new(b * b + c * c, a * a + c * c, a * a + b * b)
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
