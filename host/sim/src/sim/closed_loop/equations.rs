//! What advances a plant in a loop: dense equations where they suffice, else the general
//! simulation.

use crate::dynamics::Dense;
use crate::sim::Plant;

/// What advances the plant.
#[derive(Debug, Clone)]
pub(super) enum Equations {
    One(Dense<1>),
    Two(Dense<2>),
    Three(Dense<3>),
    Four(Dense<4>),
    General,
}

impl Equations {
    /// The dense ones where torques are constant between commands, at most four links.
    pub(super) fn of(plant: &Plant) -> Equations {
        let held = |joint: &crate::sim::joint_plan::JointPlan| {
            !joint.has_joint_effects() && joint.follows_input
        };
        if plant.tree.is_some()
            || plant.senses
            || plant.remembers > 0
            || !plant.joints.iter().all(held)
        {
            return Equations::General;
        }
        let (chain, turn_rad) = (&plant.rig.chain, plant.rig.gravity_turn_rad);
        match chain.len() {
            1 => Dense::new(chain, turn_rad).map(Equations::One),
            2 => Dense::new(chain, turn_rad).map(Equations::Two),
            3 => Dense::new(chain, turn_rad).map(Equations::Three),
            4 => Dense::new(chain, turn_rad).map(Equations::Four),
            _ => None,
        }
        .unwrap_or(Equations::General)
    }
}

/// A state in absolute angles, joint 1's from hanging.
#[derive(Debug, Clone, Copy)]
pub(super) struct Absolute<const N: usize> {
    pub(super) angle_rad: [f64; N],
    pub(super) speed_rad_s: [f64; N],
    pub(super) load_nm: [f64; N],
}

impl<const N: usize> Default for Absolute<N> {
    fn default() -> Self {
        Absolute {
            angle_rad: [0.0; N],
            speed_rad_s: [0.0; N],
            load_nm: [0.0; N],
        }
    }
}
