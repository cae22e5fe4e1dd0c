//! What masses, gravity, the base and gears do, from an effect's own hooks.

use super::FULL_TORQUE_NM;
use crate::dynamics::{Chain, ChainLink};
use crate::effects::{Coupling, Effect, Gear, Rig};

/// Torque of a gear that is wound up and at rest, N m, up to the motor's; of a rigid one as if it
/// were very stiff.
pub(super) fn wound_nm(effect: Effect, values: &[f64], wound_rad: f64) -> f64 {
    let mut gear = Gear::RIGID;
    effect.gear(values, &mut gear);
    let torque_nm = match Coupling::of(&gear) {
        Some(coupling) => coupling.torque_nm(wound_rad, 0.0),
        None => 1e6 * wound_rad,
    };
    torque_nm.clamp(-FULL_TORQUE_NM, FULL_TORQUE_NM)
}

/// A bench arm, 0.3 kg at 0.12 m, as the effect changes it.
pub(super) fn arm(effect: Effect, values: &[f64]) -> Rig {
    let link = ChainLink {
        length_m: 0.15,
        com_m: 0.12,
        com_angle_rad: 0.0,
        mass_kg: 0.3,
        inertia_kg_m2: 8e-4,
        armature_kg_m2: 2e-3,
        slide: None,
    };
    let chain = Chain {
        links: vec![link],
        gravity_m_s2: 9.81,
    };
    let mut rig = Rig {
        chain,
        tree: None,
        gravity_turn_rad: 0.0,
        turned: false,
        base_spring: None,
    };
    effect.body(values, 0, &mut rig);
    rig
}

pub(super) fn gravity_nm(effect: Effect, values: &[f64], angle_rad: f64) -> f64 {
    let rig = arm(effect, values);
    let link = &rig.chain.links[0];
    let peak_nm = link.mass_kg * rig.chain.gravity_m_s2 * link.com_m;
    -peak_nm * (angle_rad + link.com_angle_rad - rig.gravity_turn_rad).sin()
}

pub(super) fn inertia_nm(effect: Effect, values: &[f64], acceleration_rad_s2: f64) -> f64 {
    let link = &arm(effect, values).chain.links[0];
    let about_joint = link.mass_kg * link.com_m.powi(2) + link.inertia_kg_m2 + link.armature_kg_m2;
    about_joint * acceleration_rad_s2
}

/// Displacement of a base at rest, m.
pub(super) fn gives_way_m(effect: Effect, values: &[f64], force_n: f64) -> f64 {
    let base = arm(effect, values).base_spring;
    base.map_or(0.0, |base| force_n / base.stiffness_n_m)
}
