//! A robot's file as a tree of links in space: every joint that moves alone, the rest held.

use super::remark::Remark;
use super::tree::{Fault, FaultyPart, Inertial, JointMotion, RobotTree, TreeBody, TreeJoint};
use crate::dynamics::{SpatialLink, SpatialTree};
use crate::error::{Error, Place, Result};
use crate::model::robot::about_axis;
use nalgebra::{Isometry3, Translation3, Unit, UnitQuaternion};

/// A moment so little below 0 beside the mass is noise, m^2.
const NOISE_M2: f64 = 1e-9;

/// A joint that is held, and where, rad or m.
pub type Locked = (String, f64);

/// The tree, and how the file names its joints and links.
#[derive(Debug, Clone, PartialEq)]
pub(in crate::model) struct InSpace {
    pub tree: SpatialTree,
    /// Of each link: the joint that carries it.
    pub joints: Vec<TreeJoint>,
    /// Of each link: the body's name and line.
    pub bodies: Vec<(String, usize)>,
    /// Of each body of the file: the link to which it is fixed, none for the base, and where its
    /// frame stands in that link's.
    pub fixed: Vec<(Option<usize>, Isometry3<f64>)>,
    pub left_out: Vec<Remark>,
    /// What the model holds and no body has: impossible moments.
    pub notes: Vec<Remark>,
}

/// Builds the tree link by link.
struct Builder<'a> {
    robot: &'a RobotTree,
    locked: &'a [Locked],
    file: &'a str,
    inertials: Vec<Inertial>,
    found: InSpace,
}

/// The tree of all hinges and slides of a robot but those locked, and those that follow another
/// joint, which are held where the file has them.
///
/// # Errors
/// A joint that is locked and not there, one that moves in several ways, and links that would move
/// without mass.
pub(in crate::model) fn in_space(
    robot: &RobotTree,
    locked: &[Locked],
    file: &str,
) -> Result<InSpace> {
    let names = || robot.bodies.iter().flat_map(|body| &body.joints);
    for (name, _) in locked {
        if !names().any(|joint| joint.name == *name) {
            let all: Vec<&str> = names().map(|joint| joint.name.as_str()).collect();
            return Err(Error::usage(
                format!("{file}: there is no joint \"{name}\" to lock"),
                format!("its joints: {}", all.join(", ")),
            ));
        }
    }
    let mut builder = Builder {
        robot,
        locked,
        file,
        inertials: Vec::new(),
        found: InSpace {
            tree: SpatialTree {
                links: Vec::new(),
                gravity_m_s2: robot.gravity_m_s2,
            },
            joints: Vec::new(),
            bodies: Vec::new(),
            fixed: Vec::with_capacity(robot.bodies.len()),
            left_out: Vec::new(),
            notes: Vec::new(),
        },
    };
    for body in 0..robot.bodies.len() {
        builder.add(body)?;
    }
    builder.finish()
}

