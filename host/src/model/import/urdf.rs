//! URDF: links and joints by name, poses as `xyz` and `rpy`.

use super::tree::{Inertial, JointMotion, LeftOut, RobotTree, TreeBody, TreeDrive, TreeJoint};
use super::xml::Element;
use crate::error::Result;
use nalgebra::{Isometry3, Matrix3, Point3, Translation3, UnitQuaternion, Vector3};
use std::collections::HashMap;

/// URDF says nothing of gravity.
const GRAVITY_M_S2: f64 = 9.81;

/// The robot of a `<robot>` element.
///
/// # Errors
/// Names that are not there or stand twice, links in a ring, no single root, numbers that are none.
pub(super) fn tree(robot: Element) -> Result<RobotTree> {
    let mut left_out = Vec::new();
    if let Some(macros) = robot
        .elements()
        .find(|e| e.node.tag_name().namespace().is_some())
    {
        return Err(macros.wrong(
            "this file still holds xacro macros",
            "expand it first: xacro robot.urdf.xacro > robot.urdf",
        ));
    }
    let links: Vec<Element> = robot.all("link").collect();
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
        left_out.push(LeftOut::new(skipped.tag(), skipped.text("name"), why));
    }
    let order = order(robot, &carried)?;
    let place: HashMap<usize, usize> = order
        .iter()
        .enumerate()
        .map(|(at, link)| (*link, at))
        .collect();
    let mut bodies = Vec::new();
    for link in order {
        let mut body = TreeBody {
            name: links[link].required("name")?.to_string(),
            parent: None,
            pose: Isometry3::identity(),
            inertial: inertial(links[link])?,
            joints: Vec::new(),
        };
        if let Some((parent, joint)) = carried[link] {
            body.parent = place.get(&parent).copied();
            body.pose = pose(joint.first("origin"))?;
            body.joints.extend(tree_joint(joint, &mut left_out)?);
        }
        bodies.push(body);
    }
    Ok(RobotTree {
        name: robot.text("name").unwrap_or("robot").to_string(),
        bodies,
        gravity_m_s2: Vector3::new(0.0, 0.0, -GRAVITY_M_S2),
        left_out,
    })
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
    match order.len() == carried.len() {
        true => Ok(order),
        false => Err(robot.wrong(
            "links hang on each other in a ring",
            "mend parent and child",
        )),
    }
}

fn pose(origin: Option<Element>) -> Result<Isometry3<f64>> {
    let Some(origin) = origin else {
        return Ok(Isometry3::identity());
    };
    let xyz = origin.vector("xyz")?.unwrap_or_default();
    let rpy = origin.vector("rpy")?.unwrap_or_default();
    let turn = UnitQuaternion::from_euler_angles(rpy.x, rpy.y, rpy.z);
    Ok(Isometry3::from_parts(Translation3::from(xyz), turn))
}

fn inertial(link: Element) -> Result<Inertial> {
    let Some(found) = link.first("inertial") else {
        return Ok(Inertial::NONE);
    };
    let lacks =
        |tag: &str| found.wrong(format!("<inertial> lacks <{tag}>"), format!("add <{tag}>"));
    let mass = found.first("mass").ok_or_else(|| lacks("mass"))?;
    let mass_kg = mass.number("value")?.ok_or_else(|| lacks("mass value"))?;
    let moments = found.first("inertia").ok_or_else(|| lacks("inertia"))?;
    let of = |key: &str| -> Result<f64> { Ok(moments.number(key)?.unwrap_or(0.0)) };
    let (xy, xz, yz) = (of("ixy")?, of("ixz")?, of("iyz")?);
    let (xx, yy, zz) = (of("ixx")?, of("iyy")?, of("izz")?);
    if mass_kg < 0.0 || xx < 0.0 || yy < 0.0 || zz < 0.0 {
        return Err(found.wrong("a mass or a moment of inertia is below 0", "mend its sign"));
    }
    let own = Inertial {
        mass_kg,
        com_m: Point3::origin(),
        inertia_kg_m2: Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz),
    };
    Ok(own.seen_from(&pose(found.first("origin"))?))
}

fn tree_joint(joint: Element, left_out: &mut Vec<LeftOut>) -> Result<Option<TreeJoint>> {
    let name = joint.required("name")?;
    let motion = match joint.required("type")? {
        "fixed" => return Ok(None),
        "revolute" | "continuous" => JointMotion::Hinge,
        "prismatic" => JointMotion::Slide,
        "floating" | "planar" => JointMotion::Free,
        other => {
            let remedy = "revolute, continuous, prismatic, fixed, floating or planar";
            return Err(joint.wrong(format!("a joint of type \"{other}\""), remedy));
        }
    };
    let axis = joint
        .first("axis")
        .map(|axis| axis.vector("xyz"))
        .transpose()?
        .flatten();
    let axis = axis.unwrap_or(Vector3::x());
    if axis.norm() < 1e-9 {
        return Err(joint.wrong("an axis of length 0", "give the axis a direction"));
    }
    let mut made = TreeJoint::new(name.to_string(), motion, axis.normalize());
    if let Some(dynamics) = joint.first("dynamics") {
        made.damping_nm_s = dynamics.number("damping")?.unwrap_or(0.0);
        made.friction_nm = dynamics.number("friction")?.unwrap_or(0.0);
    }
    if let Some(limit) = joint.first("limit") {
        let range = (limit.number("lower")?, limit.number("upper")?);
        made.range_rad = ["revolute", "prismatic"]
            .contains(&joint.required("type")?)
            .then_some((range.0.unwrap_or(0.0), range.1.unwrap_or(0.0)));
        made.speed_rad_s = limit.number("velocity")?.filter(|speed| *speed > 0.0);
        let effort = limit.number("effort")?.filter(|effort| *effort > 0.0);
        made.drive = effort.map_or(TreeDrive::None, |effort| TreeDrive::Torque(Some(effort)));
    }
    if joint.first("mimic").is_some() {
        let why = "a joint here follows no other: it moves freely or is held";
        left_out.push(LeftOut::new("mimic", Some(name), why));
    }
    if joint.first("safety_controller").is_some() {
        left_out.push(LeftOut::new(
            "safety_controller",
            Some(name),
            "a controller is no part of a model",
        ));
    }
    Ok(Some(made))
}
