//! A random bench arm, and what its owner believes of it.

use super::gyro;
use super::hidden_effect::HiddenEffect;
use super::physics::Physics;
use super::rounding::rounded;
use rand::Rng;
use rand_chacha::ChaCha8Rng;

/// Torque at full duty and standstill, N m.
pub const STALL_NM: f64 = 1.5;
/// Supply at which the stall torque holds, V.
pub const NOMINAL_SUPPLY_V: f64 = 9.8;

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
pub struct BenchArm {
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
    /// Whether a gyro sits on the link.
    pub has_gyro: bool,
}

impl BenchArm {
    /// Draws a rig for what is to be hidden in it.
    pub fn random(rng: &mut ChaCha8Rng, secrets: &[HiddenEffect]) -> BenchArm {
        let com_m = rounded(rng.random_range(0.08..0.1), 4);
        let mass_kg = rounded(rng.random_range(0.21..0.29), 4);
        let inertia_kg_m2 = rounded(rng.random_range(4.8e-4..7.2e-4), 7);
        let viscous = rounded(rng.random_range(0.008..0.02), 5);
        let coulomb = rounded(rng.random_range(0.015..0.035), 5);
        let mut off = |value: f64| rounded(value * rng.random_range(0.7..1.3), 4);
        let believed = [off(viscous), off(coulomb)];
        let hides = |kind| secrets.iter().any(|secret| secret.kind == kind);
        let friction = |[viscous, coulomb]: [f64; 2]| Friction {
            viscous: (!hides("viscous")).then_some(viscous),
            coulomb: (!hides("coulomb")).then_some(coulomb),
        };
        BenchArm {
            com_m,
            mass_kg,
            inertia_kg_m2,
            friction: friction([viscous, coulomb]),
            believed: friction(believed),
            has_gyro: gyro::KINDS.into_iter().any(hides),
        }
    }

    /// The laws of the arm with its friction and these secrets.
    pub fn physics(&self, secrets: &[HiddenEffect]) -> Physics {
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
        for secret in secrets {
            assert!(
                physics.switch_on(secret.kind, &secret.values()),
                "{} has no law here",
                secret.kind
            );
        }
        physics
    }
}
