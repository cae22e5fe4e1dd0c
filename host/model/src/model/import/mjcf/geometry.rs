//! Masses of shapes of even density.

use super::defaults::Attributes;
use super::orientation::{Compiler, along};
use crate::error::Result;
use crate::model::import::solid::Solid;
use crate::model::import::tree::Inertial;
use nalgebra::{Isometry3, Matrix3, Point3, Translation3, Vector3};

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
    let (pose, solid) = solid(own, compiler)?;
    let (volume, moments) = solid.volume();
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

/// A shape and its pose in the body's frame, whatever it weighs.
///
/// # Errors
/// Sizes that are none, meshes and other shapes that have none.
pub(in crate::model) fn solid(
    own: &Attributes,
    compiler: &Compiler,
) -> Result<(Isometry3<f64>, Solid)> {
    let kind = own.text("type").unwrap_or("sphere");
    let wrong = || {
        own.element
            .wrong(format!("the size of this {kind} is no size"), "mend size")
    };
    let mut size = own.numbers("size")?.unwrap_or_default();
    let mut pose = pose(own, compiler)?;
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
    let solid = match (kind, size.as_slice()) {
        ("sphere", [r]) => Solid::Ellipsoid {
            radii_m: Vector3::repeat(*r),
        },
        ("ellipsoid", [a, b, c]) => Solid::Ellipsoid {
            radii_m: Vector3::new(*a, *b, *c),
        },
        ("box", [a, b, c]) => Solid::Box {
            half_m: Vector3::new(*a, *b, *c),
        },
        ("cylinder", &[radius_m, half_m]) => Solid::Cylinder { radius_m, half_m },
        ("capsule", &[radius_m, half_m]) => Solid::Capsule { radius_m, half_m },
        _ => return Err(wrong()),
    };
    Ok((pose, solid))
}

/// Where a shape's frame stands in its body's.
///
/// # Errors
/// Numbers that are none.
pub(in crate::model) fn pose(own: &Attributes, compiler: &Compiler) -> Result<Isometry3<f64>> {
    Ok(Isometry3::from_parts(
        Translation3::from(own.vector("pos")?.unwrap_or_default()),
        compiler.orientation(own)?.unwrap_or_default(),
    ))
}

/// Whether a shape is of a group that has mass.
fn counts(own: &Attributes, compiler: &Compiler) -> Result<bool> {
    let Some((low, high)) = compiler.groups else {
        return Ok(true);
    };
    let group = own.number("group")?.unwrap_or(0.0);
    Ok((low..=high).contains(&group))
}
