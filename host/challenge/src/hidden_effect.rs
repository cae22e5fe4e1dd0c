//! What a bench arm hides: a random effect, or a given one, at random values.

mod draws;

use super::gyro;
use super::rounding::rounded;
use draws::{Draw, EFFECTS, LATER, Parameters, ROBOT_EFFECTS};
use rand::Rng;
use rand_chacha::ChaCha8Rng;

/// What a challenge hides.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Hidden {
    /// Any effect but those of a gyro and [`drive_lag`](KINDS), or once in twelve nothing.
    Random,
    /// Nothing: the model is complete but for its friction values.
    Nothing,
    /// This effect, one of [`KINDS`]; see [`kind_named`]. Any other name hides nothing.
    Effect(&'static str),
}

/// The hidden effect and its values.
#[derive(Debug, Clone, PartialEq)]
pub struct HiddenEffect {
    /// Id in the library of effects.
    pub kind: &'static str,
    /// Keys and values of the effect's parameters.
    pub parameters: Vec<(&'static str, f64)>,
}

/// Ids of the effects that can be hidden.
pub const KINDS: [&str; EFFECTS.len()] = {
    let mut kinds = [""; EFFECTS.len()];
    let mut k = 0;
    while k < kinds.len() {
        kinds[k] = EFFECTS[k].0;
        k += 1;
    }
    kinds
};

/// Whether an effect is of the rig, not of one of its joints.
pub fn of_whole_rig(kind: &str) -> bool {
    matches!(kind, "base_tilt" | "base_compliance")
}

/// The effect of this name, if it can be hidden.
pub fn kind_named(name: &str) -> Option<&'static str> {
    KINDS.into_iter().find(|kind| *kind == name)
}

impl HiddenEffect {
    /// The same effect at this share of its strength, above 0; values to six places.
    pub fn weakened(&self, share: f64) -> HiddenEffect {
        let parameters = self.parameters.iter().map(|&(key, value)| {
            let value = match (self.kind, key) {
                (
                    _,
                    "limit_nm"
                    | "no_load_speed_rad_s"
                    | "rate_per_s"
                    | "level"
                    | "acceleration_rad_s2",
                )
                | ("base_compliance", "stiffness_n_m") => value / share,
                (_, "remaining_share") => 1.0 - share * (1.0 - value),
                (_, "factor") if self.kind != "load_friction" => 1.0 + share * (value - 1.0),
                (
                    _,
                    "rest_angle_rad" | "periods_per_turn" | "phase_rad" | "speed_rad_s" | "after_s"
                    | "span_rad",
                )
                | ("pre_sliding" | "gear_compliance", "stiffness_nm_rad")
                | ("gear_compliance" | "base_compliance", "damping_ratio")
                | ("base_compliance", "mass_kg")
                | ("gear_backlash", "gap_rad")
                | ("thermal_drift", "time_constant_s") => value,
                _ => share * value,
            };
            (key, rounded(value, 6))
        });
        HiddenEffect {
            kind: self.kind,
            parameters: parameters.collect(),
        }
    }

    /// Its values in the order of its parameters.
    pub fn values(&self) -> Vec<f64> {
        self.parameters.iter().map(|(_, value)| *value).collect()
    }

    /// Draws which effect is hidden; `None` if none is, or if `hidden` names no effect of
    /// [`KINDS`].
    pub fn kind(rng: &mut ChaCha8Rng, hidden: Hidden) -> Option<&'static str> {
        match hidden {
            Hidden::Nothing => None,
            Hidden::Effect(kind) => kind_named(kind),
            Hidden::Random if rng.random_range(0..12) == 0 => None,
            Hidden::Random => {
                // A gyro in the log would tell that something is hidden in it.
                let others = KINDS
                    .into_iter()
                    .filter(|kind| !gyro::KINDS.contains(kind) && !LATER.contains(kind));
                let others: Vec<&'static str> = others.collect();
                Some(others[rng.random_range(0..others.len())])
            }
        }
    }

    /// Draws the values of this effect at the arm.
    pub fn random(rng: &mut ChaCha8Rng, kind: &'static str) -> HiddenEffect {
        let known = EFFECTS.iter().find(|(id, _)| *id == kind);
        Self::drawn(rng, kind, known)
    }

    /// Draws the values of this effect at a joint of the robot.
    pub fn of_robot(rng: &mut ChaCha8Rng, kind: &'static str) -> HiddenEffect {
        let mut known = ROBOT_EFFECTS.iter().chain(&EFFECTS);
        Self::drawn(rng, kind, known.find(|(id, _)| *id == kind))
    }

    fn drawn(
        rng: &mut ChaCha8Rng,
        kind: &'static str,
        known: Option<&(&str, Parameters)>,
    ) -> HiddenEffect {
        let sign = if rng.random_bool(0.5) { 1.0 } else { -1.0 };
        let mut within = |low: f64, high: f64| rounded(rng.random_range(low..high), 6);
        let mut draw = |draw: &Draw| match *draw {
            Draw::Fixed(value) => value,
            Draw::Within(low, high) => within(low, high),
            Draw::Signed(low, high) => sign * within(low, high),
            Draw::Factor(low, high) => rounded(1.0 + sign * within(low, high), 6),
            Draw::Whole(low, high) => within(low, high).floor(),
        };
        let parameters = known.map_or(&[][..], |(_, parameters)| parameters);
        HiddenEffect {
            kind,
            parameters: parameters
                .iter()
                .map(|(key, how)| (*key, draw(how)))
                .collect(),
        }
    }
}
