//! A rig drawn by lot, what its owner believes of it, and what is hidden in it.

use super::Hidden;
use super::physics::Physics;
use rand::Rng;
use rand_chacha::ChaCha8Rng;
use std::f64::consts::PI;

/// Torque at full duty and standstill, N m.
pub const STALL_NM: f64 = 1.5;
/// Supply at which the stall torque holds, V.
pub const NOMINAL_SUPPLY_V: f64 = 9.8;

/// Every effect that can be hidden.
pub const KINDS: [&str; 23] = [
    "viscous",
    "coulomb",
    "stribeck",
    "load_friction",
    "direction_asymmetry",
    "dead_zone",
    "backlash",
    "delay",
    "supply_sensitivity",
    "supply_sag",
    "torque_saturation",
    "speed_limit",
    "com_angle",
    "mass",
    "armature",
    "cable_spring",
    "base_tilt",
    "air_drag",
    "encoder_zero",
    "encoder_scale",
    "sensor_lag",
    "cogging",
    "torque_scale",
];

/// The effect of this name, if it can be hidden.
pub fn kind_named(name: &str) -> Option<&'static str> {
    KINDS.into_iter().find(|kind| *kind == name)
}

/// Friction of an arm: each is absent where it is the hidden effect.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Friction {
    /// N m s/rad.
    pub viscous: Option<f64>,
    /// N m.
    pub coulomb: Option<f64>,
}

/// The arm without what is hidden in it.
#[derive(Debug, Clone, PartialEq)]
pub struct Rig {
    /// Joint to centre of mass, m.
    pub com_m: f64,
    /// Mass of the link, kg.
    pub mass_kg: f64,
    /// Inertia about the centre of mass, kg m^2.
    pub inertia_kg_m2: f64,
    /// As it is.
    pub friction: Friction,
    /// As its owner believes: up to 30 % off.
    pub believed: Friction,
}

/// The hidden effect and its values.
#[derive(Debug, Clone, PartialEq)]
pub struct Secret {
    /// Id in the library of effects.
    pub kind: &'static str,
    /// Keys and values of the effect's parameters.
    pub parameters: Vec<(&'static str, f64)>,
}

impl Rig {
    /// Draws a rig for `secret`.
    pub fn random(rng: &mut ChaCha8Rng, secret: Option<&Secret>) -> Rig {
        let com_m = rounded(rng.random_range(0.08..0.1), 4);
        let mass_kg = rounded(rng.random_range(0.21..0.29), 4);
        let inertia_kg_m2 = rounded(rng.random_range(4.8e-4..7.2e-4), 7);
        let viscous = rounded(rng.random_range(0.008..0.02), 5);
        let coulomb = rounded(rng.random_range(0.015..0.035), 5);
        let mut off = |value: f64| rounded(value * rng.random_range(0.7..1.3), 4);
        let believed = [off(viscous), off(coulomb)];
        let hides = |kind| secret.is_some_and(|secret| secret.kind == kind);
        let friction = |[viscous, coulomb]: [f64; 2]| Friction {
            viscous: (!hides("viscous")).then_some(viscous),
            coulomb: (!hides("coulomb")).then_some(coulomb),
        };
        Rig {
            com_m,
            mass_kg,
            inertia_kg_m2,
            friction: friction([viscous, coulomb]),
            believed: friction(believed),
        }
    }

