//! Masses and inertias of bodies: given, or those of their shapes.

use super::super::tree::Inertial;
use super::super::xml::Element;
use super::defaults::Attributes;
use super::{DEEPEST, Reader, geometry};
use crate::error::Result;
use crate::model::import::inertia::checked;
use nalgebra::{Isometry3, Matrix3, Point3, Translation3, Vector3};

impl Reader<'_> {
    /// What a body weighs, and what no body's moments can be.
    pub(super) fn inertial(
        &self,
        body: Element,
        class: Option<&str>,
    ) -> Result<(Inertial, Option<String>)> {
        let given = body.first("inertial");
        let (inertial, impossible) = match given.filter(|_| self.compiler.from_shapes != Some(true))
        {
            Some(inertial) => self.given(inertial)?,
            None if self.compiler.from_shapes == Some(false) => (Inertial::NONE, None),
            None => {
                let shapes = self.of_shapes(body, class, &Isometry3::identity(), 0)?;
                (shapes, None)
            }
        };
        let bounded = self.bounded(inertial);
        Ok((bounded, impossible.filter(|_| bounded == inertial)))
    }

    /// A mass and moments as `<compiler>` bounds and balances them.
    fn bounded(&self, inertial: Inertial) -> Inertial {
        let compiler = &self.compiler;
        let mass_kg = inertial.mass_kg.max(compiler.least_kg);
        let frame = inertial.inertia_kg_m2.symmetric_eigen();
        let mut moments = frame.eigenvalues.map(|own| own.max(compiler.least_kg_m2));
        let (sum, most) = (moments.sum(), moments.max());
        if compiler.balances && sum < 2.0 * most {
            moments = Vector3::repeat(sum / 3.0);
        }
        let inertia_kg_m2 = if moments == frame.eigenvalues {
            inertial.inertia_kg_m2
        } else {
            frame.eigenvectors * Matrix3::from_diagonal(&moments) * frame.eigenvectors.transpose()
        };
        Inertial {
            mass_kg,
            inertia_kg_m2,
            ..inertial
        }
    }

    fn given(&self, element: Element) -> Result<(Inertial, Option<String>)> {
        let own = Attributes::own(element);
        let mass_kg = element
            .required("mass")
            .and_then(|text| element.one_number("mass", text))?;
        let com = own.vector("pos")?.unwrap_or_default();
        let inertia_kg_m2 = match (own.numbers("fullinertia")?, own.vector("diaginertia")?) {
            (Some(full), _) => match full.as_slice() {
                [xx, yy, zz, xy, xz, yz] => {
                    Matrix3::new(*xx, *xy, *xz, *xy, *yy, *yz, *xz, *yz, *zz)
                }
                _ => return Err(element.wrong("fullinertia has six numbers", "xx yy zz xy xz yz")),
            },
            (None, Some(diagonal)) => Matrix3::from_diagonal(&diagonal),
            (None, None) => Matrix3::zeros(),
        };
        let (inertia_kg_m2, impossible) = checked(element, mass_kg, inertia_kg_m2)?;
        let turn = self.compiler.orientation(&own)?.unwrap_or_default();
        let inertial = Inertial {
            mass_kg,
            com_m: Point3::origin(),
            inertia_kg_m2,
        };
        let inertial = inertial.seen_from(&Isometry3::from_parts(Translation3::from(com), turn));
        Ok((inertial, impossible))
    }

    fn of_shapes(
        &self,
        body: Element,
        class: Option<&str>,
        frame: &Isometry3<f64>,
        depth: usize,
    ) -> Result<Inertial> {
        let mut all = Inertial::NONE;
        for child in body.elements() {
            let part = match child.tag() {
                "geom" => {
                    let own = self.defaults.attributes(child, class)?;
                    geometry::inertial(&own, &self.compiler)?.seen_from(frame)
                }
                "frame" if depth < DEEPEST => {
                    let frame = frame * self.pose(child)?;
                    self.of_shapes(child, child.text("childclass").or(class), &frame, depth + 1)?
                }
                _ => continue,
            };
            all = all.with(&part);
        }
        Ok(all)
    }
}
