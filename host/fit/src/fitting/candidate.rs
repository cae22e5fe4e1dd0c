//! An effect of the library at a place of the model (a joint, all driven joints, the whole rig): by
//! its name, its addresses, its start values.

use crate::effects::{
    Effect, NameMatch, Parameter, SMOOTH_DIFFERENCE, Scope, Site, listed, look_up,
};
use crate::error::{Error, Result};
use crate::model::{Drive, EffectInstance, Joint, Model, ParameterPath, effect_on, named_at};
use std::fmt;

/// An effect of the library at a joint, at all driven joints with the same values, or on the whole
/// rig.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Candidate {
    /// The effect.
    pub effect: Effect,
    /// Joint index from 0; `None` for the whole rig, or for all driven joints if the effect is one
    /// of joints.
    pub joint: Option<usize>,
}

impl fmt::Display for Candidate {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&named_at(self.effect, self.joint))
    }
}

impl From<&EffectInstance> for Candidate {
    fn from(instance: &EffectInstance) -> Candidate {
        Candidate {
            effect: instance.effect,
            joint: instance.joint,
        }
    }
}

impl Candidate {
    /// The effect at the joint that `name` says (`coulomb`, `coulomb@2`, `delay@all`), if the model
    /// has room for it. Where there is only one joint it need not be named.
    ///
    /// # Errors
    /// No such effect or joint, one that the joint or its drive does not suit, or that the model
    /// holds already.
    pub fn named(name: &str, model: &Model) -> Result<Candidate> {
        let (id, at) = match name.split_once('@') {
            Some((id, at)) => (id, Some(at)),
            None => (name, None),
        };
        let effect = effect_named(id)?;
        let joint = joint(effect, at, model)?;
        let effect = effect_on(effect, joint, &model.joints).ok_or_else(|| {
            Error::usage(
                format!("`{}` does not act on joints that slide", effect.info().id),
                "name a joint that turns, or another effect",
            )
        })?;
        let candidate = Candidate { effect, joint };
        if candidate.in_model(model) {
            Err(Error::usage(
                format!("the model holds `{candidate}` already"),
                "refit its values with `handstand fit`",
            ))
        } else {
            Ok(candidate)
        }
    }

    /// Whether the model holds it already.
    pub fn in_model(&self, model: &Model) -> bool {
        model.has_effect(self.effect.info().id, self.joint)
    }

    /// Whether an effect of a model is this one.
    pub fn is(&self, instance: &EffectInstance) -> bool {
        Candidate::from(instance) == *self
    }

    /// Whether both are one effect and act on one place: at all driven joints the same acts on each
    /// of them.
    pub fn overlaps(&self, other: Candidate, model: &Model) -> bool {
        let alone = Model {
            effects: vec![self.instance(&[])],
            ..model.clone()
        };
        alone.has_effect(other.effect.info().id, other.joint)
    }

    /// Whether its law jumps in this model, so that the squared error over its values is full of
    /// steps and false valleys. The command of a joint that regulates its angle moves on with the
    /// joint, and a simulation takes a jump there as the mean over what it moves in a step; knocks
    /// of a gear come sooner or later as its gap is moved, and jump not.
    pub fn jumps(&self, model: &Model) -> bool {
        let regulates = |joint: &Joint| matches!(joint.drive, Drive::Position { .. });
        let is_smoothed = || match self.joint {
            Some(joint) => model.joints.get(joint).is_some_and(regulates),
            None => (model.joints.iter())
                .filter(|joint| joint.drive.is_driven())
                .all(regulates),
        };
        let site = self.effect.info().site;
        let is_smooth = site == Site::Gear || site == Site::Command && is_smoothed();
        self.effect.difference() > SMOOTH_DIFFERENCE && !is_smooth
    }

    /// What the effect's values are, in their order.
    pub fn parameters(&self) -> &'static [Parameter] {
        self.effect.info().parameters
    }

    /// The effect with these values, to be added to a model.
    pub fn instance(&self, values: &[f64]) -> EffectInstance {
        EffectInstance {
            effect: self.effect,
            joint: self.joint,
            values: values.to_vec(),
        }
    }

    /// Addresses of its values.
    pub fn paths(&self) -> impl Iterator<Item = ParameterPath> + '_ {
        let at = |parameter| ParameterPath::at(self.effect, self.joint, parameter);
        (0..self.parameters().len()).map(at)
    }

    /// Every combination of the parameters' start values.
    pub fn starts(&self) -> Vec<Vec<f64>> {
        let mut combinations = vec![Vec::new()];
        for parameter in self.parameters() {
            combinations = combinations
                .iter()
                .flat_map(|head: &Vec<f64>| {
                    parameter.starts.iter().map(move |start| {
                        let mut next = head.clone();
                        next.push(*start);
                        next
                    })
                })
                .collect();
        }
        combinations
    }
}

