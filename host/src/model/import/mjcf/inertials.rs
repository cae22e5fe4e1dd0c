//! Masses and inertias of bodies: given, or those of their shapes.

use super::super::tree::Inertial;
use super::super::xml::Element;
use super::defaults::Attributes;
use super::{DEEPEST, Reader, geometry};
use crate::error::Result;
use nalgebra::{Isometry3, Matrix3, Point3, Translation3};

impl Reader<'_> {
    pub(super) fn inertial(&self, body: Element, class: Option<&str>) -> Result<Inertial> {
        let given = body.first("inertial");
        match given.filter(|_| self.compiler.from_shapes != Some(true)) {
            Some(inertial) => self.given(inertial),
            None if self.compiler.from_shapes == Some(false) => Ok(Inertial::NONE),
            None => self.of_shapes(body, class, &Isometry3::identity(), 0),
        }
    }

    fn given(&self, element: Element) -> Result<Inertial> {
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
        if mass_kg < 0.0 || (0..3).any(|i| inertia_kg_m2[(i, i)] < 0.0) {
            return Err(element.wrong("a mass or a moment of inertia is below 0", "mend its sign"));
        }
        let turn = self.compiler.orientation(&own)?.unwrap_or_default();
        let inertial = Inertial {
            mass_kg,
            com_m: Point3::origin(),
            inertia_kg_m2,
        };
        Ok(inertial.seen_from(&Isometry3::from_parts(Translation3::from(com), turn)))
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
