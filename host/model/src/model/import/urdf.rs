//! URDF: links and joints by name, poses as `xyz` and `rpy`.

use super::inertia::checked;
use super::remark::Remark;
use super::tree::{
    Fault, FaultyPart, Inertial, JointMotion, RobotTree, TreeBody, TreeDrive, TreeJoint,
};
use super::xml::Element;
use crate::error::{Error, Result};
use nalgebra::{Isometry3, Matrix3, Point3, Translation3, UnitQuaternion, Vector3};
use roxmltree::Node;
use std::collections::HashMap;

/// URDF says nothing of gravity.
const GRAVITY_M_S2: f64 = 9.81;
/// What makes a URDF of a file with macros.
pub(super) const EXPAND: &str = "expand it first: xacro robot.urdf.xacro > robot.urdf";
/// In the address of every namespace of xacro.
const XACRO: &str = "xacro";
/// Elements of a joint that are read, or say nothing of forces.
const OF_JOINT: [&str; 9] = [
    "parent",
    "child",
    "origin",
    "axis",
    "dynamics",
    "limit",
    "mimic",
    "safety_controller",
    "calibration",
];

/// The robot of a `<robot>` element.
///
/// # Errors
/// Names that are not there or stand twice, links in a ring, no single root, numbers that are none.
pub(super) fn tree(robot: Element) -> Result<RobotTree> {
    let mut left_out = Vec::new();
    no_macros(robot)?;
    let links: Vec<Element> = robot.all("link").collect();
    if links.is_empty() {
        return Err(robot.wrong(
            "the robot has no <link>",
            "give the file of the whole robot",
        ));
    }
    let mut index_of = HashMap::new();
    for (index, link) in links.iter().enumerate() {
        if index_of.insert(link.required("name")?, index).is_some() {
            return Err(link.wrong("a second link of this name", "give each link its own name"));
        }
    }
    let carried = carried(robot, &index_of)?;
    for skipped in robot
        .elements()
        .filter(|e| !["link", "joint", "material"].contains(&e.tag()))
    {
        let why = "no part of a chain of links";
        left_out.push(Remark::new(skipped.tag(), skipped.text("name"), why).on(skipped.line()));
    }
    for vendors in robot.foreign() {
        let why = "an element of a vendor's own";
        let remark = Remark::new(vendors.tag(), vendors.text("name"), why);
        left_out.push(remark.on(vendors.line()));
    }
    let order = order(robot, &carried)?;
    let place: HashMap<usize, usize> = order
        .iter()
        .enumerate()
        .map(|(at, link)| (*link, at))
        .collect();
    let (mut bodies, mut faults) = (Vec::new(), Vec::new());
    for link in order {
        let index = bodies.len();
        let mut fault = |part, error: &Error| faults.push(Fault::new(index, part, error));
        let mut body = TreeBody {
            name: links[link].required("name")?.to_string(),
            line: links[link].line(),
            at: links[link].at(),
            parent: None,
            pose: Isometry3::identity(),
            inertial: Inertial::NONE,
            joints: Vec::new(),
            borne: 0.0,
            notes: Vec::new(),
        };
        match inertial(links[link]) {
            Ok((inertial, impossible)) => {
                body.inertial = inertial;
                let note = |why| Remark::new("inertia", Some(&body.name), why).on(body.line);
                body.notes.extend(impossible.map(note));
            }
            Err(error) => fault(FaultyPart::Mass, &error),
        }
        if let Some((parent, joint)) = carried[link] {
            body.parent = place.get(&parent).copied();
            match pose(joint.first("origin")) {
                Ok(pose) => body.pose = pose,
                Err(error) => fault(FaultyPart::Pose, &error),
            }
            if let Some((mut made, kind)) = new_joint(joint, &mut left_out)? {
                if let Err(error) = read_joint(joint, kind, &mut made) {
                    fault(FaultyPart::Joint, &error);
                }
                body.joints.push(made);
            }
        }
        bodies.push(body);
    }
    Ok(RobotTree {
        name: robot.text("name").unwrap_or("robot").to_string(),
        bodies,
        gravity_m_s2: Vector3::new(0.0, 0.0, -GRAVITY_M_S2),
        left_out,
        faults,
    })
}

