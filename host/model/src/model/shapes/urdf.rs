//! What a URDF's links look like: `<visual>` and `<collision>`.

use super::drawn::{Described, Drawn, DrawnShape, Looks};
use crate::error::Result;
use crate::model::import::Solid;
use crate::model::import::urdf::pose;
use crate::model::import::xml::Element;
use nalgebra::Vector3;

/// The shapes of a link's element, those that say nothing readable as errors.
pub(super) fn shapes(link: Element) -> Vec<Described> {
    let of = |tag: &'static str, looks: Looks| {
        link.all(tag)
            .filter_map(move |own| Some((looks, shape(own).transpose()?)))
    };
    let visual = of("visual", Looks::Visual);
    visual.chain(of("collision", Looks::Collision)).collect()
}

/// The shape of a `<visual>`; none where it has none.
fn shape(own: Element) -> Result<Option<Drawn>> {
    let pose = pose(own.first("origin"))?;
    let geometry = own.first("geometry");
    let Some(found) = geometry.and_then(|geometry| geometry.elements().next()) else {
        return Ok(None);
    };
    let size = |key: &str| {
        let lacks = || {
            found.wrong(
                format!("<{}> lacks {key}", found.tag()),
                format!("add {key}"),
            )
        };
        let value = found.number(key)?.ok_or_else(lacks)?;
        positive(found, value)
    };
    let shape = match found.tag() {
        "mesh" => DrawnShape::Mesh {
            name: found.required("filename")?.to_string(),
            scale: found.vector("scale")?.unwrap_or(Vector3::repeat(1.0)),
        },
        "box" => {
            found.required("size")?;
            let size = found.vector("size")?.unwrap_or_default();
            positive(found, size.min())?;
            DrawnShape::Solid(Solid::Box { half_m: size / 2.0 })
        }
        "sphere" => DrawnShape::Solid(Solid::Ellipsoid {
            radii_m: Vector3::repeat(size("radius")?),
        }),
        "cylinder" => DrawnShape::Solid(Solid::Cylinder {
            radius_m: size("radius")?,
            half_m: size("length")? / 2.0,
        }),
        "capsule" => DrawnShape::Solid(Solid::Capsule {
            radius_m: size("radius")?,
            half_m: size("length")? / 2.0,
        }),
        other => {
            let what = format!("<{other}> is not drawn");
            return Err(found.wrong(what, "give a mesh, a box, a sphere or a cylinder"));
        }
    };
    Ok(Some(Drawn { pose, shape }))
}

fn positive(element: Element, value: f64) -> Result<f64> {
    if value > 0.0 {
        Ok(value)
    } else {
        Err(element.wrong("a size that is not above 0", "mend the size"))
    }
}
