//! Links and joints of a robot in space: its file has their shape, the model their values.

use super::super::field::LinkField;
use super::super::reader::Table;
use super::super::suggest::suggest;
use super::super::{Joint, Link, Model, RateSensor, Robot};
use super::{EITHER_SIGN, NOT_NEGATIVE, drive};
use crate::dynamics::{SlideAxis, SpatialEquations};
use crate::effects::Axis;
use crate::error::Result;

/// The links: what no `[[link]]` says is as in the robot's file.
pub(super) fn links(root: &Table, robot: &Robot) -> Result<Vec<Link>> {
    let tables = root.tables("link")?;
    let tables = by_name(&tables, &robot.links)?;
    let links = tables.iter().enumerate().map(|(index, table)| {
        let file = robot.link(index);
        let Some(table) = table else {
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
    let tables = one_each(root, &robot.joints)?;
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

/// Of each of these links the table that names it, if there is one. Where several joints move one
/// body their links have its name, and the last one its mass: fewer tables are those of the last.
fn by_name<'t, 'a>(
    tables: &'t [Table<'a>],
    links: &[String],
) -> Result<Vec<Option<&'t Table<'a>>>> {
    let mut found = vec![None; links.len()];
    for table in tables.iter().rev() {
        let name = table.required_text("name")?;
        let mut own = (0..links.len()).rev().filter(|link| links[*link] == name);
        match own.find(|link| found[*link].is_none()) {
            Some(link) => found[link] = Some(table),
            None if links.iter().any(|link| link == name) => {
                let what = format!("link `{name}` has another table");
                return Err(table.bad("name", what, "write one table for each link"));
            }
            None => {
                let what = format!("no joint of the robot moves a link `{name}`");
                return Err(table.bad("name", what, suggest(name, links)));
            }
        }
    }
    Ok(found)
}

/// The `[[joint]]` tables, one for each of these names and in their order.
fn one_each<'a>(root: &Table<'a>, names: &[String]) -> Result<Vec<Table<'a>>> {
    let tables = root.tables("joint")?;
    if tables.len() != names.len() {
        let (found, wanted) = (tables.len(), names.len());
        return Err(tables.get(wanted).unwrap_or(root).bad_table(
            format!("{found} [[joint]] tables for {wanted} joints of the robot"),
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
                format!("joint `{name}` is not the robot's `{wanted}`"),
                "name joints in the order of the robot's file",
            ));
        }
    }
    Ok(tables)
}
