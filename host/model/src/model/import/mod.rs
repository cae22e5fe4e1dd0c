//! Models out of other simulators' files: URDF and MJCF.
//!
//! A robot becomes the planar chain of some of its joints, or a robot in space ([`import`]); whole,
//! it becomes what its joints make ([`import_whole`]). What a model does not have is listed with
//! the reason, never left out silently.

mod choice;
mod frame;
mod groups;
mod inertia;
mod log_plan;
pub(super) mod mjcf;
mod planar;
pub(super) mod prefixes;
mod remark;
mod servo;
mod solid;
pub(super) mod space;
#[cfg(test)]
mod tests;
pub(super) mod tree;
pub(super) mod urdf;
mod write;
pub(super) mod xml;

pub use log_plan::{JointPlan, LogPlan, MovingJoint, import_for_log, moving_joints};
pub use remark::{Remark, told};
pub use servo::ServoFigures;
pub use solid::Solid;
pub use space::Locked;

use crate::dynamics::SpatialTree;
use crate::error::{Error, Result};
use crate::model::robot::fingerprint;
use groups::ready_to_paste;
use planar::{PlanarChain, planar_chain, whole_chain};
use prefixes::declared;
use servo::all_driven;
use space::{InSpace, in_space};
use std::path::Path;
use tree::{RobotTree, TreeDrive};
use write::RobotName;
use xml::{Element, XmlFile};

/// Most bodies of a robot.
const MOST_BODIES: usize = 10_000;

/// What to take of a robot.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct ImportPlan {
    /// Joints from the base to the tip; without names the most hinges in a row.
    pub joints: Vec<String>,
    /// What drives the joints.
    pub drives: JointDrives,
    /// A robot in space: all of its joints, but those that are held.
    pub space: Option<SpacePlan>,
}

/// What drives the joints of a robot.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum JointDrives {
    /// What the file says: what it does not drive is passive.
    #[default]
    OfFile,
    /// The same, and a torque what the file does not drive.
    OrTorque,
    /// `torque`, `duty`, `position` or `speed`, whatever the file says: a joint that has another
    /// drive there gets a servo whose figures are guesses.
    All(&'static str),
}

/// How a robot in space is taken.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct SpacePlan {
    /// What the model file names the robot's, relative to itself.
    pub robot: String,
    /// Joints that are held, and where, rad or m.
    pub locked: Vec<Locked>,
}

/// A model made of another simulator's file.
#[derive(Debug, Clone, PartialEq)]
pub struct Imported {
    /// `urdf` or `mjcf`.
    pub format: &'static str,
    /// The model file.
    pub toml: String,
    /// The joints, from the base to the tip.
    pub joints: Vec<String>,
    /// Whether it is a robot in space, and not a planar chain.
    pub in_space: bool,
    /// What of the file the model does not hold.
    pub left_out: Vec<Remark>,
    /// What the model holds, and what is to be known of it: rounded axes, impossible moments.
    pub notes: Vec<Remark>,
}

/// The model of a URDF or MJCF text; `path` only names it.
///
/// Forward dynamics are those of the file for motions of the chosen joints: masses, moments of
/// inertia, armature, damping, springs. Other joints are held where the file describes them. What
/// changes forces and is not carried is listed; what is not carried refuses nothing.
///
/// # Errors
/// Broken XML and what the formats' readers refuse, with line and column; joints that make no
/// planar chain.
pub fn import(text: &str, path: &Path, plan: &ImportPlan) -> Result<Imported> {
    let (format, tree) = robot(text, path, plan.drives)?;
    let name = path.display().to_string();
    if let Some(space) = &plan.space {
        let mut found = in_space(&tree, &space.locked, &name)?;
        let guessed = all_driven(plan.drives, &mut found.joints, &mut found.notes);
        let parts = ImportedParts {
            format,
            text,
            tree: &tree,
        };
        return Ok(parts.in_space(found, space, None, &guessed));
    }
    let chain = planar_chain(&tree, &plan.joints, &name)?;
    in_plane(&tree, chain, plan.drives, format, path)
}

/// The model of a whole robot: the planar chain of its joints where they make one and none is
/// held, else the robot in space; `path` only names the file.
///
/// # Errors
/// As [`import`], but for joints that make no planar chain.
pub fn import_whole(
    text: &str,
    path: &Path,
    drives: JointDrives,
    space: &SpacePlan,
) -> Result<Imported> {
    let (format, tree) = robot(text, path, drives)?;
    let name = path.display().to_string();
    if space.locked.is_empty()
        && let Some(chain) = whole_chain(&tree, &name)
    {
        return in_plane(&tree, chain, drives, format, path);
    }
    let mut found = in_space(&tree, &space.locked, &name)?;
    if let Some(chains) = ready_to_paste(&tree, &name) {
        let why = format!("in space, with all that moves; {chains} takes a planar chain");
        found.notes.insert(0, Remark::new("robot", None, why));
    }
    let guessed = all_driven(drives, &mut found.joints, &mut found.notes);
    let parts = ImportedParts {
        format,
        text,
        tree: &tree,
    };
    Ok(parts.in_space(found, space, None, &guessed))
}

