//! A robot in space, as a URDF or MJCF file describes it, and the values that a model changes in
//! it.

use super::import::{Locked, robot_in_space};
use super::limits::Limits;
use super::reader::Table;
use super::{Link, Model};
use crate::dynamics::{SpatialLink, SpatialTree};
use crate::error::{Error, Result};
use nalgebra::Vector3;
use sha2::{Digest, Sha256};
use std::path::Path;

/// Where a joint may be held, rad or m.
const HELD: Limits = Limits::within(-1e3, 1e3);

/// A robot's file.
#[derive(Debug, Clone, PartialEq)]
pub struct Robot {
    /// As the model's file names it, relative to itself.
    pub file: String,
    /// Joints that are held, and where, rad or m.
    pub locked: Vec<Locked>,
    /// All links that move, the values as in the robot's file.
    pub tree: SpatialTree,
    /// What the file calls each joint.
    pub joints: Vec<String>,
    /// What it calls the link behind each joint.
    pub links: Vec<String>,
    /// Between which coordinates its end stops let each joint move, rad or m, where the file says
    /// both. Nothing here stops at them.
    pub ranges: Vec<Option<(f64, f64)>>,
}

impl Robot {
    /// What `[rig] robot` names, if it names anything; `model` is the model's file, `given` the
    /// robot's text where it is not to be read from there.
    ///
    /// # Errors
    /// A file that cannot be read, is no robot, or is another than the one noted.
    pub(super) fn read(rig: &Table, model: &Path, given: Option<&str>) -> Result<Option<Robot>> {
        let Some(file) = rig.text("robot")? else {
            return Ok(None);
        };
        let path = model.parent().unwrap_or(Path::new("")).join(file);
        let text = given.map_or_else(|| std::fs::read_to_string(&path), |text| Ok(text.into()));
        let text = text.map_err(|source| {
            rig.bad(
                "robot",
                format!("cannot read the robot's file {}: {source}", path.display()),
                "name a URDF or MJCF file, relative to the model's",
            )
        })?;
        if let Some(noted) = rig.text("robot_sha256")? {
            let found = fingerprint(&text);
            if found != noted {
                return Err(rig.bad(
                    "robot_sha256",
                    format!(
                        "the robot's file is another than the one noted: its SHA-256 is {found}"
                    ),
                    "look what changed; if the model's values still hold, note the new one",
                ));
            }
        }
        let mut locked = Vec::new();
        if let Some(table) = rig.table("locked")? {
            for name in table.keys() {
                locked.push((name.to_string(), table.required_number(name, HELD)?));
            }
        }
        let found = Robot::parse(&text, &path, &locked).map_err(|error| match error {
            Error::Usage(problem) => problem.at(rig.place_of("robot")),
            error => error,
        })?;
        Ok(Some(Robot {
            file: file.to_string(),
            ..found
        }))
    }

    /// A robot from the text of a URDF or MJCF file, which `path` only names; `locked` holds joints
    /// where it says.
    ///
    /// # Errors
    /// A text that is no robot, a joint to hold that is not there, and links that would move
    /// without mass.
    pub fn parse(text: &str, path: &Path, locked: &[Locked]) -> Result<Robot> {
        let found = robot_in_space(text, path, locked)?;
        Ok(Robot {
            file: path.display().to_string(),
            locked: locked.to_vec(),
            tree: found.tree,
            joints: found.joints,
            links: found.links,
            ranges: found.ranges,
        })
    }

    /// A link's values in the robot's file, as a model has them.
    pub fn link(&self, index: usize) -> Link {
        link_values(&self.tree, index)
    }
}

/// A link's values as a model has them.
pub(super) fn link_values(tree: &SpatialTree, index: usize) -> Link {
    let link = &tree.links[index];
    let next = (tree.links.iter()).find(|next| next.parent == Some(index));
    let com_m = link.com_m.norm();
    Link {
        length_m: next.map_or(com_m, |next| next.place.translation.vector.norm()),
        com_m,
        mass_kg: link.mass_kg,
        // Noise below 0 is none, and stays out of proportions.
        inertia_kg_m2: about_axis(link).max(0.0),
    }
}

