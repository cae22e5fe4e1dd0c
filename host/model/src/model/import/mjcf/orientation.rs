//! Angles and orientations as `<compiler>` says that the file writes them.

use super::defaults::Attributes;
use crate::error::Result;
use crate::model::import::xml::Element;
use nalgebra::{Matrix3, Quaternion, Rotation3, Unit, UnitQuaternion, Vector3};

/// Settings of `<compiler>`.
pub(in crate::model) struct Compiler {
    pub degrees: bool,
    /// Axes of Euler angles, small letters where they turn along.
    euler: [char; 3],
    /// Whether a range limits without `limited`.
    pub autolimits: bool,
    /// Whether masses come from shapes: always, never, or where none is given.
    pub from_shapes: Option<bool>,
    /// Lowest and highest group of shapes that have mass.
    pub groups: Option<(f64, f64)>,
    /// No body has less mass, kg.
    pub least_kg: f64,
    /// No body has a lower principal moment, kg m^2.
    pub least_kg_m2: f64,
    /// Whether moments against the triangle inequality become their mean.
    pub balances: bool,
}

impl Compiler {
    /// # Errors
    /// Settings that change masses or frames when MuJoCo compiles the file.
    pub fn of(root: Element) -> Result<Self> {
        let mut compiler = Compiler {
            degrees: true,
            euler: ['x', 'y', 'z'],
            autolimits: true,
            from_shapes: None,
            groups: None,
            least_kg: 0.0,
            least_kg_m2: 0.0,
            balances: false,
        };
        for element in root.all("compiler") {
            let scales = element
                .number("settotalmass")?
                .is_some_and(|mass| mass > 0.0);
            if element.text("coordinate") == Some("global") || scales {
                let what = "<compiler> changes masses or frames in a way that is not read";
                return Err(element.wrong(what, super::FLATTEN));
            }
            compiler.masses(element)?;
            match element.text("angle") {
                Some("radian") => compiler.degrees = false,
                Some("degree") => compiler.degrees = true,
                _ => {}
            }
            if let Some(text) = element.text("eulerseq") {
                let letters: Vec<char> = text.chars().collect();
                compiler.euler = match letters.try_into() {
                    Ok(axes) => axes,
                    Err(_) => return Err(element.wrong("eulerseq has three letters", "write xyz")),
                };
                if !compiler.euler.iter().all(|axis| "xyzXYZ".contains(*axis)) {
                    return Err(element.wrong("eulerseq names x, y and z", "write xyz"));
                }
            }
            if let Some(text) = element.text("autolimits") {
                compiler.autolimits = text == "true";
            }
            compiler.from_shapes = match element.text("inertiafromgeom") {
                Some("true") => Some(true),
                Some("false") => Some(false),
                Some(_) => None,
                None => compiler.from_shapes,
            };
        }
        Ok(compiler)
    }

    /// What it says of masses.
    fn masses(&mut self, element: Element) -> Result<()> {
        self.least_kg = element.number("boundmass")?.unwrap_or(self.least_kg);
        let least = element.number("boundinertia")?;
        self.least_kg_m2 = least.unwrap_or(self.least_kg_m2);
        if let Some(text) = element.text("balanceinertia") {
            self.balances = text == "true";
        }
        match element.numbers("inertiagrouprange")?.as_deref() {
            None => Ok(()),
            Some([low, high]) => {
                self.groups = Some((*low, *high));
                Ok(())
            }
            Some(_) => Err(element.wrong("inertiagrouprange has two numbers", "write 0 5")),
        }
    }

    /// Whether a range limits, by the attribute that says so.
    pub fn limits(&self, own: &Attributes, key: &str) -> bool {
        match own.text(key).unwrap_or("auto") {
            "auto" => self.autolimits,
            said => said == "true",
        }
    }

    /// An angle of the file in rad.
    pub fn rad(&self, angle: f64) -> f64 {
        if self.degrees {
            angle.to_radians()
        } else {
            angle
        }
    }

    /// The orientation that an element has, if it has one.
    ///
    /// # Errors
    /// Axes of length 0, too many or too few numbers.
    pub fn orientation(&self, own: &Attributes) -> Result<Option<UnitQuaternion<f64>>> {
        let wrong = |key: &str| {
            own.element
                .wrong(format!("{key} makes no orientation"), "mend it")
        };
        if let Some(values) = own.numbers("quat")? {
            let [w, x, y, z] = values[..] else {
                return Err(wrong("quat"));
            };
            let made = UnitQuaternion::try_new(Quaternion::new(w, x, y, z), 1e-9);
            return made.map(Some).ok_or_else(|| wrong("quat"));
        }
        if let Some(values) = own.numbers("axisangle")? {
            let [x, y, z, angle] = values[..] else {
                return Err(wrong("axisangle"));
            };
            let axis =
                Unit::try_new(Vector3::new(x, y, z), 1e-9).ok_or_else(|| wrong("axisangle"))?;
            return Ok(Some(UnitQuaternion::from_axis_angle(
                &axis,
                self.rad(angle),
            )));
        }
        if let Some(angles) = own.vector("euler")? {
            return Ok(Some(self.of_euler(angles)));
        }
        if let Some(values) = own.numbers("xyaxes")? {
            let [a, b, c, d, e, f] = values[..] else {
                return Err(wrong("xyaxes"));
            };
            let x = Vector3::new(a, b, c)
                .try_normalize(1e-9)
                .ok_or_else(|| wrong("xyaxes"))?;
            let y = Vector3::new(d, e, f);
            let y = (y - x * x.dot(&y))
                .try_normalize(1e-9)
                .ok_or_else(|| wrong("xyaxes"))?;
            let turn =
                Rotation3::from_matrix_unchecked(Matrix3::from_columns(&[x, y, x.cross(&y)]));
            return Ok(Some(UnitQuaternion::from_rotation_matrix(&turn)));
        }
        match own.vector("zaxis")? {
            Some(axis) if axis.norm() < 1e-9 => Err(wrong("zaxis")),
            Some(axis) => Ok(Some(along(axis))),
            None => Ok(None),
        }
    }

    fn of_euler(&self, angles: Vector3<f64>) -> UnitQuaternion<f64> {
        let mut turn = UnitQuaternion::identity();
        for (letter, angle) in self.euler.into_iter().zip(angles.iter()) {
            let axis = match letter.to_ascii_lowercase() {
                'x' => Vector3::x_axis(),
                'y' => Vector3::y_axis(),
                _ => Vector3::z_axis(),
            };
            let one = UnitQuaternion::from_axis_angle(&axis, self.rad(*angle));
            turn = if letter.is_ascii_lowercase() {
                turn * one
            } else {
                one * turn
            };
        }
        turn
    }
}

/// The least turn that lays z along an axis.
pub(super) fn along(axis: Vector3<f64>) -> UnitQuaternion<f64> {
    let turn = UnitQuaternion::rotation_between(&Vector3::z(), &axis);
    turn.unwrap_or_else(|| {
        UnitQuaternion::from_axis_angle(&Vector3::x_axis(), std::f64::consts::PI)
    })
}
