//! A model file as a [`Model`]: the rig, its links and joints.

mod columns;
mod effects;
#[cfg(test)]
mod tests;

use super::field::{JointField, LinkField, POSITIVE};
use super::limits::Limits;
use super::path::ParameterPath;
use super::reader::Table;
use super::source::Source;
use super::{AngleZero, Angles, Drive, Joint, Link, Model, Motor};
use crate::error::Result;
use std::path::Path;

const ABOVE_ZERO: Limits = Limits::above(0.0, POSITIVE.1);
const NOT_NEGATIVE: Limits = Limits::within(0.0, POSITIVE.1);
const EITHER_SIGN: Limits = Limits::within(-POSITIVE.1, POSITIVE.1);
/// Heavier gravity than Jupiter's is a slip of the unit.
const GRAVITY: Limits = Limits::within(0.0, 100.0);
/// A step beyond 0.1 s resolves no servo; one below 10 us only takes time.
const STEP: Limits = Limits::within(1e-5, 0.1);

/// Reads a whole model; `file` only names it in errors.
///
/// # Errors
/// The first thing that is unknown, missing or impossible.
pub(super) fn model(text: &str, file: &Path) -> Result<Model> {
    let source = Source { text, file };
    let document = source.document()?;
    let root = Table::root(&source, &document);
    root.only(&["rig", "link", "joint", "effect", "fit", "log"])?;

    let rig = root.required_table("rig")?;
    rig.only(&["name", "angle_zero", "angles", "gravity_m_s2", "step_s"])?;
    let links = links(&root)?;
    let joints = joints(&root, links.len())?;
    let effects = effects::read(&root, &joints)?;
    let log = columns::read(&root, &joints)?;
    let mut model = Model {
        name: rig.required_text("name")?.to_string(),
        angle_zero: rig
            .choice("angle_zero", &ANGLE_ZERO)?
            .ok_or_else(|| rig.lacks("angle_zero"))?,
        angles: rig.choice("angles", &ANGLES)?.unwrap_or(Angles::Relative),
        gravity_m_s2: rig.number("gravity_m_s2", GRAVITY)?.unwrap_or(9.81),
        step_s: rig.number("step_s", STEP)?.unwrap_or(0.005),
        links,
        joints,
        effects,
        free: Vec::new(),
        log,
    };
    model.free = free(&root, &source, &model)?;
    Ok(model)
}

const ANGLE_ZERO: [(&str, AngleZero); 3] = [
    ("hanging", AngleZero::Hanging),
    ("upright", AngleZero::Upright),
    ("horizontal", AngleZero::Horizontal),
];

const ANGLES: [(&str, Angles); 2] = [
    ("relative", Angles::Relative),
    ("absolute", Angles::Absolute),
];

fn links(root: &Table) -> Result<Vec<Link>> {
    let tables = root.tables("link")?;
    let last = match tables.len() {
        0 => return Err(root.lacks("[[link]]")),
        count => count - 1,
    };
    let links = tables.iter().enumerate().map(|(i, table)| {
        table.only(&LinkField::ALL.map(LinkField::key))?;
        let com_m = table.required_number("com_m", EITHER_SIGN)?;
        let length_m = table.number("length_m", NOT_NEGATIVE)?;
        Ok(Link {
            // Nothing hangs on the last link, so its length only shows in pictures.
            length_m: length_m
                .or_else(|| (i == last).then_some(com_m.abs()))
                .ok_or_else(|| table.lacks("length_m"))?,
            com_m,
            mass_kg: table.required_number("mass_kg", ABOVE_ZERO)?,
            inertia_kg_m2: table.required_number("inertia_kg_m2", NOT_NEGATIVE)?,
        })
    });
    links.collect()
}

fn joints(root: &Table, links: usize) -> Result<Vec<Joint>> {
    let tables = root.tables("joint")?;
    if let Some(extra) = tables.get(links) {
        return Err(extra.bad_table(
            format!("is one joint too many for {links} link(s)"),
            "every link follows one joint: add a `[[link]]` or remove the joint",
        ));
    }
    if tables.len() < links {
        return Err(root.bad_table(
            format!("has {links} link(s) but {} joint(s)", tables.len()),
            "every link follows one joint: add a `[[joint]]` for each",
        ));
    }
    tables.iter().map(joint).collect()
}

fn joint(table: &Table) -> Result<Joint> {
    let gain = |field: JointField| table.required_number(field.key(), ABOVE_ZERO);
    let known = |more: &[&'static str]| {
        let figures = ["stall_torque_nm", "no_load_speed_rad_s", "nominal_supply_v"];
        table.only(&[&["drive"], &figures[..], more].concat())
    };
    let drive = match table.choice("drive", &DRIVES)? {
        None => return Err(table.lacks("drive")),
        Some(name @ ("passive" | "torque")) => {
            table.only(&["drive"])?;
            if name == "passive" {
                Drive::Passive
            } else {
                Drive::Torque
            }
        }
        Some("duty") => {
            known(&[])?;
            Drive::Duty(motor(table)?)
        }
        Some("position") => {
            known(&["gain_per_rad"])?;
            Drive::Position {
                gain_per_rad: gain(JointField::GainPerRad)?,
                motor: motor(table)?,
            }
        }
        Some(_) => {
            known(&["gain_s_per_rad"])?;
            Drive::Speed {
                gain_s_per_rad: gain(JointField::GainSPerRad)?,
                motor: motor(table)?,
            }
        }
    };
    Ok(Joint { drive })
}

const DRIVES: [(&str, &str); 5] = [
    ("passive", "passive"),
    ("torque", "torque"),
    ("duty", "duty"),
    ("position", "position"),
    ("speed", "speed"),
];

fn motor(table: &Table) -> Result<Motor> {
    Ok(Motor {
        stall_torque_nm: table.required_number("stall_torque_nm", ABOVE_ZERO)?,
        no_load_speed_rad_s: table
            .number("no_load_speed_rad_s", ABOVE_ZERO)?
            .unwrap_or(f64::INFINITY),
        nominal_supply_v: table.number("nominal_supply_v", ABOVE_ZERO)?,
    })
}

/// The parameters `[fit]` names, or else all of the effects'.
fn free(root: &Table, source: &Source, model: &Model) -> Result<Vec<ParameterPath>> {
    let named = match root.table("fit")? {
        None => None,
        Some(fit) => {
            fit.only(&["free"])?;
            fit.texts("free")?
        }
    };
    let Some(named) = named else {
        return Ok(model
            .effects
            .iter()
            .flat_map(ParameterPath::of_effect)
            .collect());
    };
    let mut free = Vec::new();
    for (text, span) in named {
        let refused = |what: String, remedy: &str| Err(source.error(span.clone(), what, remedy));
        let path: ParameterPath = match text.parse() {
            Ok(path) => path,
            Err(error) => return refused(error.to_string(), error.remedy().unwrap_or_default()),
        };
        match path.get(model) {
            None => {
                let what = format!("`{text}` is not in this model");
                return refused(what, "add its link, drive or effect, or remove it here");
            }
            Some(value) if !value.is_finite() => {
                let what = format!("`{text}` is infinite, so nothing can be fitted");
                return refused(what, "give it a value to start from");
            }
            Some(_) if free.contains(&path) => {
                let what = format!("`{text}` is named twice");
                return refused(what, "remove one");
            }
            Some(_) => free.push(path),
        }
    }
    Ok(free)
}
