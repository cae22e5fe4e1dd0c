//! Motors whose rigid flanks push: they move as their joints do, to whose inertia they add.

use super::{Forces, StateView};
use crate::dynamics::{Chain, SpatialEquations};
use crate::effects::{Coupling, Flank};
use crate::sim::plant::Plant;
use crate::sim::rows::Rows;
use crate::sim::stepper::Contact;

/// A plant's bodies with the motors that push their joints.
#[derive(Debug, Clone)]
pub(super) struct Joined {
    pub chain: Chain,
    pub tree: Option<SpatialEquations>,
    /// Of each joint, whether its motor moves along.
    motors: Vec<bool>,
}

impl Joined {
    /// Without any motor; none for a plant of which none has rigid flanks.
    pub fn new(plant: &Plant) -> Option<Box<Joined>> {
        plant.has_rigid_flanks.then(|| {
            Box::new(Joined {
                chain: plant.rig.chain.clone(),
                tree: plant.tree.clone(),
                motors: vec![false; plant.len()],
            })
        })
    }

    fn armature_mut(&mut self, joint: usize) -> &mut f64 {
        match &mut self.tree {
            Some(tree) => tree.armature_mut(joint),
            None => &mut self.chain.links[joint].armature_kg_m2,
        }
    }
}

impl<R: Rows> Forces<R> {
    /// Lets those motors move with their joints whose rigid flanks push, and no others.
    pub fn join_motors(&mut self, plant: &Plant) {
        let Some(joined) = &mut self.joined else {
            return;
        };
        let mut is_new = false;
        for joint in 0..plant.len() {
            let pushes = self.auxiliary.flank[joint] != Flank::None;
            if let Some(coupling) = plant.joints[joint].rigid_flanks()
                && joined.motors[joint] != pushes
            {
                let by = if pushes { 1.0 } else { -1.0 };
                *joined.armature_mut(joint) += by * coupling.inertia_kg_m2;
                joined.motors[joint] = pushes;
                is_new = true;
            }
        }
        if is_new {
            self.closed = R::closed(plant, &joined.chain);
        }
    }

    /// Whether a rigid flank pushes a joint, whose motor moves along.
    pub fn is_joined(&self, joint: usize) -> bool {
        let joined = self.joined.as_deref();
        joined.is_some_and(|joined| joined.motors[joint])
    }

    /// Whether one pushes any joint.
    pub fn is_any_joined(&self) -> bool {
        let joined = self.joined.as_deref();
        joined.is_some_and(|joined| joined.motors.contains(&true))
    }

    /// Lets motors that move with their joints speed up as these do.
    pub(super) fn carry_motors(&mut self, contact: &[Contact], slope: &[f64]) {
        let Some(joined) = &self.joined else {
            return;
        };
        for (joint, moves_along) in joined.motors.iter().enumerate() {
            if *moves_along {
                let is_held = contact[joint] == Contact::Held;
                self.auxiliary.slope[joint] = if is_held { 0.0 } else { slope[joint] };
            }
        }
    }

    /// What the flank of a motor that moves with its joint pushes with, N m, at the accelerations
    /// found last; below 0 where it would pull.
    pub fn pushed_nm(&self, coupling: &Coupling, joint: usize, direction: f64) -> f64 {
        let speeding_up = coupling.inertia_kg_m2 * self.auxiliary.slope[joint];
        direction * (self.drive_torque[joint] - speeding_up)
    }

    /// By how much a push of 1 N m s at a joint changes the speeds of all, rad/s, and behind them
    /// the base's, m/s.
    pub fn response(&mut self, plant: &Plant, joint: usize, angle: &[f64]) -> Vec<f64> {
        let joints = angle.len();
        let (still, contact) = (vec![0.0; joints], vec![Contact::Free; joints]);
        let at = StateView {
            angle,
            speed: &still,
            contact: &contact,
        };
        self.held.as_mut().fill(false);
        let [rest, pushed] = [0.0, 1.0].map(|torque_nm| {
            self.torque.as_mut().fill(0.0);
            self.torque[joint] = torque_nm;
            let mut out = vec![0.0; joints];
            self.solve(plant, at, &mut out);
            out.extend(self.auxiliary.slope.iter().skip(joints));
            out
        });
        let changes = rest.iter().zip(&pushed);
        changes.map(|(rest, pushed)| pushed - rest).collect()
    }
}
