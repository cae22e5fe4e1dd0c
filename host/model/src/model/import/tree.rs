//! A robot as other simulators describe it: rigid bodies in space, each carried by its parent.

use super::remark::Remark;
use crate::error::{Error, Place};
use nalgebra::{Isometry3, Matrix3, Point3, Vector3};
/// What is wrong with a part of the file: it refuses the robot only where the chain needs it.
#[derive(Debug, Clone, PartialEq)]
pub(in crate::model) struct Fault {
    /// Index of the body.
    pub body: usize,
    pub part: FaultyPart,
    place: Option<Place>,
    what: String,
    remedy: String,
}

/// Of what a fault is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::model) enum FaultyPart {
    /// Where a body stands on its parent.
    Pose,
    /// What it weighs.
    Mass,
    /// One of its joints.
    Joint,
}

impl Fault {
    pub fn new(body: usize, part: FaultyPart, error: &Error) -> Self {
        let (place, what) = match error {
            Error::Data { place, problem } => (Some(place.clone()), problem.what.clone()),
            other => (None, other.to_string()),
        };
        let remedy = error.remedy().unwrap_or_default().into_owned();
        Fault {
            body,
            part,
            place,
            what,
            remedy,
        }
    }

    pub fn error(&self) -> Error {
        match &self.place {
            Some(place) => Error::data(place.clone(), &self.what, &self.remedy),
            None => Error::usage(&self.what, &self.remedy),
        }
    }
}

/// Mass, its centre, and the moments about that.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::model) struct Inertial {
    /// kg.
    pub mass_kg: f64,
    /// Centre of mass in the body's frame, m.
    pub com_m: Point3<f64>,
    /// About the centre of mass along the body's axes, kg m^2.
    pub inertia_kg_m2: Matrix3<f64>,
}

impl Inertial {
    /// Nothing.
    pub const NONE: Inertial = Inertial {
        mass_kg: 0.0,
        com_m: Point3::new(0.0, 0.0, 0.0),
        inertia_kg_m2: Matrix3::new(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0),
    };

    /// The same in the frame in which its own has this pose.
    pub fn seen_from(&self, pose: &Isometry3<f64>) -> Inertial {
        let turn = pose.rotation.to_rotation_matrix();
        Inertial {
            mass_kg: self.mass_kg,
            com_m: pose * self.com_m,
            inertia_kg_m2: turn * self.inertia_kg_m2 * turn.inverse(),
        }
    }

    /// Both as one body; frames are the same.
    pub fn with(&self, other: &Inertial) -> Inertial {
        let mass_kg = self.mass_kg + other.mass_kg;
        if mass_kg <= 0.0 {
            return Inertial {
                inertia_kg_m2: self.inertia_kg_m2 + other.inertia_kg_m2,
                ..*self
            };
        }
        let weighted = self.com_m.coords * self.mass_kg + other.com_m.coords * other.mass_kg;
        let com_m = Point3::from(weighted / mass_kg);
        let about = |part: &Inertial| {
            let arm = part.com_m - com_m;
            let square = Matrix3::identity() * arm.norm_squared() - arm * arm.transpose();
            part.inertia_kg_m2 + square * part.mass_kg
        };
        Inertial {
            mass_kg,
            com_m,
            inertia_kg_m2: about(self) + about(other),
        }
    }
}

/// How a joint moves.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::model) enum JointMotion {
    /// About an axis.
    Hinge,
    /// Along an axis.
    Slide,
    /// In several ways: ball, floating, planar.
    Free,
}

/// What drives a joint in the file.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(in crate::model) enum TreeDrive {
    /// Nothing.
    #[default]
    None,
    /// A torque, N m, at most so large.
    Torque(Option<f64>),
    /// A share of full voltage, the torque at most `limit_nm`.
    Duty {
        stall_nm: f64,
        damping_nm_s: f64,
        limit_nm: Option<f64>,
    },
    /// torque = stiffness (goal - angle) - damping w, at most `limit_nm`.
    Position {
        stiffness_nm: f64,
        damping_nm_s: f64,
        limit_nm: f64,
    },
    /// torque = gain (goal - w), at most `limit_nm`.
    Speed { gain_nm_s: f64, limit_nm: f64 },
}