    /// The laws of the arm with its friction, and with the secret if there is one.
    pub fn physics(&self, secret: Option<&Secret>) -> Physics {
        let mut physics = Physics::ideal(
            self.com_m,
            self.mass_kg,
            self.inertia_kg_m2,
            STALL_NM,
            NOMINAL_SUPPLY_V,
        );
        for (kind, value) in [
            ("viscous", self.friction.viscous),
            ("coulomb", self.friction.coulomb),
        ] {
            if let Some(value) = value {
                physics.switch_on(kind, &[value]);
            }
        }
        if let Some(secret) = secret {
            let values: Vec<f64> = secret.parameters.iter().map(|(_, value)| *value).collect();
            assert!(
                physics.switch_on(secret.kind, &values),
                "{} has no law here",
                secret.kind
            );
        }
        physics
    }
}

impl Secret {
    /// Draws which effect is hidden; `None` if none is, or if `hidden` names no effect of [`KINDS`].
    pub fn kind(rng: &mut ChaCha8Rng, hidden: Hidden) -> Option<&'static str> {
        match hidden {
            Hidden::Nothing => None,
            Hidden::Effect(kind) => kind_named(kind),
            Hidden::Random if rng.random_range(0..12) == 0 => None,
            Hidden::Random => Some(KINDS[rng.random_range(0..KINDS.len())]),
        }
    }

    /// Draws the values of this effect.
    pub fn random(rng: &mut ChaCha8Rng, kind: &'static str) -> Secret {
        Secret {
            kind,
            parameters: parameters(rng, kind),
        }
    }
}

/// Keys and drawn values of `kind`.
fn parameters(rng: &mut ChaCha8Rng, kind: &str) -> Vec<(&'static str, f64)> {
    let sign = if rng.random_bool(0.5) { 1.0 } else { -1.0 };
    let mut within = |low: f64, high: f64| rounded(rng.random_range(low..high), 6);
    match kind {
        "viscous" => vec![("coefficient_nm_s_rad", within(0.01, 0.04))],
        "coulomb" => vec![("torque_nm", within(0.02, 0.06))],
        "stribeck" => vec![
            ("excess_nm", within(0.02, 0.06)),
            ("speed_rad_s", within(0.1, 0.5)),
        ],
        "load_friction" => vec![("factor", within(0.06, 0.25))],
        "direction_asymmetry" => vec![("half_difference_nm", sign * within(0.008, 0.02))],
        "dead_zone" => vec![("width", within(0.03, 0.08)), ("punch", 0.0)],
        "backlash" => vec![("gap_rad", within(0.03, 0.1))],
        "delay" => vec![("delay_s", within(0.02, 0.08))],
        "supply_sensitivity" => vec![("sensitivity", within(0.6, 1.2))],
        "supply_sag" => vec![("drop_share", within(0.15, 0.4))],
        "torque_saturation" => vec![("limit_nm", within(0.2, 0.4))],
        "speed_limit" => vec![("no_load_speed_rad_s", within(6.0, 15.0))],
        "com_angle" | "base_tilt" => vec![("angle_rad", sign * within(0.05, 0.15))],
        "mass" => vec![("added_kg", sign * within(0.03, 0.08))],
        "armature" => vec![("inertia_kg_m2", within(5e-4, 2e-3))],
        "cable_spring" => vec![
            ("stiffness_nm_rad", within(0.03, 0.15)),
            ("rest_angle_rad", within(-0.5, 0.5)),
        ],
        "air_drag" => vec![("coefficient_nm_s2_rad2", within(0.001, 0.004))],
        "encoder_zero" => vec![("offset_rad", sign * within(0.03, 0.1))],
        "encoder_scale" => vec![("factor", rounded(1.0 + sign * within(0.02, 0.06), 6))],
        "sensor_lag" => vec![("time_constant_s", within(0.02, 0.06))],
        "cogging" => vec![
            ("amplitude_nm", within(0.01, 0.03)),
            ("periods_per_turn", within(6.0, 25.0).floor()),
            ("phase_rad", within(-PI, PI)),
        ],
        "torque_scale" => vec![("factor", rounded(1.0 + sign * within(0.08, 0.25), 6))],
        _ => Vec::new(),
    }
}

/// To `digits` decimal places, so that files hold exactly what was simulated; never a negative zero.
pub fn rounded(value: f64, digits: i32) -> f64 {
    let unit = 10_f64.powi(digits);
    (value * unit).round() / unit + 0.0
}