/// Refuses a file that xacro has not expanded: an element of its namespace, wherever it is.
fn no_macros(robot: Element) -> Result<()> {
    let is_macro = |node: &Node| {
        let namespace = node.tag_name().namespace();
        namespace.is_some_and(|address| address.contains(XACRO))
    };
    match robot.node.descendants().find(is_macro) {
        None => Ok(()),
        Some(node) => {
            let found = Element { node, ..robot };
            let what = format!("<xacro:{}>: this file still holds macros", found.tag());
            Err(found.wrong(what, EXPAND))
        }
    }
}

/// Of each link: the link and the joint that carry it.
fn carried<'a>(
    robot: Element<'a>,
    index_of: &HashMap<&str, usize>,
) -> Result<Vec<Option<(usize, Element<'a>)>>> {
    let mut carried = vec![None; index_of.len()];
    let mut seen = HashMap::new();
    for joint in robot.all("joint") {
        if seen.insert(joint.required("name")?, ()).is_some() {
            return Err(joint.wrong(
                "a second joint of this name",
                "give each joint its own name",
            ));
        }
        let end = |tag: &'static str| {
            let lacks = || joint.wrong(format!("the joint lacks <{tag}>"), "name both its links");
            let name = joint.first(tag).ok_or_else(lacks)?.required("link")?;
            let unknown = || joint.wrong(format!("there is no link \"{name}\""), "mend the name");
            index_of.get(name).copied().ok_or_else(unknown)
        };
        let (parent, child) = (end("parent")?, end("child")?);
        if carried[child].replace((parent, joint)).is_some() {
            return Err(joint.wrong("its child has a second joint", "a link hangs on one joint"));
        }
    }
    Ok(carried)
}

/// Links, each behind the one that carries it.
fn order(robot: Element, carried: &[Option<(usize, Element)>]) -> Result<Vec<usize>> {
    let roots: Vec<usize> = (0..carried.len())
        .filter(|&link| carried[link].is_none())
        .collect();
    if roots.len() != 1 {
        let found = roots.len();
        let remedy = "one link carries all others, and no chain of joints ends where it begins";
        return Err(robot.wrong(format!("{found} links hang on no joint"), remedy));
    }
    let mut children: Vec<Vec<usize>> = vec![Vec::new(); carried.len()];
    for (link, joint) in carried.iter().enumerate() {
        if let Some((parent, _)) = joint {
            children[*parent].push(link);
        }
    }
    let mut order = roots;
    let mut next = 0;
    while let Some(&link) = order.get(next) {
        order.extend(&children[link]);
        next += 1;
    }
    if order.len() == carried.len() {
        Ok(order)
    } else {
        Err(robot.wrong(
            "links hang on each other in a ring",
            "mend parent and child",
        ))
    }
}

/// A pose; none is that of its parent.
///
/// # Errors
/// Numbers that are none.
pub(in crate::model) fn pose(origin: Option<Element>) -> Result<Isometry3<f64>> {
    let Some(origin) = origin else {
        return Ok(Isometry3::identity());
    };
    let xyz = origin.vector("xyz")?.unwrap_or_default();
    let rpy = origin.vector("rpy")?.unwrap_or_default();
    let turn = UnitQuaternion::from_euler_angles(rpy.x, rpy.y, rpy.z);
    Ok(Isometry3::from_parts(Translation3::from(xyz), turn))
}

/// Mass and moments of a link, and what no body's can be.
fn inertial(link: Element) -> Result<(Inertial, Option<String>)> {
    let Some(found) = link.first("inertial") else {
        return Ok((Inertial::NONE, None));
    };
    let lacks =
        |tag: &str| found.wrong(format!("<inertial> lacks <{tag}>"), format!("add <{tag}>"));
    let mass = found.first("mass").ok_or_else(|| lacks("mass"))?;
    let mass_kg = mass.number("value")?.ok_or_else(|| lacks("mass value"))?;
    let moments = found.first("inertia").ok_or_else(|| lacks("inertia"))?;
    let of = |key: &str| -> Result<f64> { Ok(moments.number(key)?.unwrap_or(0.0)) };
    let (xy, xz, yz) = (of("ixy")?, of("ixz")?, of("iyz")?);
    let (xx, yy, zz) = (of("ixx")?, of("iyy")?, of("izz")?);
    let written = Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz);
    let (inertia_kg_m2, impossible) = checked(moments, mass_kg, written)?;
    let own = Inertial {
        mass_kg,
        com_m: Point3::origin(),
        inertia_kg_m2,
    };
    let inertial = own.seen_from(&pose(found.first("origin"))?);
    Ok((inertial, impossible))
}