impl TreeDrive {
    /// What a model's file calls it.
    pub fn name(&self) -> &'static str {
        match self {
            TreeDrive::None => "passive",
            TreeDrive::Torque(_) => "torque",
            TreeDrive::Duty { .. } => "duty",
            TreeDrive::Position { .. } => "position",
            TreeDrive::Speed { .. } => "speed",
        }
    }
}

/// A joint between a body and its parent.
#[derive(Debug, Clone, PartialEq)]
pub(in crate::model) struct TreeJoint {
    pub name: String,
    /// Line of its element.
    pub line: usize,
    /// Byte at which its element begins.
    pub at: usize,
    /// Byte at which the actuator begins that drives it, if the file has one.
    pub actuator_at: Option<usize>,
    pub motion: JointMotion,
    /// In the body's frame, of length 1.
    pub axis: Vector3<f64>,
    /// A point of the axis in the body's frame, m.
    pub anchor_m: Point3<f64>,
    /// Coordinate in the pose that the file describes, rad.
    pub reference_rad: f64,
    pub damping_nm_s: f64,
    pub friction_nm: f64,
    pub armature_kg_m2: f64,
    pub stiffness_nm: f64,
    pub spring_rest_rad: f64,
    /// Between which coordinates its end stops let it move, where the file says both.
    pub range_rad: Option<(f64, f64)>,
    pub drive: TreeDrive,
    /// Largest torque of all that drives the joint, N m.
    pub most_nm: Option<f64>,
    /// The attribute that limits the drive, and its line.
    pub limited_by: (&'static str, usize),
    /// What of it the model does not hold.
    pub left_out: Vec<Remark>,
}

impl TreeJoint {
    pub fn new(name: String, line: usize, motion: JointMotion, axis: Vector3<f64>) -> Self {
        TreeJoint {
            name,
            line,
            at: 0,
            actuator_at: None,
            motion,
            axis,
            anchor_m: Point3::origin(),
            reference_rad: 0.0,
            damping_nm_s: 0.0,
            friction_nm: 0.0,
            armature_kg_m2: 0.0,
            stiffness_nm: 0.0,
            spring_rest_rad: 0.0,
            range_rad: None,
            drive: TreeDrive::None,
            most_nm: None,
            limited_by: ("", line),
            left_out: Vec::new(),
        }
    }

    /// Says that a part of it is not in the model.
    pub fn leave(&mut self, part: &str, line: usize, why: impl Into<String>) {
        let remark = Remark::new(part, Some(&self.name), why).on(line);
        self.left_out.push(remark);
    }
}

/// A rigid body.
#[derive(Debug, Clone, PartialEq)]
pub(in crate::model) struct TreeBody {
    pub name: String,
    /// Line of its element.
    pub line: usize,
    /// Byte at which its element begins.
    pub at: usize,
    /// Index of the body that carries it, always a smaller one; none for the world.
    pub parent: Option<usize>,
    /// In the parent's frame, with every joint at its reference.
    pub pose: Isometry3<f64>,
    pub inertial: Inertial,
    /// None where it is fixed to its parent.
    pub joints: Vec<TreeJoint>,
    /// Share of its weight that something bears: MuJoCo's `gravcomp`.
    pub borne: f64,
    /// What is told of it though it is in the model.
    pub notes: Vec<Remark>,
}

/// A robot, and what its file says beyond bodies and joints.
#[derive(Debug, Clone, PartialEq)]
pub(in crate::model) struct RobotTree {
    pub name: String,
    /// Parents before children; the first is the world, or what stands in it.
    pub bodies: Vec<TreeBody>,
    pub gravity_m_s2: Vector3<f64>,
    pub left_out: Vec<Remark>,
    pub faults: Vec<Fault>,
}

impl RobotTree {
    /// Poses of all bodies in the world.
    pub fn world_poses(&self) -> Vec<Isometry3<f64>> {
        let mut poses: Vec<Isometry3<f64>> = Vec::with_capacity(self.bodies.len());
        for body in &self.bodies {
            let pose = match body.parent {
                Some(parent) => poses[parent] * body.pose,
                None => body.pose,
            };
            poses.push(pose);
        }
        poses
    }
}