impl Builder<'_> {
    fn add(&mut self, index: usize) -> Result<()> {
        let robot = self.robot;
        let body = &robot.bodies[index];
        let (mut owner, mut stands) = match body.parent {
            Some(parent) => {
                let (owner, stands) = self.found.fixed[parent];
                (owner, stands * body.pose)
            }
            None => (None, body.pose),
        };
        for joint in &body.joints {
            let anchor = Translation3::from(joint.anchor_m.coords);
            let axis = Unit::new_normalize(joint.axis);
            if let Some(coordinate) = self.held_at(joint)? {
                let moved = motion(joint, &axis, coordinate - joint.reference_rad);
                stands = stands * anchor * moved * anchor.inverse();
                continue;
            }
            let place = stands * anchor * motion(joint, &axis, -joint.reference_rad);
            self.found.tree.links.push(SpatialLink {
                parent: owner,
                place,
                axis,
                slides: joint.motion == JointMotion::Slide,
                mass_kg: 0.0,
                com_m: nalgebra::Vector3::zeros(),
                inertia_kg_m2: nalgebra::Matrix3::zeros(),
                armature_kg_m2: 0.0,
            });
            self.found.joints.push(joint.clone());
            self.found.bodies.push((body.name.clone(), body.line));
            self.inertials.push(Inertial::NONE);
            owner = Some(self.inertials.len() - 1);
            stands = Isometry3::from(anchor.inverse());
        }
        self.found.fixed.push((owner, stands));
        if owner.is_some() {
            self.sound(index)?;
        }
        if let Some(owner) = owner {
            let part = body.inertial.seen_from(&stands);
            self.inertials[owner] = self.inertials[owner].with(&part);
            self.remark(body);
        }
        Ok(())
    }

    /// Where a joint is held; none where it moves.
    fn held_at(&mut self, joint: &TreeJoint) -> Result<Option<f64>> {
        let mut hold = |at, why: String| {
            let remark = Remark::new("joint", Some(&joint.name), why).on(joint.line);
            self.found.left_out.push(remark);
            Ok(Some(at))
        };
        if let Some((_, at)) = self.locked.iter().find(|(name, _)| *name == joint.name) {
            return hold(*at, format!("held at {at}"));
        }
        let follows = |part: &Remark| {
            part.part == "mimic" && part.name.as_deref() == Some(joint.name.as_str())
        };
        match joint.motion {
            JointMotion::Free => hold(
                joint.reference_rad,
                "it moves in several ways and is held where the file has it".into(),
            ),
            JointMotion::Hinge | JointMotion::Slide if self.robot.left_out.iter().any(follows) => {
                hold(
                    joint.reference_rad,
                    "it follows another joint and is held where the file has it".into(),
                )
            }
            JointMotion::Hinge | JointMotion::Slide => Ok(None),
        }
    }

    /// Refuses a body that the tree needs and the file has wrong.
    fn sound(&self, index: usize) -> Result<()> {
        let own = |fault: &&Fault| {
            fault.body == index
                && matches!(
                    fault.part,
                    FaultyPart::Pose | FaultyPart::Mass | FaultyPart::Joint
                )
        };
        match self.robot.faults.iter().find(own) {
            Some(fault) => Err(fault.error()),
            None => Ok(()),
        }
    }

    fn remark(&mut self, body: &TreeBody) {
        if body.borne != 0.0 {
            let why = "every link here has its whole weight";
            let remark = Remark::new("gravcomp", Some(&body.name), why).on(body.line);
            self.found.left_out.push(remark);
        }
        self.found.notes.extend(body.notes.iter().cloned());
    }

    fn finish(mut self) -> Result<InSpace> {
        if self.inertials.is_empty() {
            return Err(Error::usage(
                format!("{}: no joint moves", self.file),
                "a model needs a hinge or a slide that is not locked",
            ));
        }
        for (link, inertial) in self.found.tree.links.iter_mut().zip(&self.inertials) {
            link.mass_kg = inertial.mass_kg;
            link.com_m = inertial.com_m.coords;
            link.inertia_kg_m2 = inertial.inertia_kg_m2;
        }
        let massless = |&index: &usize| self.inertials[index].mass_kg <= 0.0;
        let carries = |index: usize| {
            let parents = self.found.tree.links.iter().map(|link| link.parent);
            parents.into_iter().any(|parent| parent == Some(index))
        };
        let tip = (0..self.inertials.len())
            .filter(massless)
            .find(|&i| !carries(i));
        if let Some(tip) = tip {
            let (name, line) = &self.found.bodies[tip];
            return Err(Error::data(
                self.line(*line),
                format!(
                    "the link {name}, which joint {} moves, has no mass, nor has anything that is \
                     fixed to it",
                    self.found.joints[tip].name
                ),
                "give it an <inertial>, or lock its joint",
            ));
        }
        self.possible()?;
        Ok(self.found)
    }

    /// A line of the robot's file.
    fn line(&self, line: usize) -> Place {
        Place {
            line: Some(line),
            ..Place::file(self.file)
        }
    }

    /// Refuses moments about a joint's axis that are below 0 by more than noise.
    fn possible(&self) -> Result<()> {
        let links = self.found.tree.links.iter().zip(&self.found.bodies);
        for ((link, (name, line)), joint) in links.zip(&self.found.joints) {
            let moment = about_axis(link);
            if moment < -NOISE_M2 * link.mass_kg {
                return Err(Error::data(
                    self.line(*line),
                    format!(
                        "the link {name}, with what is fixed to it, has a moment of inertia of \
                         {moment:.3e} kg m^2 about the axis of {}",
                        joint.name
                    ),
                    "mend the products of inertia: no body has a moment below 0",
                ));
            }
        }
        Ok(())
    }
}

/// How a joint moves its link by this much.
fn motion(joint: &TreeJoint, axis: &Unit<nalgebra::Vector3<f64>>, by: f64) -> Isometry3<f64> {
    if joint.motion == JointMotion::Slide {
        Isometry3::from(Translation3::from(axis.into_inner() * by))
    } else {
        Isometry3::from_parts(
            Translation3::identity(),
            UnitQuaternion::from_axis_angle(axis, by),
        )
    }
}
