//! What the virtual robot has and its owner's model has not, drawn by seed.

use crate::effects;
use crate::error::Result;
use crate::model::edit::add_effect;
use crate::model::{EffectInstance, Model};
use rand::{Rng as _, SeedableRng as _};
use rand_chacha::ChaCha8Rng;
use serde::{Deserialize, Serialize};
use std::path::Path;

/// The model that the robot's owner believes in.
pub(super) const NOMINAL: &str = include_str!("nominal.toml");
/// Step of the true robot's simulation, s: short beside the time that reading a servo takes, or
/// what is read one after the other would be of one moment.
const TRUE_STEP_S: f64 = 1e-4;
/// Kinds that are hidden beside the drives' lag, one of them in each robot.
const KINDS: [&str; 3] = ["coulomb", "dead_zone", "mass"];
/// Largest departure of each joint from upright and straight at the start, deg.
const START_DEG: f64 = 1.0;

/// A robot with hidden effects.
#[derive(Debug, Clone, PartialEq)]
pub struct HiddenRobot {
    /// Where each joint starts, degrees from upright and straight.
    pub start_deg: [f64; 3],
    /// What is hidden, and the whole truth.
    pub answer: RobotAnswer,
}

/// What is hidden in a robot.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct RobotAnswer {
    /// Seed of the robot.
    pub seed: u64,
    /// The hidden effects.
    pub effects: Vec<RobotEffect>,
    /// The model file with them.
    pub true_model_toml: String,
}

/// A hidden effect.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct RobotEffect {
    /// As `handstand add` takes it: `mass@3`, `delay@all`.
    pub address: String,
    /// Keys and values of its parameters.
    pub parameters: Vec<(String, f64)>,
}

impl HiddenRobot {
    /// The robot of this seed; equal seeds give equal robots.
    ///
    /// # Errors
    /// Never, unless the effects' library lacks what is hidden.
    pub fn draw(seed: u64) -> Result<HiddenRobot> {
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        let start_deg = std::array::from_fn(|_| random.random_range(-START_DEG..=START_DEG));
        let mut within = |low: f64, high: f64, places: f64| {
            (random.random_range(low..high) * places).round() / places
        };
        let lag_s = within(0.015, 0.0185, 1e4);
        let kind = KINDS[(seed % KINDS.len() as u64) as usize];
        let (joint, values) = match kind {
            // More than 0.03 N m at the bar no plan of this kind holds upright.
            "coulomb" => (Some(0), vec![within(0.012, 0.022, 1e4)]),
            "mass" => {
                let joint = if within(0.0, 1.0, 1e4) < 0.5 { 1 } else { 2 };
                (Some(joint), vec![within(0.1, 0.2, 1e3)])
            }
            _ => {
                let width = within(0.05, 0.08, 1e4);
                (None, vec![width, -width])
            }
        };
        let hidden = [("delay", None, vec![lag_s]), (kind, joint, values)];
        let (mut text, mut effects) = (NOMINAL.to_string(), Vec::new());
        for (kind, joint, values) in hidden {
            let Some(effect) = effects::named(kind) else {
                continue;
            };
            let instance = EffectInstance {
                effect,
                joint,
                values,
            };
            text = add_effect(&text, Path::new("true.toml"), &instance, None)?;
            effects.push(RobotEffect::of(&instance));
        }
        Ok(HiddenRobot {
            start_deg,
            answer: RobotAnswer {
                seed,
                effects,
                true_model_toml: text,
            },
        })
    }

    /// The true robot's model.
    ///
    /// # Errors
    /// Never of one that was drawn.
    pub fn model(&self) -> Result<Model> {
        let text = &self.answer.true_model_toml;
        Ok(Model {
            step_s: TRUE_STEP_S,
            ..Model::parse(text, Path::new("true.toml"))?
        })
    }

    /// The same with a known mass bolted onto the last link, where the model has its payload, kg.
    ///
    /// # Errors
    /// As [`model`](Self::model).
    pub fn carrying(&self, payload_kg: f64) -> Result<Model> {
        let mut model = self.model()?;
        let at_m = model.log.payload_at_m;
        if let Some(last) = model.links.last_mut() {
            let empty = last.clone();
            last.mass_kg += payload_kg;
            last.com_m = (empty.mass_kg * empty.com_m + payload_kg * at_m) / last.mass_kg;
            last.inertia_kg_m2 += empty.mass_kg * (empty.com_m - last.com_m).powi(2)
                + payload_kg * (at_m - last.com_m).powi(2);
        }
        Ok(model)
    }
}

impl RobotEffect {
    fn of(instance: &EffectInstance) -> RobotEffect {
        let info = instance.effect.info();
        let keys = info.parameters.iter().map(|parameter| parameter.key);
        let values = instance.values.iter().copied();
        RobotEffect {
            address: crate::fitting::Candidate::from(instance).to_string(),
            parameters: keys.map(String::from).zip(values).collect(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_seed_is_one_robot_and_ten_seeds_hide_every_kind() {
        let ten: Vec<HiddenRobot> = (1..=10)
            .map(|seed| HiddenRobot::draw(seed).unwrap())
            .collect();
        assert_eq!(ten[3], HiddenRobot::draw(4).unwrap());
        assert_ne!(ten[3].answer.effects, ten[6].answer.effects);
        for kind in KINDS {
            let hides = |robot: &&HiddenRobot| {
                let mut effects = robot.answer.effects.iter();
                effects.any(|effect| effect.address.starts_with(kind))
            };
            assert!(ten.iter().filter(hides).count() >= 3, "{kind}");
        }
        for robot in &ten {
            let delay = &robot.answer.effects[0];
            assert_eq!(delay.address, "delay@all");
            assert!((0.015..=0.0185).contains(&delay.parameters[0].1));
            let (truth, nominal) = (robot.model().unwrap(), NOMINAL);
            let nominal = Model::parse(nominal, Path::new("nominal.toml")).unwrap();
            assert_eq!(truth.effects.len(), nominal.effects.len() + 2);
        }
    }
}
