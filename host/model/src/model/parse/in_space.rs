//! Links and joints of a robot in space: its file has their shape, the model their values.

use super::super::field::LinkField;
use super::super::reader::Table;
use super::super::{Joint, Link, Model, RateSensor, Robot};
use super::{EITHER_SIGN, NOT_NEGATIVE, drive};
use crate::dynamics::{SlideAxis, SpatialEquations};
use crate::effects::Axis;
use crate::error::Result;

/// The links: what no `[[link]]` says is as in the robot's file.
pub(super) fn links(root: &Table, robot: &Robot) -> Result<Vec<Link>> {
    let tables = named(root, "link", &robot.links, true)?;
    let links = (0..robot.links.len()).map(|index| {
        let file = robot.link(index);
        let Some(table) = tables.get(index) else {
            return Ok(file);
        };
        table.only(&["name", "mass_kg", "com_m", "inertia_kg_m2"])?;
        let number = |field: LinkField, limits, file: f64| -> Result<f64> {
            Ok(table.number(field.key(), limits)?.unwrap_or(file))
        };
        Ok(Link {
            length_m: file.length_m,
            com_m: number(LinkField::Com, EITHER_SIGN, file.com_m)?,
            mass_kg: number(LinkField::Mass, NOT_NEGATIVE, file.mass_kg)?,
            inertia_kg_m2: number(LinkField::Inertia, NOT_NEGATIVE, file.inertia_kg_m2)?,
        })
    });
    links.collect()
}

/// The joints: the robot's file says how they move, the model what drives them.
pub(super) fn joints(root: &Table, robot: &Robot) -> Result<Vec<Joint>> {
    let tables = named(root, "joint", &robot.joints, false)?;
    let joints = tables.iter().zip(&robot.tree.links).map(|(table, link)| {
        let axis = if link.slides {
            Axis::Slide
        } else {
            Axis::Hinge
        };
        Ok(Joint {
            drive: drive(table, axis, &["name"])?,
            // Its direction is the robot's file's.
            slide: link.slides.then_some(SlideAxis {
                direction_rad: 0.0,
                link_rad: 0.0,
            }),
        })
    });
    joints.collect()
}

/// Runge-Kutta of fourth order grows where a speed decays in less than the step's 2.8th part.
const STIFF: f64 = 2.5;

/// Refuses what no robot in space can have: a rate that is the sum of joints about parallel axes,
/// and a motor that brakes faster than a step can follow.
pub(super) fn check(root: &Table, model: &Model) -> Result<()> {
    if !model.is_in_space() {
        return Ok(());
    }
    let log = root.required_table("log")?;
    for (table, joint) in log.tables("joint")?.iter().zip(&model.log.joints) {
        if joint.rate.is_some() && joint.rate_sensor == RateSensor::Gyro {
            return Err(table.bad_key(
                "gyro",
                "a gyro feels joints whose axes are parallel, and this is a robot in space",
                "remove `gyro`; a joint's own rate is a `tachometer`",
            ));
        }
    }
    match stiff(model) {
        None => Ok(()),
        Some(what) => Err(root.bad_table(
            what,
            "add the rotor's inertia, `kind = \"armature\"`, or write a shorter `step_s`",
        )),
    }
}

/// Why a step cannot follow some joint, if it cannot: at the pose in which all joints are at 0.
fn stiff(model: &Model) -> Option<String> {
    let tree = model.rig(false).tree?;
    let inertias = SpatialEquations::new(&tree).joint_inertias(&vec![0.0; tree.len()]);
    (model.joints.iter().zip(inertias).enumerate()).find_map(|(index, (joint, inertia))| {
        let motor = joint.drive.motor()?;
        let brakes_s = inertia * motor.no_load_speed_rad_s / motor.stall_torque_nm;
        let (name, step_s) = (model.joint_name(index).unwrap_or_default(), model.step_s);
        (step_s > STIFF * brakes_s).then(|| {
            format!(
                "joint `{name}` meets {inertia:.1e} kg m^2, which its motor's back-EMF brakes \
                 within {brakes_s:.1e} s: steps of {step_s} s cannot follow"
            )
        })
    })
}

/// The tables of this kind, one for each of these names and in their order; or none at all.
fn named<'a>(
    root: &Table<'a>,
    what: &str,
    names: &[String],
    may_lack: bool,
) -> Result<Vec<Table<'a>>> {
    let tables = root.tables(what)?;
    if tables.is_empty() && may_lack {
        return Ok(tables);
    }
    if tables.len() != names.len() {
        let (found, wanted) = (tables.len(), names.len());
        return Err(tables.get(wanted).unwrap_or(root).bad_table(
            format!("{found} [[{what}]] tables for {wanted} joints of the robot"),
            format!(
                "one each, in this order: {}; hold others in [rig] locked",
                names.join(", ")
            ),
        ));
    }
    for (table, wanted) in tables.iter().zip(names) {
        let name = table.required_text("name")?;
        if name != wanted {
            return Err(table.bad(
                "name",
                format!("{what} `{name}` is not the robot's `{wanted}`"),
                "name joints and links in the order of the robot's file",
            ));
        }
    }
    Ok(tables)
}
