//! What a bench arm hides: a random effect, or a given one, at random values.

use super::rounding::rounded;
use rand::Rng;
use rand_chacha::ChaCha8Rng;
use std::f64::consts::PI;

/// What a challenge hides.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Hidden {
    /// Any effect, or once in twelve nothing.
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

/// How a value is drawn.
enum Draw {
    /// Always this.
    Fixed(f64),
    /// From a range.
    Within(f64, f64),
    /// From a range, with a random sign that all values of the effect share.
    Signed(f64, f64),
    /// 1 plus such a value.
    Factor(f64, f64),
    /// A whole number from a range.
    Whole(f64, f64),
}
use Draw::{Factor, Fixed, Signed, Whole, Within};

/// Keys of an effect's values, and how each is drawn.
type Parameters = &'static [(&'static str, Draw)];

/// Every effect that can be hidden.
const EFFECTS: [(&str, Parameters); 34] = [
    ("viscous", &[("coefficient_nm_s_rad", Within(0.01, 0.04))]),
    ("coulomb", &[("torque_nm", Within(0.02, 0.06))]),
    (
        "stribeck",
        &[
            ("excess_nm", Within(0.02, 0.06)),
            ("speed_rad_s", Within(0.1, 0.5)),
        ],
    ),
    ("load_friction", &[("factor", Within(0.06, 0.25))]),
    (
        "direction_asymmetry",
        &[("half_difference_nm", Signed(0.008, 0.02))],
    ),
    (
        "dead_zone",
        &[("width", Within(0.03, 0.08)), ("punch", Fixed(0.0))],
    ),
    ("backlash", &[("gap_rad", Within(0.03, 0.1))]),
    ("delay", &[("delay_s", Within(0.02, 0.08))]),
    ("supply_sensitivity", &[("sensitivity", Within(0.6, 1.2))]),
    ("supply_sag", &[("drop_share", Within(0.15, 0.4))]),
    ("torque_saturation", &[("limit_nm", Within(0.2, 0.4))]),
    ("speed_limit", &[("no_load_speed_rad_s", Within(6.0, 15.0))]),
    ("com_angle", &[("angle_rad", Signed(0.05, 0.15))]),
    ("mass", &[("added_kg", Signed(0.03, 0.08))]),
    ("armature", &[("inertia_kg_m2", Within(5e-4, 2e-3))]),
    (
        "cable_spring",
        &[
            ("stiffness_nm_rad", Within(0.03, 0.15)),
            ("rest_angle_rad", Within(-0.5, 0.5)),
        ],
    ),
    ("base_tilt", &[("angle_rad", Signed(0.05, 0.15))]),
    (
        "air_drag",
        &[("coefficient_nm_s2_rad2", Within(0.001, 0.004))],
    ),
    ("encoder_zero", &[("offset_rad", Signed(0.03, 0.1))]),
    ("encoder_scale", &[("factor", Factor(0.02, 0.06))]),
    ("sensor_lag", &[("time_constant_s", Within(0.02, 0.06))]),
    (
        "cogging",
        &[
            ("amplitude_nm", Within(0.01, 0.03)),
            ("periods_per_turn", Whole(6.0, 25.0)),
            ("phase_rad", Within(-PI, PI)),
        ],
    ),
    ("torque_scale", &[("factor", Factor(0.08, 0.25))]),
    (
        "drive_asymmetry",
        &[
            ("motor_factor", Within(0.1, 0.25)),
            ("outside_factor", Within(0.0, 0.05)),
        ],
    ),
    ("slew_limit", &[("rate_per_s", Within(0.6, 2.0))]),
    (
        "thermal_drift",
        &[
            ("rise", Within(10.0, 30.0)),
            ("time_constant_s", Within(4.0, 12.0)),
        ],
    ),
    (
        "fold_back",
        &[
            ("remaining_share", Within(0.3, 0.7)),
            ("level", Within(0.06, 0.12)),
            ("after_s", Within(0.15, 0.4)),
        ],
    ),
    (
        "pre_sliding",
        &[
            ("torque_nm", Within(0.02, 0.06)),
            ("stiffness_nm_rad", Within(0.3, 1.5)),
        ],
    ),
    (
        "gear_compliance",
        &[
            ("inertia_kg_m2", Within(1e-3, 3e-3)),
            ("stiffness_nm_rad", Within(0.5, 2.0)),
            ("damping_ratio", Within(0.05, 0.25)),
        ],
    ),
    (
        "gear_backlash",
        &[
            ("inertia_kg_m2", Within(1e-3, 3e-3)),
            ("gap_rad", Within(0.03, 0.12)),
        ],
    ),
    ("torque_offset", &[("offset_nm", Signed(0.01, 0.04))]),
    (
        "position_friction",
        &[
            ("below_nm", Within(0.02, 0.06)),
            ("above_nm", Within(0.0, 0.02)),
            ("span_rad", Within(0.4, 1.0)),
        ],
    ),
    (
        "base_compliance",
        &[
            ("stiffness_n_m", Within(60.0, 200.0)),
            ("mass_kg", Within(0.2, 0.6)),
            ("damping_ratio", Within(0.05, 0.25)),
        ],
    ),
    ("grip_slip", &[("acceleration_rad_s2", Within(15.0, 40.0))]),
];

