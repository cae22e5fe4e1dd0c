//! Which joints make the chain: those named, or the most hinges in a row.

use super::frame::PARALLEL_RAD;
use super::remark::Remark;
use super::tree::{JointMotion, RobotTree};
use crate::error::{Error, Result};

/// Whether a body has one joint, which moves so.
fn moves(tree: &RobotTree, body: usize, motion: JointMotion) -> bool {
    matches!(tree.bodies[body].joints.as_slice(), [joint] if joint.motion == motion)
}

/// Whether a body has one hinge.
pub(super) fn hinged(tree: &RobotTree, body: usize) -> bool {
    moves(tree, body, JointMotion::Hinge)
}

/// The branch with most hinges, and the slides in their plane.
pub(super) fn longest(
    tree: &RobotTree,
    file: &str,
    left_out: &mut Vec<Remark>,
) -> Result<Vec<usize>> {
    let mut hinges = vec![0usize; tree.bodies.len()];
    for (body, own) in tree.bodies.iter().enumerate() {
        let before = own.parent.map_or(0, |parent| hinges[parent]);
        hinges[body] = before + usize::from(hinged(tree, body));
    }
    let most = hinges.iter().copied().max().unwrap_or(0);
    if most == 0 {
        return sliding(tree, file, left_out);
    }
    let tips: Vec<usize> = (0..hinges.len())
        .filter(|&b| hinges[b] == most && hinged(tree, b))
        .collect();
    let Some(&tip) = tips.first().filter(|_| most > 0) else {
        return Err(Error::usage(
            format!("{file}: no joint turns about one axis"),
            "a chain needs hinges: revolute or continuous joints, <joint type=\"hinge\">",
        ));
    };
    if tips.len() > 1 {
        let name = &tree.bodies[tip].joints[0].name;
        let why = format!(
            "{} branches have {most} joints; the one that ends at {name} is taken, --joints names \
             another",
            tips.len()
        );
        left_out.push(Remark::new("branches", None, why));
    }
    let poses = tree.world_poses();
    let axis = |body: usize| poses[body] * tree.bodies[body].joints[0].axis;
    let hinge = axis(tip);
    // A slide across the plane of the hinges is held.
    let in_plane = |body: usize| {
        moves(tree, body, JointMotion::Slide) && axis(body).dot(&hinge).abs() < PARALLEL_RAD
    };
    let chain = ancestors(tree, tip)
        .into_iter()
        .filter(|&body| hinged(tree, body) || in_plane(body));
    Ok(chain.collect())
}

/// The chain of a robot without hinges: its first slide.
fn sliding(tree: &RobotTree, file: &str, left_out: &mut Vec<Remark>) -> Result<Vec<usize>> {
    let mut slides = (0..tree.bodies.len()).filter(|&body| moves(tree, body, JointMotion::Slide));
    let Some(first) = slides.next() else {
        let what = if tree.bodies.iter().any(|body| !body.joints.is_empty()) {
            "no joint turns or slides alone in its own body"
        } else {
            "no joint turns about one axis or slides along one"
        };
        return Err(Error::usage(
            format!("{file}: {what}"),
            "a chain needs hinges or slides, one for each body: revolute, continuous or prismatic \
             joints, <joint type=\"hinge\">",
        ));
    };
    if slides.next().is_some() {
        let name = &tree.bodies[first].joints[0].name;
        let why = format!("nothing turns; {name} alone is taken, --joints names others");
        left_out.push(Remark::new("slides", None, why));
    }
    Ok(vec![first])
}

/// All joints of a robot, base to tip, where each turns or slides alone behind the one before it
/// and follows no other; none of a tree.
pub(super) fn in_one_row(tree: &RobotTree) -> Option<Vec<usize>> {
    let carrying = |&body: &usize| !tree.bodies[body].joints.is_empty();
    let all: Vec<usize> = (0..tree.bodies.len()).filter(carrying).collect();
    let follows = tree.left_out.iter().any(|part| part.part == "mimic");
    let alone = |&body: &usize| hinged(tree, body) || moves(tree, body, JointMotion::Slide);
    let behind = |pair: &[usize]| ancestors(tree, pair[1]).contains(&pair[0]);
    (!all.is_empty() && !follows && all.iter().all(alone) && all.windows(2).all(behind))
        .then_some(all)
}

/// A body and those that carry it, the base first.
pub(super) fn ancestors(tree: &RobotTree, body: usize) -> Vec<usize> {
    let mut chain: Vec<usize> =
        std::iter::successors(Some(body), |&body| tree.bodies[body].parent).collect();
    chain.reverse();
    chain
}

/// Those named, from the base to the tip.
pub(super) fn named(tree: &RobotTree, names: &[String], file: &str) -> Result<Vec<usize>> {
    let mut chosen: Vec<usize> = Vec::new();
    for name in names {
        let has = |body: &usize| {
            tree.bodies[*body]
                .joints
                .iter()
                .any(|joint| joint.name == *name)
        };
        let Some(body) = (0..tree.bodies.len()).find(has) else {
            let all = tree.bodies.iter().flat_map(|body| &body.joints);
            let all: Vec<&str> = all.map(|joint| joint.name.as_str()).collect();
            let what = format!("{file}: there is no joint \"{name}\"");
            return Err(Error::usage(
                what,
                format!("its joints: {}", all.join(", ")),
            ));
        };
        if !hinged(tree, body) && !moves(tree, body, JointMotion::Slide) {
            return Err(Error::usage(
                format!("{file}: joint {name} neither turns nor slides alone in its own body"),
                "name hinges and slides, one for each body",
            ));
        }
        if chosen
            .last()
            .is_some_and(|before| *before == body || !ancestors(tree, body).contains(before))
        {
            return Err(Error::usage(
                format!("{file}: joint {name} does not lie behind the one named before it"),
                "name the joints from the base to the tip",
            ));
        }
        chosen.push(body);
    }
    Ok(chosen)
}