/// The model of a planar chain.
fn in_plane(
    tree: &RobotTree,
    mut chain: PlanarChain,
    drives: JointDrives,
    format: &'static str,
    path: &Path,
) -> Result<Imported> {
    let joints = chain.links.iter_mut().map(|link| &mut link.joint);
    let guessed = all_driven(drives, joints, &mut chain.notes);
    let mut left_out = tree.left_out.clone();
    left_out.extend(chain.left_out.iter().cloned());
    let toml = write::toml(
        &tree.name,
        &mut chain,
        format,
        path,
        &guessed,
        &mut left_out,
    )?;
    let joints = chain.links.into_iter().map(|link| link.joint.name);
    Ok(Imported {
        format,
        toml,
        joints: joints.collect(),
        in_space: false,
        left_out,
        notes: chain.notes,
    })
}

/// A robot's file as it was read.
struct ImportedParts<'a> {
    format: &'static str,
    text: &'a str,
    tree: &'a RobotTree,
}

impl ImportedParts<'_> {
    /// The model of the robot in space; with a log's plan its `[log]` is that one's. Its `[fit]` is
    /// of the values at these addresses, which are guesses.
    fn in_space(
        &self,
        mut found: InSpace,
        space: &SpacePlan,
        log: Option<&LogPlan>,
        guessed: &[String],
    ) -> Imported {
        found
            .left_out
            .splice(0..0, self.tree.left_out.iter().cloned());
        let named = RobotName {
            file: &space.robot,
            sha256: &fingerprint(self.text),
            locked: &space.locked,
        };
        let name = log.and_then(|plan| plan.name.as_ref());
        let name = name.unwrap_or(&self.tree.name);
        let toml = write::toml_in_space(name, &mut found, self.format, &named, log, guessed);
        let joints = found.joints.into_iter().map(|joint| joint.name);
        Imported {
            format: self.format,
            toml,
            joints: joints.collect(),
            in_space: true,
            left_out: found.left_out,
            notes: found.notes,
        }
    }
}

/// What a file describes, and its format; joints that nothing drives are given a torque where that
/// is asked for.
fn robot(text: &str, path: &Path, drives: JointDrives) -> Result<(&'static str, RobotTree)> {
    let text = declared(text);
    let (format, mut tree) = tree_of(XmlFile::parse(path, &text)?.root())?;
    if tree.bodies.len() > MOST_BODIES {
        let what = format!("{}: {} bodies", path.display(), tree.bodies.len());
        return Err(Error::usage(
            what,
            format!("at most {MOST_BODIES} are read"),
        ));
    }
    if drives == JointDrives::OrTorque {
        for joint in tree.bodies.iter_mut().flat_map(|body| &mut body.joints) {
            if joint.drive == TreeDrive::None {
                joint.drive = TreeDrive::Torque(joint.most_nm);
                joint.limited_by = ("actuatorfrcrange", joint.line);
            }
        }
    }
    Ok((format, tree))
}

/// The robot of a file's root, and the file's format.
///
/// # Errors
/// What the formats' readers refuse.
pub(super) fn tree_of(root: Element) -> Result<(&'static str, RobotTree)> {
    match root.tag() {
        "robot" => Ok(("urdf", urdf::tree(root)?)),
        "mujoco" => Ok(("mjcf", mjcf::tree(root)?)),
        other => {
            let what = format!("<{other}> is no robot's root");
            Err(root.wrong(what, "URDF begins with <robot>, MJCF with <mujoco>"))
        }
    }
}

/// A robot in space, what its file calls joints and links, and the joints' ranges.
pub(super) struct RobotInSpace {
    pub tree: SpatialTree,
    pub joints: Vec<String>,
    pub links: Vec<String>,
    pub ranges: Vec<Option<(f64, f64)>>,
}

/// A robot's text as a tree in space.
///
/// # Errors
/// As [`import`], but for joints that make no planar chain.
pub(super) fn robot_in_space(text: &str, path: &Path, locked: &[Locked]) -> Result<RobotInSpace> {
    let (_, tree) = robot(text, path, JointDrives::OfFile)?;
    let found = in_space(&tree, locked, &path.display().to_string())?;
    Ok(RobotInSpace {
        tree: found.tree,
        ranges: found.joints.iter().map(|joint| joint.range_rad).collect(),
        joints: found.joints.into_iter().map(|joint| joint.name).collect(),
        links: found.bodies.into_iter().map(|(name, _)| name).collect(),
    })
}
