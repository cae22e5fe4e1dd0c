//! Units a log may be written in; declared, never guessed.

use crate::effects::Axis;
use std::f64::consts::{PI, TAU};
use std::fmt;

/// What a unit measures.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Dimension {
    /// Time, SI s.
    Time,
    /// Angle, SI rad.
    Angle,
    /// Angular speed, SI rad/s.
    Speed,
    /// Torque, SI N m.
    Torque,
    /// Displacement of a joint that slides, SI m.
    Length,
    /// Its speed, SI m/s.
    LinearSpeed,
    /// Force along it, SI N.
    Force,
    /// Voltage, SI V.
    Voltage,
    /// Mass, SI kg.
    Mass,
    /// A share, SI 1.
    Ratio,
}

impl fmt::Display for Dimension {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Dimension::Time => "a time",
            Dimension::Angle => "an angle",
            Dimension::Speed => "an angular speed",
            Dimension::Torque => "a torque",
            Dimension::Length => "a length",
            Dimension::LinearSpeed => "a linear speed",
            Dimension::Force => "a force",
            Dimension::Voltage => "a voltage",
            Dimension::Mass => "a mass",
            Dimension::Ratio => "a share",
        })
    }
}

impl Dimension {
    /// What a key for this quantity ends in: the suffix of the SI unit, as `_rad`.
    pub(in crate::model) fn suffix(self) -> &'static str {
        match self {
            Dimension::Time => "_s",
            Dimension::Angle => "_rad",
            Dimension::Speed => "_rad_s",
            Dimension::Torque => "_nm",
            Dimension::Length => "_m",
            Dimension::LinearSpeed => "_m_s",
            Dimension::Force => "_n",
            Dimension::Voltage => "_v",
            Dimension::Mass => "_kg",
            Dimension::Ratio => "",
        }
    }

    /// What the input of a drive of this name measures at a joint that moves so; nothing for one
    /// that has no input.
    pub fn of_input(drive: &str, axis: Axis) -> Option<Dimension> {
        match drive {
            "torque" => Some(Dimension::Torque.on(axis)),
            "duty" => Some(Dimension::Ratio),
            "position" => Some(Dimension::Angle.on(axis)),
            "speed" => Some(Dimension::Speed.on(axis)),
            _ => None,
        }
    }

    /// What takes the place of this at a joint that moves so: of an angle, a length on a slide.
    #[must_use]
    pub fn on(self, axis: Axis) -> Dimension {
        match (self, axis) {
            (Dimension::Angle, Axis::Slide) => Dimension::Length,
            (Dimension::Speed, Axis::Slide) => Dimension::LinearSpeed,
            (Dimension::Torque, Axis::Slide) => Dimension::Force,
            _ => self,
        }
    }

    /// Units that measure this and are one size in all logs.
    pub fn plain_units(self) -> impl Iterator<Item = Unit> {
        let units = self.unit_names().filter_map(|name| Unit::named(name, None));
        units.filter(|unit| unit.si.is_finite())
    }

    /// The SI unit.
    pub fn si(self) -> Unit {
        Unit {
            name: self.si_unit(),
            dimension: self,
            si: 1.0,
        }
    }

    /// Name of the SI unit; empty for a share.
    pub fn si_unit(self) -> &'static str {
        let mut units = self.plain_units().filter(|unit| unit.name != "1");
        units
            .find(|unit| unit.si == 1.0)
            .map_or("", |unit| unit.name)
    }

    /// Names of the units that measure this, for error messages.
    pub fn unit_names(self) -> impl Iterator<Item = &'static str> {
        UNITS
            .iter()
            .filter(move |(_, dimension, _)| *dimension == self)
            .map(|(name, _, _)| *name)
    }
}

