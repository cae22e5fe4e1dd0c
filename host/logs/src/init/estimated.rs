//! What a fit to the log replaces in a draft.

use super::{Draft, Guess};
use crate::model::{JointField, LinkField, ParameterPath};

/// Said of what the user answered.
pub(super) const AS_YOU_SAY: &str = "as you say";

impl Draft {
    /// Whether the user said it himself.
    pub fn is_known(&self, what: &str) -> bool {
        let mut said = self.guesses.iter().filter(|guess| guess.what == what);
        said.any(|guess| guess.why == AS_YOU_SAY)
    }

    /// Notes one more conclusion.
    pub fn note(&mut self, what: &str, guess: &str, why: &str) {
        self.guesses.push(Guess::new(what, guess, why));
    }

    /// Concludes on the angles' zero in place of the guess that was there.
    pub fn conclude_zero(&mut self, zero: &str, why: &str) {
        self.guesses.retain(|guess| guess.what != "angle zero");
        self.plan.angle_zero = zero.to_string();
        self.note("angle zero", zero, why);
    }

    /// The input of a joint (index from 0) counts the other way round.
    pub fn reverse_input(&mut self, joint: usize) {
        let Some(input) = self.columns.joints[joint].input.as_mut() else {
            return;
        };
        input.reversed = !input.reversed;
        let name = input.name.clone();
        self.note(
            &format!("column {name:?}"),
            "counts the other way round",
            "only so the joint follows it",
        );
    }

    /// Takes an estimated value, to four digits, into the plan.
    pub fn take(&mut self, path: &ParameterPath, value: f64) {
        let value = format!("{value:.3e}").parse().unwrap_or(value);
        match path {
            ParameterPath::Link { index, field } => {
                let link = &mut self.plan.links[*index];
                match field {
                    LinkField::Length => link.length_m = value,
                    LinkField::Com => link.com_m = value,
                    LinkField::Mass => link.mass_kg = value,
                    LinkField::Inertia => link.inertia_kg_m2 = Some(value),
                }
            }
            ParameterPath::Joint { index, field } => {
                let link = &mut self.plan.links[*index];
                match field {
                    JointField::StallTorque | JointField::StallForce => {
                        link.stall_torque_nm = Some(value);
                    }
                    JointField::NoLoadSpeed | JointField::NoLoadLinearSpeed => {
                        link.no_load_speed_rad_s = Some(value);
                    }
                    _ => link.gain = Some(value),
                }
            }
            ParameterPath::Effect { .. } => {
                for effect in &mut self.friction {
                    let own = ParameterPath::of_effect(effect).position(|own| own == *path);
                    if let Some(place) = own {
                        effect.values[place] = value;
                    }
                }
            }
        }
    }
}
