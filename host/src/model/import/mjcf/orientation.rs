//! Angles and orientations as `<compiler>` says that the file writes them.

use super::defaults::Attributes;
use crate::error::Result;
use crate::model::import::xml::Element;
use nalgebra::{Matrix3, Quaternion, Rotation3, Unit, UnitQuaternion, Vector3};

/// Settings of `<compiler>`.
pub(super) struct Compiler {
    degrees: bool,
    /// Axes of Euler angles, small letters where they turn along.
    euler: [char; 3],
    /// Whether a range limits without `limited`.
    pub autolimits: bool,
    /// Whether masses come from shapes: always, never, or where none is given.
    pub from_shapes: Option<bool>,
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
        };
        for element in root.all("compiler") {
            let is = |key: &str, value: &str| element.text(key) == Some(value);
            let changes = is("coordinate", "global")
                || is("balanceinertia", "true")
                || ["boundmass", "boundinertia"]
                    .iter()
                    .any(|key| element.text(key).is_some_and(|v| v.trim() != "0"))
                || element
                    .number("settotalmass")?
                    .is_some_and(|mass| mass > 0.0)
                || element.text("inertiagrouprange").is_some();
            if changes {
                let what = "<compiler> changes masses or frames in a way that is not read";
                return Err(element.wrong(what, super::FLATTEN));
            }
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