/// Name, dimension, and how many SI units one is: not a number where a column has to say it.
const UNITS: &[(&str, Dimension, f64)] = &[
    ("s", Dimension::Time, 1.0),
    ("ms", Dimension::Time, 1e-3),
    ("us", Dimension::Time, 1e-6),
    ("ns", Dimension::Time, 1e-9),
    // Time stamps as text; a log counts them in s from its first.
    ("iso8601", Dimension::Time, 1.0),
    ("rad", Dimension::Angle, 1.0),
    ("deg", Dimension::Angle, PI / 180.0),
    ("turn", Dimension::Angle, TAU),
    ("ticks", Dimension::Angle, f64::NAN),
    ("rad/s", Dimension::Speed, 1.0),
    ("deg/s", Dimension::Speed, PI / 180.0),
    ("rpm", Dimension::Speed, TAU / 60.0),
    ("N m", Dimension::Torque, 1.0),
    ("mN m", Dimension::Torque, 1e-3),
    ("kgf cm", Dimension::Torque, 0.098_066_5),
    // Currents of a motor, which are torques by its constant.
    ("A", Dimension::Torque, f64::NAN),
    ("mA", Dimension::Torque, f64::NAN),
    ("m", Dimension::Length, 1.0),
    ("cm", Dimension::Length, 1e-2),
    ("mm", Dimension::Length, 1e-3),
    ("um", Dimension::Length, 1e-6),
    ("ticks", Dimension::Length, f64::NAN),
    ("m/s", Dimension::LinearSpeed, 1.0),
    ("cm/s", Dimension::LinearSpeed, 1e-2),
    ("mm/s", Dimension::LinearSpeed, 1e-3),
    ("N", Dimension::Force, 1.0),
    ("mN", Dimension::Force, 1e-3),
    ("kgf", Dimension::Force, 9.806_65),
    ("A", Dimension::Force, f64::NAN),
    ("mA", Dimension::Force, f64::NAN),
    ("V", Dimension::Voltage, 1.0),
    ("mV", Dimension::Voltage, 1e-3),
    ("kg", Dimension::Mass, 1.0),
    ("g", Dimension::Mass, 1e-3),
    ("1", Dimension::Ratio, 1.0),
    ("%", Dimension::Ratio, 1e-2),
    // A register or timer value, a share of its full scale.
    ("counts", Dimension::Ratio, f64::NAN),
];

/// A unit with its factor to SI.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Unit {
    /// Name as written in the model file.
    pub name: &'static str,
    /// What it measures.
    pub dimension: Dimension,
    /// SI units per one of these.
    pub si: f64,
}

impl Unit {
    /// The unit of this name, of a hinge where one of slides has the same; `scale` is what a column
    /// says under [`Unit::scale_key`]: counts per turn or of the full scale, or N m per ampere.
    pub fn named(name: &str, scale: Option<f64>) -> Option<Unit> {
        let dimension = UNITS.iter().find(|(known, _, _)| *known == name)?.1;
        Unit::of(name, dimension, scale)
    }

    /// The unit of this name that measures this; `scale` as above, per metre and N per ampere where
    /// it is one of slides.
    pub fn of(name: &str, dimension: Dimension, scale: Option<f64>) -> Option<Unit> {
        let is = |unit: &&(&str, Dimension, f64)| unit.0 == name && unit.1 == dimension;
        let (name, dimension, factor) = UNITS.iter().find(is)?;
        let si = match (*name, scale) {
            ("ticks", Some(ticks)) if *dimension == Dimension::Length => 1.0 / ticks,
            ("ticks", Some(ticks)) => TAU / ticks,
            ("counts", Some(full_scale)) => 1.0 / full_scale,
            ("A", Some(constant)) => constant,
            ("mA", Some(constant)) => 1e-3 * constant,
            _ => *factor,
        };
        Some(Unit {
            name,
            dimension: *dimension,
            si,
        })
    }

    /// The key under which a column of this dimension says the size of a unit of this name, where
    /// it has to.
    pub fn scale_key(name: &str, dimension: Dimension) -> Option<&'static str> {
        match (name, dimension) {
            ("ticks", Dimension::Length) => Some("ticks_per_m"),
            ("ticks", _) => Some("ticks_per_turn"),
            ("counts", _) => Some("full_scale"),
            ("A" | "mA", Dimension::Force) => Some("force_constant_n_a"),
            ("A" | "mA", _) => Some("torque_constant_nm_a"),
            _ => None,
        }
    }

    /// What a column says under [`Unit::scale_key`] of a unit of this size.
    pub fn scale(self) -> Option<f64> {
        match self.name {
            "ticks" if self.dimension == Dimension::Length => Some(1.0 / self.si),
            "ticks" => Some(TAU / self.si),
            "counts" => Some(1.0 / self.si),
            "A" => Some(self.si),
            "mA" => Some(1e3 * self.si),
            _ => None,
        }
    }

    /// Scales a written number to SI.
    pub fn to_si(self, written: f64) -> f64 {
        written * self.si
    }
}
