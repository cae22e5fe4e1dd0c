//! A tree at a pose in closed form: its mass matrix, the torques that hold it there at rest, and
//! how those change with the pose.
//!
//! In the base's axes joint j has the axis a_j through p_j and carries the mass m_j with the first
//! moment s_j and the moments of inertia I_j about p_j. At a speed of 1 of that joint alone, what
//! it carries has the momentum f_j = a_j x s_j and the angular momentum n_j = I_j a_j about p_j; of
//! a slide f_j = m_j a_j and n_j = s_j x a_j. With i the joint j itself or one that carries it,
//!
//! ```text
//! M_ij = a_i . (n_j + (p_j - p_i) x f_j)      G_j = -g . f_j      dG_j/dq_i = -g . (a_i x f_j)
//! ```
//!
//! where a slide i has M_ij = a_i . f_j and dG_j/dq_i = 0; rotors add to M_ii. dG/dq is symmetric,
//! for G is the slope of a potential, and joints of different branches share nothing.
//! (Featherstone, Rigid Body Dynamics Algorithms (2008), section 6.2.)

use super::{SpatialLink, SpatialTree};
use nalgebra::{DMatrix, DVector, Isometry3, Matrix3, Vector3};

/// A [`SpatialTree`] at a pose: for analysis, as
/// [`EquationsOfMotion`](crate::dynamics::EquationsOfMotion) is of a planar chain.
#[derive(Debug, Clone)]
pub struct TreeAtPose {
    joints: Vec<JointAtPose>,
    gravity_m_s2: Vector3<f64>,
}

/// A joint, and what it gives at a speed of 1; vectors in the base's axes.
#[derive(Debug, Clone)]
struct JointAtPose {
    parent: Option<usize>,
    slides: bool,
    armature_kg_m2: f64,
    at: Vector3<f64>,
    axis: Vector3<f64>,
    /// Momentum of what it carries, f_j above.
    momentum: Vector3<f64>,
    /// Angular momentum of that about the joint, n_j above.
    angular: Vector3<f64>,
}

/// What a joint carries, as seen from it: mass, first moment, moments of inertia.
#[derive(Debug, Clone, Copy)]
struct Load {
    mass_kg: f64,
    moment: Vector3<f64>,
    inertia: Matrix3<f64>,
}

impl Load {
    /// A link whose frame has this pose.
    fn of(link: &SpatialLink, pose: &Isometry3<f64>) -> Load {
        let turn = pose.rotation.to_rotation_matrix();
        let arm = turn * link.com_m;
        Load {
            mass_kg: link.mass_kg,
            moment: arm * link.mass_kg,
            inertia: turn * link.inertia_kg_m2 * turn.inverse() + about(&arm) * link.mass_kg,
        }
    }

    /// Adds a load about a point that lies `arm` from this one's.
    fn add(&mut self, other: &Load, arm: &Vector3<f64>) {
        let cross = other.moment * arm.transpose();
        let twice = 2.0 * other.moment.dot(arm);
        self.mass_kg += other.mass_kg;
        self.moment += other.moment + arm * other.mass_kg;
        self.inertia += other.inertia + about(arm) * other.mass_kg + Matrix3::identity() * twice
            - cross
            - cross.transpose();
    }
}

/// Moments of inertia of 1 kg at the end of an arm.
fn about(arm: &Vector3<f64>) -> Matrix3<f64> {
    Matrix3::identity() * arm.norm_squared() - arm * arm.transpose()
}

impl TreeAtPose {
    /// Of a tree at these angles, rad, or m where a joint slides; as many as links.
    pub fn new(tree: &SpatialTree, angle_rad: &[f64]) -> TreeAtPose {
        let poses = tree.poses(angle_rad);
        let links = || tree.links.iter().zip(&poses);
        let mut loads: Vec<Load> = links().map(|(link, pose)| Load::of(link, pose)).collect();
        for (index, link) in tree.links.iter().enumerate().rev() {
            if let Some(parent) = link.parent {
                let arm = poses[index].translation.vector - poses[parent].translation.vector;
                let own = loads[index];
                loads[parent].add(&own, &arm);
            }
        }
        let joint = |((link, pose), load): ((&SpatialLink, &Isometry3<f64>), &Load)| {
            let axis = pose * link.axis.into_inner();
            let (momentum, angular) = if link.slides {
                (axis * load.mass_kg, load.moment.cross(&axis))
            } else {
                (axis.cross(&load.moment), load.inertia * axis)
            };
            JointAtPose {
                parent: link.parent,
                slides: link.slides,
                armature_kg_m2: link.armature_kg_m2,
                at: pose.translation.vector,
                axis,
                momentum,
                angular,
            }
        };
        TreeAtPose {
            joints: links().zip(&loads).map(joint).collect(),
            gravity_m_s2: tree.gravity_m_s2,
        }
    }

    /// M, n x n, kg m^2 (kg m, kg where joints slide): symmetric, positive definite.
    pub fn mass(&self) -> DMatrix<f64> {
        let mut mass = self.symmetric(|i, j| {
            let turned = j.angular + (j.at - i.at).cross(&j.momentum);
            i.axis.dot(if i.slides { &j.momentum } else { &turned })
        });
        for (index, joint) in self.joints.iter().enumerate() {
            mass[(index, index)] += joint.armature_kg_m2;
        }
        mass
    }

    /// G, n, N m (N where joints slide): the torques that hold the tree at rest.
    pub fn gravity(&self) -> DVector<f64> {
        let torques = self
            .joints
            .iter()
            .map(|j| -self.gravity_m_s2.dot(&j.momentum));
        DVector::from_iterator(self.joints.len(), torques)
    }

    /// dG/dq, n x n, N m/rad: symmetric.
    pub fn gravity_slope(&self) -> DMatrix<f64> {
        self.symmetric(|i, j| {
            if i.slides {
                0.0
            } else {
                -self.gravity_m_s2.dot(&i.axis.cross(&j.momentum))
            }
        })
    }

    /// The largest torque with which gravity of this strength could pull at a joint, whichever way
    /// the base were turned, N m (N).
    pub fn largest_gravity_nm(&self) -> f64 {
        let strength = self.gravity_m_s2.norm();
        let torques = self.joints.iter().map(|j| strength * j.momentum.norm());
        torques.fold(0.0, f64::max)
    }

    /// A symmetric matrix of `of(i, j)`, where i is j or carries it; else 0.
    fn symmetric(&self, of: impl Fn(&JointAtPose, &JointAtPose) -> f64) -> DMatrix<f64> {
        let n = self.joints.len();
        let mut matrix = DMatrix::zeros(n, n);
        for (j, joint) in self.joints.iter().enumerate() {
            let mut carrier = Some(j);
            while let Some(i) = carrier {
                let entry = of(&self.joints[i], joint);
                (matrix[(i, j)], matrix[(j, i)]) = (entry, entry);
                carrier = self.joints[i].parent;
            }
        }
        matrix
    }
}
