//! Laws every effect must keep, and values of those with a corner or a memory.

use super::signature::off_values;
use super::*;
use crate::dynamics::Chain;
use crate::dynamics::ChainLink;
use std::collections::HashSet;

mod diverged;
mod infos;
mod laws;
mod off;
mod sensors;
mod slides;
mod tables;

fn infos() -> impl Iterator<Item = &'static EffectInfo> {
    EFFECTS.iter().map(|effect| effect.info())
}

fn parameters() -> impl Iterator<Item = (&'static str, &'static Parameter)> {
    infos().flat_map(|info| info.parameters.iter().map(|parameter| (info.id, parameter)))
}

fn effect(id: &str) -> Effect {
    named(id).unwrap()
}

fn within((low, high): (f64, f64), value: f64) -> bool {
    (low..=high).contains(&value)
}

fn near(left: f64, right: f64) {
    assert!((left - right).abs() < 1e-12, "{left} is not {right}");
}

fn slide(speed_rad_s: f64, direction: f64) -> FrictionState {
    FrictionState {
        angle_rad: 0.0,
        speed_rad_s: speed_rad_s.abs(),
        direction,
        gear_load_nm: 0.5,
        motor_nm: 0.3,
        outside_nm: -0.2,
        bearing_load_n: 4.0,
        signals: Signals::NONE,
    }
}

fn rig() -> Rig {
    let link = ChainLink {
        length_m: 0.15,
        com_m: 0.12,
        com_angle_rad: 0.05,
        mass_kg: 0.4,
        inertia_kg_m2: 8e-4,
        armature_kg_m2: 2e-3,
        slide: None,
    };
    let chain = Chain {
        links: vec![link],
        gravity_m_s2: 9.81,
    };
    Rig {
        chain,
        tree: None,
        gravity_turn_rad: 0.0,
        turned: false,
        base_spring: None,
    }
}