/// A joint by name and kind; none where it is fixed.
fn new_joint<'a>(
    joint: Element<'a>,
    left_out: &mut Vec<Remark>,
) -> Result<Option<(TreeJoint, &'a str)>> {
    let (name, kind) = (joint.required("name")?, joint.required("type")?);
    let motion = match kind {
        "fixed" => return Ok(None),
        "revolute" | "continuous" => JointMotion::Hinge,
        "prismatic" => JointMotion::Slide,
        "floating" | "planar" => JointMotion::Free,
        other => {
            let remedy = "revolute, continuous, prismatic, fixed, floating or planar";
            return Err(joint.wrong(format!("a joint of type \"{other}\""), remedy));
        }
    };
    if let Some(mimic) = joint.first("mimic") {
        let why = "a joint here follows no other: it moves freely or is held";
        left_out.push(Remark::new("mimic", Some(name), why).on(mimic.line()));
    }
    let made = TreeJoint {
        at: joint.at(),
        ..TreeJoint::new(name.to_string(), joint.line(), motion, Vector3::x())
    };
    Ok(Some((made, kind)))
}

/// What a joint's elements say of it.
fn read_joint(joint: Element, kind: &str, made: &mut TreeJoint) -> Result<()> {
    let axis = joint.first("axis").map(|axis| axis.vector("xyz"));
    let axis = axis.transpose()?.flatten().unwrap_or(Vector3::x());
    if axis.norm() < 1e-9 && made.motion != JointMotion::Free {
        return Err(joint.wrong("an axis of length 0", "give the axis a direction"));
    }
    made.axis = axis.try_normalize(1e-9).unwrap_or(Vector3::x());
    if let Some(dynamics) = joint.first("dynamics") {
        made.damping_nm_s = dynamics.number("damping")?.unwrap_or(0.0);
        made.friction_nm = dynamics.number("friction")?.unwrap_or(0.0);
        let known = ["damping", "friction"];
        for key in dynamics.others(&known) {
            made.leave(key, dynamics.line(), "an attribute that is not read");
        }
    }
    if let Some(limit) = joint.first("limit") {
        let has = |key: &str| limit.text(key).is_some();
        if ["revolute", "prismatic"].contains(&kind) && (has("lower") || has("upper")) {
            made.leave("range", limit.line(), "links here have no end stops");
            // Not carried either: a range that cannot be read is as good as none.
            let end = |key: &str| limit.text(key)?.trim().parse::<f64>().ok();
            made.range_rad = end("lower")
                .zip(end("upper"))
                .filter(|(low, high)| low < high);
        }
        // Not carried, so whatever stands there is no reason to refuse.
        let velocity = limit
            .text("velocity")
            .map(|text| text.trim().parse::<f64>());
        if velocity.is_some_and(|found| !found.is_ok_and(|speed| speed <= 0.0 || speed > 1e9)) {
            let why = "no drive here stops at a speed of its own; see speed_limit";
            made.leave("velocity limit", limit.line(), why);
        }
        made.limited_by = ("effort", limit.line());
        made.drive = match (limit.limit("effort")?, has("effort")) {
            (Some(effort), _) if effort > 0.0 => TreeDrive::Torque(Some(effort)),
            (Some(_), _) | (None, false) => TreeDrive::None,
            // So large that it is none.
            (None, true) => TreeDrive::Torque(None),
        };
    }
    if let Some(safety) = joint.first("safety_controller") {
        let why = "a controller is no part of a model";
        made.leave("safety_controller", safety.line(), why);
    }
    let unknown = joint
        .elements()
        .filter(|own| !OF_JOINT.contains(&own.tag()));
    for unknown in unknown.chain(joint.foreign()) {
        made.leave(unknown.tag(), unknown.line(), "an element that is not read");
    }
    Ok(())
}
