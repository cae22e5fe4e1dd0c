//! The address of one number in a model: `link1.mass_kg`, `joint1.gain_per_rad`,
//! `coulomb@1.torque_nm`.

use super::field::{JointField, LinkField, POSITIVE};
use super::{EffectInstance, Model};
use crate::effects::{self, Axis, Effect};
use std::fmt;

/// Where one number of a model is. Indices count from 0 here, and from 1 in text.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum ParameterPath {
    /// A number of a link: `link1.mass_kg`.
    Link {
        /// Link from the base.
        index: usize,
        /// Which number.
        field: LinkField,
    },
    /// A number of a joint's drive: `joint1.stall_torque_nm`.
    Joint {
        /// Joint from the base.
        index: usize,
        /// Which number.
        field: JointField,
    },
    /// A value of an effect: `coulomb@1.torque_nm`, `delay@all.delay_s` of all driven joints, or
    /// `base_tilt.angle_rad` of the whole rig.
    Effect {
        /// The effect's id.
        id: &'static str,
        /// Joint from the base; `None` for the whole rig, or for all driven joints.
        joint: Option<usize>,
        /// Position among its parameters.
        parameter: usize,
        /// At which joints this value has its key and unit: of one that has the same everywhere, a
        /// hinge.
        axis: Axis,
    },
}

impl ParameterPath {
    /// Addresses of an effect's values, in the order of its parameters.
    pub fn of_effect(effect: &EffectInstance) -> impl Iterator<Item = ParameterPath> + '_ {
        let of = |parameter| ParameterPath::at(effect.effect, effect.joint, parameter);
        (0..effect.values.len()).map(of)
    }

    /// Address of a value of an effect at a joint; `None` as [`EffectInstance`] has it.
    pub fn at(effect: Effect, joint: Option<usize>, parameter: usize) -> Self {
        let key = |effect: Effect| effect.info().parameters.get(parameter).map(|p| p.key);
        let axis = match effect.on(Axis::Hinge) {
            Some(hinge) if key(hinge) == key(effect) => Axis::Hinge,
            _ => effect.axis(),
        };
        ParameterPath::Effect {
            id: effect.info().id,
            joint,
            parameter,
            axis,
        }
    }

    /// The number there; `None` if the model has no such link, joint, drive figure or effect.
    pub fn get(&self, model: &Model) -> Option<f64> {
        match *self {
            ParameterPath::Link { index, field } => {
                let value = *field.of(&mut model.links.get(index)?.clone());
                // Where the next joint is, a robot's file says; and it has no direction to a centre
                // of mass on the joint, nor proportions of moments that are none. Between two
                // joints of one body there is no mass.
                let is_free = field != LinkField::Length && value != 0.0;
                (model.robot.is_none() || is_free).then_some(value)
            }
            ParameterPath::Joint { index, field } => {
                Some(*field.of(&mut model.joints.get(index)?.clone())?)
            }
            ParameterPath::Effect {
                id,
                joint,
                parameter,
                ..
            } => {
                let effect = model.effects.iter().find(|effect| effect.is(id, joint))?;
                let own = effect.effect.info().parameters.get(parameter)?;
                effect
                    .values
                    .get(parameter)
                    .copied()
                    .filter(|_| own.key == self.key())
            }
        }
    }

    /// Writes the number there, unchecked against [`bounds`](Self::bounds); `false` if there is no
    /// such place.
    #[must_use]
    pub fn set(&self, model: &mut Model, value: f64) -> bool {
        if self.get(model).is_none() {
            return false;
        }
        let place = match *self {
            ParameterPath::Link { index, field } => {
                model.links.get_mut(index).map(|link| field.of(link))
            }
            ParameterPath::Joint { index, field } => model
                .joints
                .get_mut(index)
                .and_then(|joint| field.of(joint)),
            ParameterPath::Effect {
                id,
                joint,
                parameter,
                ..
            } => model
                .effects
                .iter_mut()
                .find(|effect| effect.is(id, joint))
                .and_then(|effect| effect.values.get_mut(parameter)),
        };
        place.map(|place| *place = value).is_some()
    }

    /// Lowest and highest value that a fit may give it: what is possible, within what the model's
    /// `[fit.bounds]` allow.
    pub fn bounds(&self, model: &Model) -> (f64, f64) {
        let possible = self.possible();
        let own = model.bounds.iter().find(|(path, _)| path == self);
        own.map_or(possible, |(_, (low, high))| {
            (possible.0.max(*low), possible.1.min(*high))
        })
    }

    /// Lowest and highest possible value: the bounds of an effect's parameter, else what is
    /// physical.
    pub fn possible(&self) -> (f64, f64) {
        match *self {
            ParameterPath::Link { field, .. } => field.bounds(),
            ParameterPath::Joint { .. } => POSITIVE,
            ParameterPath::Effect { .. } => self
                .parameter()
                .map_or((f64::NEG_INFINITY, f64::INFINITY), |p| p.bounds),
        }
    }

    /// Unit as shown to people: `N m`, `kg m^2`.
    pub fn unit(&self) -> &'static str {
        match self.parameter() {
            Some(parameter) => parameter.unit,
            None => effects::split_unit(self.key()).map_or("", |(_, unit)| unit),
        }
    }

    /// The key of its number in a model file: `torque_nm`.
    pub fn key(&self) -> &'static str {
        match *self {
            ParameterPath::Link { field, .. } => field.key(),
            ParameterPath::Joint { field, .. } => field.key(),
            ParameterPath::Effect { .. } => self.parameter().map_or("", |p| p.key),
        }
    }

    /// The effect's parameter, of the value of an effect.
    pub fn parameter(&self) -> Option<&'static effects::Parameter> {
        let ParameterPath::Effect {
            id,
            parameter,
            axis,
            ..
        } = *self
        else {
            return None;
        };
        let effect = effects::named(id)?.on(axis)?;
        effect.info().parameters.get(parameter)
    }
}