/// What is drawn otherwise for the robot, whose drives are stronger and whose poles are faster.
const ROBOT_EFFECTS: [(&str, Parameters); 14] = [
    (
        "stribeck",
        &[
            ("excess_nm", Within(0.03, 0.08)),
            ("speed_rad_s", Within(0.1, 0.5)),
        ],
    ),
    (
        "dead_zone",
        &[("width", Within(0.02, 0.05)), ("punch", Fixed(0.0))],
    ),
    ("delay", &[("delay_s", Within(0.008, 0.03))]),
    (
        "gear_compliance",
        &[
            ("inertia_kg_m2", Within(1e-3, 3e-3)),
            ("stiffness_nm_rad", Within(4.0, 12.0)),
            ("damping_ratio", Within(0.05, 0.25)),
        ],
    ),
    (
        "gear_backlash",
        &[
            ("inertia_kg_m2", Within(1e-3, 3e-3)),
            ("gap_rad", Within(0.02, 0.06)),
        ],
    ),
    ("supply_sag", &[("drop_share", Within(0.2, 0.5))]),
    ("torque_saturation", &[("limit_nm", Within(0.4, 0.8))]),
    ("mass", &[("added_kg", Signed(0.05, 0.15))]),
    ("armature", &[("inertia_kg_m2", Within(1e-3, 4e-3))]),
    (
        "cable_spring",
        &[
            ("stiffness_nm_rad", Within(0.1, 0.4)),
            ("rest_angle_rad", Within(-0.5, 0.5)),
        ],
    ),
    (
        "air_drag",
        &[("coefficient_nm_s2_rad2", Within(0.002, 0.008))],
    ),
    (
        "cogging",
        &[
            ("amplitude_nm", Within(0.03, 0.08)),
            ("periods_per_turn", Whole(6.0, 25.0)),
            ("phase_rad", Within(-PI, PI)),
        ],
    ),
    (
        "base_compliance",
        &[
            ("stiffness_n_m", Within(500.0, 2000.0)),
            ("mass_kg", Within(0.5, 2.0)),
            ("damping_ratio", Within(0.05, 0.25)),
        ],
    ),
    ("grip_slip", &[("acceleration_rad_s2", Within(15.0, 40.0))]),
];

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
    /// The same effect at four fifths of its strength.
    pub fn weaker(&self) -> HiddenEffect {
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
                | ("base_compliance", "stiffness_n_m") => 1.25 * value,
                (_, "remaining_share") => 1.0 - 0.8 * (1.0 - value),
                (_, "factor") if self.kind != "load_friction" => 1.0 + 0.8 * (value - 1.0),
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
                _ => 0.8 * value,
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
            Hidden::Random => Some(KINDS[rng.random_range(0..KINDS.len())]),
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
            Fixed(value) => value,
            Within(low, high) => within(low, high),
            Signed(low, high) => sign * within(low, high),
            Factor(low, high) => rounded(1.0 + sign * within(low, high), 6),
            Whole(low, high) => within(low, high).floor(),
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
