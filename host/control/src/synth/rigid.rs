//! The rigid robot of a model, body effects included: a planar chain or a tree in space.

use crate::dynamics::{EquationsOfMotion, SpatialTree, TreeAtPose};
use crate::effects::Rig;
use crate::model::Model;
use nalgebra::{DMatrix, DVector};

/// The robot without its drives and joint effects.
#[derive(Debug, Clone)]
pub(super) enum Rigid {
    Chain {
        equations: EquationsOfMotion,
        /// Joint whose turn levels what hangs, if any turns.
        first_hinge: Option<usize>,
    },
    Tree(SpatialTree),
}

/// The same at a pose, at rest.
#[derive(Debug, Clone)]
pub(super) struct RigidAtPose {
    /// M, n x n, kg m^2.
    pub mass: DMatrix<f64>,
    /// G, n, N m: the torques that hold it.
    pub gravity_nm: DVector<f64>,
    /// dG/dq, n x n, N m/rad.
    pub gravity_slope: DMatrix<f64>,
}

/// A model's rig with gears that give as if they were rigid.
pub(super) fn rigid_rig(model: &Model) -> Rig {
    let mut model = model.clone();
    let rigid: Vec<_> = model.effects.iter().filter_map(|e| e.rigid()).collect();
    model.effects.extend(rigid);
    model.rig(false)
}

impl Rigid {
    pub fn of(model: &Model) -> Rigid {
        let rig = rigid_rig(model);
        match rig.tree {
            Some(tree) => Rigid::Tree(tree),
            None => Rigid::Chain {
                equations: EquationsOfMotion::new(&rig.chain, rig.gravity_turn_rad),
                first_hinge: model.joints.iter().position(|joint| joint.slide.is_none()),
            },
        }
    }

    /// At relative angles, rad, joint 1 of a chain from hanging; of slides m.
    pub fn at(&self, relative_rad: &[f64]) -> RigidAtPose {
        match self {
            Rigid::Chain { equations, .. } => RigidAtPose {
                mass: equations.mass(relative_rad),
                gravity_nm: equations.gravity(relative_rad),
                gravity_slope: equations.gravity_slope(relative_rad),
            },
            Rigid::Tree(tree) => {
                let tree = TreeAtPose::new(tree, relative_rad);
                RigidAtPose {
                    mass: tree.mass(),
                    gravity_nm: tree.gravity(),
                    gravity_slope: tree.gravity_slope(),
                }
            }
        }
    }

    /// How large the torques of gravity get about these angles, N m: what a torque is small beside.
    pub fn largest_gravity_nm(&self, relative_rad: &[f64]) -> f64 {
        match self {
            Rigid::Chain {
                equations,
                first_hinge,
            } => {
                let mut level_rad = relative_rad.to_vec();
                if let Some(hinge) = first_hinge {
                    level_rad[*hinge] += std::f64::consts::FRAC_PI_2;
                }
                let largest = |angle_rad: &[f64]| equations.gravity(angle_rad).amax();
                largest(relative_rad).max(largest(&level_rad))
            }
            Rigid::Tree(tree) => TreeAtPose::new(tree, relative_rad).largest_gravity_nm(),
        }
    }
}
