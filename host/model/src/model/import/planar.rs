//! A planar chain out of a robot in space: the joints chosen, the rest held, all seen along the
//! joints' common axis.

use super::choice::{ancestors, in_one_row, longest, named};
use super::frame::{Frame, NotPlanar, wrapped};
use super::groups::ready_to_paste;
use super::remark::Remark;
use super::tree::{Fault, FaultyPart, Inertial, JointMotion, RobotTree, TreeJoint};
use crate::dynamics::SlideAxis;
use crate::error::{Error, Place, Result};
use nalgebra::Isometry3;
use std::f64::consts::{PI, TAU};

/// Shorter, a link has no direction, m.
const NO_LENGTH_M: f64 = 1e-12;

/// A link and the joint that carries it, in the plane.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct PlanarLink {
    pub joint: TreeJoint,
    /// Name and line of the body in the file.
    pub body: (String, usize),
    /// Whether the file's joint counts clockwise.
    pub reversed: bool,
    /// Relative angle here, the first from hanging, where the file's coordinate is 0, rad; of a
    /// slide, displacement, m.
    pub offset_rad: f64,
    /// Along what the joint slides; none of a hinge.
    pub slide: Option<SlideAxis>,
    pub length_m: f64,
    pub com_m: f64,
    pub com_angle_rad: f64,
    pub mass_kg: f64,
    /// About the centre of mass, kg m^2.
    pub inertia_kg_m2: f64,
}

/// The chain.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct PlanarChain {
    pub links: Vec<PlanarLink>,
    pub gravity_m_s2: f64,
    pub left_out: Vec<Remark>,
    pub notes: Vec<Remark>,
}

/// The chain of these joints, base to tip; without names that with most hinges.
///
/// # Errors
/// Joints that are not there, do not follow each other or do not turn about parallel axes; links
/// without mass.
pub(super) fn planar_chain(tree: &RobotTree, names: &[String], file: &str) -> Result<PlanarChain> {
    let mut left_out = Vec::new();
    let chosen = match names {
        [] => longest(tree, file, &mut left_out)?,
        names => named(tree, names, file)?,
    };
    let mut chain = chain_of(tree, &chosen, file).map_err(|refusal| refusal.told(tree, file))?;
    left_out.append(&mut chain.left_out);
    Ok(PlanarChain { left_out, ..chain })
}

/// The chain of all joints of a robot, where they make one.
pub(super) fn whole_chain(tree: &RobotTree, file: &str) -> Option<PlanarChain> {
    chain_of(tree, &in_one_row(tree)?, file).ok()
}

/// Why some joints make no chain.
pub(super) enum Refusal {
    /// What is wrong, and whether other joints may do.
    Chain(Error),
    /// Other joints may do.
    Joints(Option<Place>, String, &'static str),
}

impl Refusal {
    /// With the joints that would do.
    fn told(self, tree: &RobotTree, file: &str) -> Error {
        let (place, what, remedy) = match self {
            Refusal::Chain(error) => return error,
            Refusal::Joints(place, what, remedy) => (place, what, remedy),
        };
        let remedy = match ready_to_paste(tree, file) {
            Some(groups) => format!("{remedy}: {groups}"),
            None => format!("{remedy}; no joints of this robot do"),
        };
        match place {
            Some(place) => Error::data(place, what, remedy),
            None => Error::usage(format!("{file}: {what}"), remedy),
        }
    }
}

impl From<NotPlanar> for Refusal {
    fn from(NotPlanar(what): NotPlanar) -> Self {
        let remedy = "without --joints and --planar the whole robot is taken; a planar chain is of \
                      joints about parallel axes";
        Refusal::Joints(None, what, remedy)
    }
}

/// The fault of the file that such a chain meets: in its joints, in what they move, or in how
/// that which carries them is turned.
fn fault<'a>(tree: &'a RobotTree, chosen: &[usize], owner: &[Option<usize>]) -> Option<&'a Fault> {
    let carries = |body: usize| {
        chosen
            .first()
            .is_some_and(|&first| ancestors(tree, first).contains(&body))
    };
    tree.faults.iter().find(|fault| match fault.part {
        FaultyPart::Joint => chosen.contains(&fault.body),
        FaultyPart::Mass => owner[fault.body].is_some(),
        FaultyPart::Pose => owner[fault.body].is_some() || carries(fault.body),
    })
}

