//! Links and joints of a robot in space: its file has their shape, the model their values.

use super::super::field::LinkField;
use super::super::reader::Table;
use super::super::reason::ModelReason;
use super::super::{Joint, Link, Robot};
use super::{NOT_NEGATIVE, drive};
use crate::dynamics::SlideAxis;
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
            com_m: number(LinkField::Com, NOT_NEGATIVE, file.com_m)?,
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

/// The tables of this kind, one for each of these names and in their order; or none at all.
fn named<'a>(
    root: &Table<'a>,
    what: &'static str,
    names: &[String],
    may_lack: bool,
) -> Result<Vec<Table<'a>>> {
    let tables = root.tables(what)?;
    if tables.is_empty() && may_lack {
        return Ok(tables);
    }
    if tables.len() != names.len() {
        let (found, wanted) = (tables.len(), names.len());
        let names = names.join(", ");
        let reason = ModelReason::RobotCount {
            what,
            found,
            wanted,
            names,
        };
        return Err(match tables.get(wanted) {
            Some(extra) => extra.bad_table(reason),
            None => root.bad_table(reason),
        });
    }
    for (table, wanted) in tables.iter().zip(names) {
        let name = table.required_text("name")?;
        if name != wanted {
            let (name, wanted) = (name.to_string(), wanted.clone());
            return Err(table.bad("name", ModelReason::OtherName { what, name, wanted }));
        }
    }
    Ok(tables)
}