/// Moment of inertia about a line through the centre of mass along the joint's axis, kg m^2.
pub(super) fn about_axis(link: &SpatialLink) -> f64 {
    let axis = link.axis.into_inner();
    axis.dot(&(link.inertia_kg_m2 * axis))
}

/// SHA-256 of a robot's file, in hexadecimal digits.
pub(super) fn fingerprint(text: &str) -> String {
    Sha256::digest(text)
        .iter()
        .map(|byte| format!("{byte:02x}"))
        .collect()
}

impl Model {
    /// The tree of a robot in space with this model's own values: a mass in place of the file's,
    /// the centre of mass so far from the joint's frame in the file's direction, and moments of
    /// inertia in the file's proportions, so that they stay those of a body. None of a planar
    /// chain.
    pub fn tree(&self) -> Option<SpatialTree> {
        let robot = self.robot.as_ref()?;
        let mut tree = robot.tree.clone();
        // Down is what the file says, or -z where it has no gravity.
        let down = tree
            .gravity_m_s2
            .try_normalize(0.0)
            .unwrap_or(-Vector3::z());
        tree.gravity_m_s2 = down * self.gravity_m_s2;
        for (index, (link, own)) in tree.links.iter_mut().zip(&self.links).enumerate() {
            let file = robot.link(index);
            link.mass_kg = own.mass_kg;
            link.com_m *= share(own.com_m, file.com_m);
            link.inertia_kg_m2 *= share(own.inertia_kg_m2, file.inertia_kg_m2);
        }
        Some(tree)
    }

    /// Whether it is a robot in space, not a planar chain.
    pub fn is_in_space(&self) -> bool {
        self.robot.is_some()
    }

    /// Refuses a robot in space; `why` reads on from "is a robot in space, and".
    ///
    /// # Errors
    /// A robot in space.
    pub fn planar_only(&self, why: &str) -> Result<()> {
        match &self.robot {
            None => Ok(()),
            Some(robot) => Err(Error::design(
                format!("`{}` is a robot in space, and {why}", self.name),
                format!(
                    "give a planar chain: `handstand import {} --joints` makes one of joints whose \
                     axes are parallel",
                    robot.file
                ),
            )),
        }
    }

    /// Between which coordinates a joint's end stops let it move, rad or m; none where its robot's
    /// file has no such range, and of a planar chain.
    pub fn range(&self, joint: usize) -> Option<(f64, f64)> {
        *self.robot.as_ref()?.ranges.get(joint)?
    }

    /// The mass that moves with a joint, kg.
    pub fn carried_kg(&self, joint: usize) -> f64 {
        let Some(robot) = &self.robot else {
            return self.links[joint..].iter().map(|link| link.mass_kg).sum();
        };
        let mut moves = vec![false; self.links.len()];
        let mut carried_kg = 0.0;
        for (index, link) in robot.tree.links.iter().enumerate() {
            moves[index] = index == joint || link.parent.is_some_and(|parent| moves[parent]);
            if moves[index] {
                carried_kg += self.links[index].mass_kg;
            }
        }
        carried_kg
    }

    /// The joint that a robot in space calls so, counted from 0.
    pub fn joint_named(&self, name: &str) -> Option<usize> {
        let robot = self.robot.as_ref()?;
        robot.joints.iter().position(|own| own == name)
    }

    /// What messages call a joint beside its number: the name in the robot's file, if there is one.
    pub fn joint_name(&self, joint: usize) -> Option<&str> {
        let robot = self.robot.as_ref()?;
        robot.joints.get(joint).map(String::as_str)
    }
}

fn share(own: f64, file: f64) -> f64 {
    if file == 0.0 { 1.0 } else { own / file }
}