/// The link of the chain to which each body is fixed; none for the base.
fn owners(tree: &RobotTree, chosen: &[usize]) -> Vec<Option<usize>> {
    let mut owners: Vec<Option<usize>> = Vec::with_capacity(tree.bodies.len());
    for (index, body) in tree.bodies.iter().enumerate() {
        let own = chosen.iter().position(|&link| link == index);
        owners.push(own.or_else(|| body.parent.and_then(|parent| owners[parent])));
    }
    owners
}

/// The share of the moving bodies' weight that they feel; what bears one of them alone is told.
fn felt(tree: &RobotTree, owner: &[Option<usize>], left_out: &mut Vec<Remark>) -> f64 {
    let moving = tree.bodies.iter().zip(owner);
    let moving = moving.filter(|(body, owner)| owner.is_some() && body.inertial.mass_kg > 0.0);
    let moving: Vec<_> = moving.map(|(body, _)| body).collect();
    let borne = moving.first().map_or(0.0, |body| body.borne);
    if moving.iter().all(|body| body.borne == borne) {
        return 1.0 - borne;
    }
    for body in moving.iter().filter(|body| body.borne != 0.0) {
        let share = body.borne;
        let why =
            format!("{share} of its weight is borne, of others' is not: here all weigh in full");
        left_out.push(Remark::new("gravcomp", Some(&body.name), why).on(body.line));
    }
    1.0
}

/// The chain of these bodies' joints, base to tip.
pub(super) fn chain_of(
    tree: &RobotTree,
    chosen: &[usize],
    file: &str,
) -> Result<PlanarChain, Refusal> {
    let mut left_out = Vec::new();
    let owner = owners(tree, chosen);
    if let Some(fault) = fault(tree, chosen, &owner) {
        return Err(Refusal::Chain(fault.error()));
    }
    let poses = tree.world_poses();
    let gravity_m_s2 = tree.gravity_m_s2 * felt(tree, &owner, &mut left_out);
    let (frame, off) = Frame::of(tree, chosen, &poses, &gravity_m_s2)?;
    let mut notes: Vec<Remark> = off
        .map(|off| Remark::new("axes", None, off))
        .into_iter()
        .collect();
    for (body, _) in tree
        .bodies
        .iter()
        .zip(&owner)
        .filter(|(_, owner)| owner.is_some())
    {
        notes.extend(body.notes.iter().cloned());
    }
    held(tree, chosen, &mut left_out);
    let (base, masses) = masses(tree, chosen, &owner, &poses);
    if base.mass_kg > 0.0 {
        let still = base.mass_kg;
        let why = format!("{still} kg stand before the first joint, which does not move");
        left_out.push(Remark::new("base", None, why));
    }
    let mut links: Vec<PlanarLink> = Vec::new();
    let mut direction_rad = 0.0;
    for (index, &body) in chosen.iter().enumerate() {
        let joint = &tree.bodies[body].joints[0];
        let anchor = poses[body] * joint.anchor_m;
        let next = chosen
            .get(index + 1)
            .map(|&next| poses[next] * tree.bodies[next].joints[0].anchor_m);
        let mass = &masses[index];
        let inertia_kg_m2 = frame.axis.dot(&(mass.inertia_kg_m2 * frame.axis));
        with_mass(tree, body, mass, inertia_kg_m2, file)?;
        let com = frame.seen(&(mass.com_m - anchor));
        let along = next.map_or(com, |next| frame.seen(&(next - anchor)));
        let before_rad = direction_rad;
        if along.0 > NO_LENGTH_M {
            direction_rad = along.1;
        }
        let (com_m, com_angle_rad) = off_line(com, direction_rad);
        let axis = poses[body] * joint.axis;
        let slide = (joint.motion == JointMotion::Slide).then(|| SlideAxis {
            direction_rad: wrapped(frame.seen(&axis).1 - before_rad),
            link_rad: wrapped(direction_rad - before_rad),
        });
        let reversed = slide.is_none() && frame.axis.dot(&axis) < 0.0;
        let sign = if reversed { -1.0 } else { 1.0 };
        let turned_rad = match slide {
            Some(_) => 0.0,
            None => wrapped(direction_rad - before_rad),
        };
        let mut offset = turned_rad - sign * joint.reference_rad;
        if joint.stiffness_nm > 0.0 && slide.is_none() {
            // A spring tells whole turns apart: its rest lies within half a turn of zero.
            let rest = offset + sign * joint.spring_rest_rad;
            offset -= TAU * (rest / TAU).round();
        }
        links.push(PlanarLink {
            joint: joint.clone(),
            body: (tree.bodies[body].name.clone(), tree.bodies[body].line),
            reversed,
            offset_rad: offset,
            slide,
            length_m: if next.is_some() { along.0 } else { com.0 },
            com_m,
            com_angle_rad,
            mass_kg: mass.mass_kg,
            inertia_kg_m2: inertia_kg_m2.max(0.0),
        });
    }
    Ok(PlanarChain {
        links,
        gravity_m_s2: frame.gravity_m_s2,
        left_out,
        notes,
    })
}