/// The effect of this name: its id, or what people call it and no other effect.
///
/// # Errors
/// An unknown name, with the effects that are like it; a name of several effects, with those.
pub fn effect_named(name: &str) -> Result<Effect> {
    match look_up(name) {
        NameMatch::One(effect) => Ok(effect),
        NameMatch::Several(called) => Err(Error::usage(
            format!("`{name}` may be any of {} effects", called.len()),
            format!("name one of them\n{}", listed(&called).join("\n")),
        )),
        NameMatch::Similar(similar) => {
            let remedy = match similar.as_slice() {
                [] => "`handstand effects` lists all".to_string(),
                [one] => {
                    let id = one.info().id;
                    format!("did you mean `{id}`? `handstand effects` lists all")
                }
                several => format!("did you mean one of these?\n{}", listed(several).join("\n")),
            };
            Err(Error::usage(format!("there is no effect `{name}`"), remedy))
        }
    }
}

/// The ids of the effects of these names.
///
/// # Errors
/// As [`effect_named`].
pub fn effect_ids(names: &[String]) -> Result<Vec<String>> {
    let ids = names
        .iter()
        .map(|name| Ok(effect_named(name)?.info().id.to_string()));
    ids.collect()
}

fn joint(effect: Effect, at: Option<&str>, model: &Model) -> Result<Option<usize>> {
    let (id, scope, count) = (effect.info().id, effect.info().scope, model.link_count());
    let joint = match (scope, at) {
        (Scope::WholeRig, None) => return Ok(None),
        (Scope::WholeRig, Some(_)) => {
            return Err(Error::usage(
                format!("`{id}` acts on the whole rig, not on one joint"),
                format!("write `{id}`"),
            ));
        }
        (_, None) if count == 1 => 0,
        (_, None) => {
            return Err(Error::usage(
                format!("`{id}` acts on one joint, and the model has {count}"),
                format!("say which: `{id}@1` to `{id}@{count}`, or `{id}@all` that are driven"),
            ));
        }
        (scope, Some("all")) => {
            return if scope != Scope::PassiveJoint && !model.driven_joints().is_empty() {
                Ok(None)
            } else {
                Err(Error::usage(
                    format!("`{id}` acts on no driven joint of this model"),
                    "name a joint, counted from 1",
                ))
            };
        }
        (_, Some(at)) => {
            let numbered = at.parse::<usize>().ok();
            let numbered = numbered.filter(|joint| (1..=count).contains(joint));
            let joint = numbered.map(|joint| joint - 1);
            let unknown = || {
                Error::usage(
                    format!("there is no joint `{at}`"),
                    format!("joints of this model count from 1 to {count}"),
                )
            };
            joint
                .or_else(|| model.joint_named(at))
                .ok_or_else(unknown)?
        }
    };
    let drive = &model.joints[joint].drive;
    let wanted = match scope {
        Scope::DrivenJoint if !drive.is_driven() => "driven",
        Scope::PassiveJoint if drive.is_driven() => "passive",
        _ => return Ok(Some(joint)),
    };
    Err(Error::usage(
        format!(
            "`{id}` acts on {wanted} joints only, and joint {} is `{}`",
            joint + 1,
            drive.name()
        ),
        format!("name a {wanted} joint, or another effect"),
    ))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::Motor;
    use std::path::Path;

    #[test]
    fn a_dead_zone_jumps_unless_its_joint_regulates_the_angle() {
        let text = include_str!("../../../models/bench_arm.toml");
        let mut model = Model::parse(text, Path::new("bench_arm.toml")).unwrap();
        let jumps = |name: &str, model: &Model| Candidate::named(name, model).unwrap().jumps(model);
        assert!(jumps("dead_zone@1", &model));
        assert!(!jumps("delay@1", &model) && !jumps("gear_backlash@1", &model));
        model.joints[0].drive = Drive::Position {
            gain_per_rad: 5.0,
            motor: Motor {
                stall_torque_nm: 1.5,
                no_load_speed_rad_s: 6.0,
                nominal_supply_v: None,
            },
        };
        assert!(!jumps("dead_zone@1", &model) && !jumps("dead_zone", &model));
    }
}