impl fmt::Display for ParameterPath {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            ParameterPath::Link { index, .. } => write!(f, "link{}", index + 1)?,
            ParameterPath::Joint { index, .. } => write!(f, "joint{}", index + 1)?,
            ParameterPath::Effect { id, joint, .. } => match joint {
                Some(joint) => write!(f, "{id}@{}", joint + 1)?,
                None => write!(f, "{id}{}", effects::at_all(id))?,
            },
        }
        write!(f, ".{}", self.key())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const MODEL: &str = include_str!("testdata/full.toml");

    fn model() -> Model {
        Model::parse(MODEL, "full.toml".as_ref()).unwrap()
    }

    #[test]
    fn text_round_trips() {
        for text in [
            "link1.length_m",
            "link2.com_m",
            "link1.mass_kg",
            "link1.inertia_kg_m2",
            "joint2.gain_per_rad",
            "joint1.gain_s_per_rad",
            "joint2.stall_torque_nm",
            "joint2.no_load_speed_rad_s",
            "coulomb@1.torque_nm",
            "delay@2.delay_s",
            "delay@all.delay_s",
            "base_tilt.angle_rad",
        ] {
            let path: ParameterPath = text.parse().unwrap();
            assert_eq!(path.to_string(), text);
        }
    }

    #[test]
    fn wrong_text_is_refused_with_a_remedy() {
        for (text, what, remedy) in [
            ("mass_kg", "names no parameter", "link1.mass_kg"),
            ("link1.mass", "unknown name `mass`", "`mass_kg`"),
            ("link0.mass_kg", "unknown name `link0`", "known"),
            ("link01.mass_kg", "unknown name `link01`", "known"),
            ("link+1.mass_kg", "unknown name `link+1`", "known"),
            ("colomb@1.torque_nm", "`colomb`", "did you mean `coulomb`?"),
            ("coulomb.torque_nm", "which joint", "coulomb@1.torque_nm"),
            ("coulomb@0.torque_nm", "no joint", "count from 1"),
            ("coulomb@1.torque", "unknown name `torque`", "`torque_nm`"),
            ("", "names no parameter", ""),
        ] {
            let error = text.parse::<ParameterPath>().unwrap_err();
            assert!(error.to_string().contains(what), "{text}: {error}");
            let found = error.remedy().unwrap();
            assert!(found.contains(remedy), "{text}: {found}");
        }
    }

    #[test]
    fn get_reads_what_set_wrote() {
        let mut model = model();
        for text in [
            "link2.mass_kg",
            "link1.com_m",
            "joint2.gain_per_rad",
            "joint2.stall_torque_nm",
            "joint2.no_load_speed_rad_s",
            "coulomb@1.torque_nm",
        ] {
            let path: ParameterPath = text.parse().unwrap();
            let before = model.clone();
            assert!(path.get(&model).is_some(), "{text}");
            assert!(path.set(&mut model, 0.123), "{text}");
            assert_eq!(path.get(&model), Some(0.123), "{text}");
            assert_ne!(before, model, "{text} changes the model");
        }
    }

    #[test]
    fn a_place_the_model_lacks_is_none() {
        let mut model = model();
        for text in [
            "link9.mass_kg",
            "joint9.stall_torque_nm",
            "joint1.stall_torque_nm",
            "joint2.gain_s_per_rad",
            "coulomb@2.torque_nm",
        ] {
            let path: ParameterPath = text.parse().unwrap();
            assert_eq!(path.get(&model), None, "{text}");
            assert!(!path.set(&mut model, 1.0), "{text}");
        }
    }

    #[test]
    fn bounds_and_units_come_from_the_effect_or_the_quantity() {
        let model = model();
        let coulomb: ParameterPath = "coulomb@1.torque_nm".parse().unwrap();
        assert_eq!(coulomb.bounds(&model), (0.0, 10.0));
        assert_eq!(coulomb.unit(), "N m");
        let mass: ParameterPath = "link1.mass_kg".parse().unwrap();
        assert_eq!(mass.bounds(&model), POSITIVE);
        assert_eq!(mass.unit(), "kg");
    }
}