/// A centre of mass at this distance, m, and angle, rad, along a link's line and off it: below 0 m
/// where it lies behind the joint.
fn off_line(com: (f64, f64), direction_rad: f64) -> (f64, f64) {
    let off_rad = if com.0 > NO_LENGTH_M {
        wrapped(com.1 - direction_rad)
    } else {
        0.0
    };
    match off_rad.abs() {
        off if (off - PI).abs() < 1e-12 => (-com.0, 0.0),
        off if off < 1e-12 => (com.0, 0.0),
        _ => (com.0, off_rad),
    }
}

/// Refuses a link that would move without mass, or whose moment about the axis is below zero.
fn with_mass(
    tree: &RobotTree,
    body: usize,
    mass: &Inertial,
    inertia_kg_m2: f64,
    file: &str,
) -> Result<(), Refusal> {
    let (own, joint) = (&tree.bodies[body], &tree.bodies[body].joints[0].name);
    let name = &own.name;
    let place = || Place {
        line: Some(own.line),
        ..Place::file(file)
    };
    if mass.mass_kg <= 0.0 {
        return Err(Refusal::Joints(
            Some(place()),
            format!(
                "the link {name}, which joint {joint} moves, has no mass, nor has anything that is \
                 fixed to it"
            ),
            "give it an <inertial>, or leave its joint out: it is held then, and the link is one \
             with that before; these joints move masses",
        ));
    }
    if inertia_kg_m2 < -1e-9 * mass.mass_kg {
        return Err(Refusal::Chain(Error::data(
            place(),
            format!(
                "the link {name}, with what is fixed to it, has a moment of inertia of \
                 {inertia_kg_m2:.3e} kg m^2 about the axis of {joint}"
            ),
            "mend the products of inertia: no body has a moment below 0",
        )));
    }
    Ok(())
}

/// Says which joints do not move.
fn held(tree: &RobotTree, chosen: &[usize], left_out: &mut Vec<Remark>) {
    for (index, body) in tree
        .bodies
        .iter()
        .enumerate()
        .filter(|(i, _)| !chosen.contains(i))
    {
        let before = ancestors(tree, index)
            .iter()
            .any(|body| chosen.contains(body));
        let why = if before {
            "held where the file has it, what it carries moves as one"
        } else {
            "held where the file has it: the base of the chain stands still"
        };
        let joints = body.joints.iter();
        left_out.extend(
            joints.map(|joint| Remark::new("joint", Some(&joint.name), why).on(joint.line)),
        );
    }
}

/// What each link carries, in the world: that of the base, then of the links.
fn masses(
    tree: &RobotTree,
    chosen: &[usize],
    owner: &[Option<usize>],
    poses: &[Isometry3<f64>],
) -> (Inertial, Vec<Inertial>) {
    let mut base = Inertial::NONE;
    let mut links = vec![Inertial::NONE; chosen.len()];
    for (index, body) in tree.bodies.iter().enumerate() {
        let part = body.inertial.seen_from(&poses[index]);
        match owner[index] {
            Some(link) => links[link] = links[link].with(&part),
            None => base = base.with(&part),
        }
    }
    (base, links)
}
