//! Masses, centres of mass and moments of inertia of a robot's bodies, as a model has them.

use super::edits::Edits;
use super::{Source, is_near, rounded};
use crate::dynamics::{SpatialLink, SpatialTree};
use crate::model::export::xml::{number, numbers};
use crate::model::import::tree::{Inertial, TreeBody};
use crate::model::import::xml::Element;
use nalgebra::{Isometry3, Vector3};

/// A centre of mass moves farther than this, or not at all, m: less is rounding of poses.
const NOISE_M: f64 = 1e-14;

/// How the bodies that make up one link change.
///
/// The link's mass is to be so many times the file's, its moments of inertia so many times theirs,
/// and its centre of mass elsewhere. Every body takes both factors, and the distances of their
/// centres from the link's grow alike: so the sum is right, the moments of each body stay those of
/// a body, and what is turned stays turned as it was.
struct Change {
    mass: f64,
    moments: f64,
    /// Centre of mass of the link, before and after, in its frame, m.
    from_m: Vector3<f64>,
    to_m: Vector3<f64>,
}

impl Change {
    /// What a link needs; none where it is as in the file.
    fn of(file: &SpatialLink, own: &SpatialLink) -> Option<Change> {
        if file.mass_kg <= 0.0 {
            return None;
        }
        let share = |own: f64, file: f64| if is_near(own, file) { 1.0 } else { own / file };
        let shift_m = own.com_m - file.com_m;
        let stays = shift_m.norm() <= super::ROUNDED * file.com_m.norm();
        let change = Change {
            mass: share(own.mass_kg, file.mass_kg),
            moments: share(own.inertia_kg_m2.trace(), file.inertia_kg_m2.trace()),
            from_m: file.com_m,
            to_m: if stays { file.com_m } else { own.com_m },
        };
        let is_none = change.mass == 1.0 && change.moments == 1.0 && stays;
        (!is_none).then_some(change)
    }

    /// A body's values, in its own frame; the frame stands so in the link's.
    fn applied(&self, body: &Inertial, stands: &Isometry3<f64>) -> Inertial {
        let arm_m = (stands * body.com_m).coords - self.from_m;
        // Moments of a mass far from the centre are its distance squared.
        let reach = if self.mass > 0.0 {
            (self.moments / self.mass).sqrt()
        } else {
            1.0
        };
        let shift_m = self.to_m - self.from_m + arm_m * (reach - 1.0);
        let com_m = if shift_m.norm() <= NOISE_M {
            body.com_m
        } else {
            (body.com_m + stands.rotation.inverse() * shift_m).map(rounded)
        };
        Inertial {
            mass_kg: rounded(body.mass_kg * self.mass),
            com_m,
            inertia_kg_m2: (body.inertia_kg_m2 * self.moments).map(rounded),
        }
    }
}

/// Writes the links of a tree.
pub(super) fn write(edits: &mut Edits, source: &Source, own: &SpatialTree) {
    for (index, link) in own.links.iter().enumerate() {
        let Some(change) = Change::of(&source.found.tree.links[index], link) else {
            continue;
        };
        let parts = source.robot.bodies.iter().zip(&source.found.fixed);
        for (body, (owner, stands)) in parts {
            let is_empty =
                body.inertial.mass_kg == 0.0 && body.inertial.inertia_kg_m2.norm() == 0.0;
            if *owner != Some(index) || is_empty {
                continue;
            }
            let inertial = change.applied(&body.inertial, stands);
            let element = source.element(body.at);
            match source.format {
                "urdf" => urdf(edits, element, body, &inertial, change.moments),
                _ => mjcf(edits, element, source, (body, &inertial), change.moments),
            }
        }
    }
}

fn urdf(edits: &mut Edits, link: Element, before: &TreeBody, own: &Inertial, moments: f64) {
    let Some(inertial) = link.first("inertial") else {
        return;
    };
    if let Some(mass) = inertial.first("mass") {
        set(edits, mass, "value", own.mass_kg, before.inertial.mass_kg);
    }
    if own.com_m != before.inertial.com_m {
        let xyz = numbers(own.com_m.coords.as_slice());
        match inertial.first("origin") {
            Some(origin) => edits.set(&origin.node, "xyz", &xyz),
            None => edits.insert(&inertial.node, &format!("<origin xyz=\"{xyz}\"/>")),
        }
    }
    if let Some(inertia) = inertial.first("inertia") {
        for key in ["ixx", "ixy", "ixz", "iyy", "iyz", "izz"] {
            scale(edits, inertia, key, moments);
        }
    }
}

fn mjcf(
    edits: &mut Edits,
    element: Element,
    source: &Source,
    (before, own): (&TreeBody, &Inertial),
    moments: f64,
) {
    let from_shapes = source.compiler.as_ref().and_then(|own| own.from_shapes);
    let given = element.first("inertial");
    let (pos, mass) = (numbers(own.com_m.coords.as_slice()), number(own.mass_kg));
    match (given, from_shapes) {
        // MuJoCo takes no other masses than those of shapes.
        (_, Some(true)) => {}
        (Some(inertial), _) => {
            set(
                edits,
                inertial,
                "mass",
                own.mass_kg,
                before.inertial.mass_kg,
            );
            if own.com_m != before.inertial.com_m {
                edits.set(&inertial.node, "pos", &pos);
            }
            for key in ["fullinertia", "diaginertia"] {
                scale(edits, inertial, key, moments);
            }
        }
        (None, _) => {
            let at = |i: usize, k: usize| own.inertia_kg_m2[(i, k)];
            let full = [at(0, 0), at(1, 1), at(2, 2), at(0, 1), at(0, 2), at(1, 2)];
            let full = numbers(&full);
            let inertial =
                format!("<inertial pos=\"{pos}\" mass=\"{mass}\" fullinertia=\"{full}\"/>");
            edits.insert(&element.node, &inertial);
        }
    }
}

/// Writes a number where it is another.
fn set(edits: &mut Edits, element: Element, key: &str, own: f64, before: f64) {
    if own != before {
        edits.set(&element.node, key, &number(own));
    }
}

/// Multiplies the numbers of an attribute.
fn scale(edits: &mut Edits, element: Element, key: &str, by: f64) {
    // What is no number has been refused when the file was read.
    if let Ok(Some(values)) = element.numbers(key)
        && by != 1.0
    {
        let values: Vec<f64> = values.iter().map(|value| rounded(value * by)).collect();
        edits.set(&element.node, key, &numbers(&values));
    }
}
