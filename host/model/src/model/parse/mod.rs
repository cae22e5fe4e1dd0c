//! A model file as a [`Model`]: the rig, its links and joints.

mod columns;
mod effects;
mod expressions;
mod fit;
mod in_space;
#[cfg(test)]
mod in_space_tests;
#[cfg(test)]
mod slide_tests;
#[cfg(test)]
mod tests;
pub(super) mod uncertainty;

use super::field::{JOINT_INERTIA, JointField, LinkField, POSITIVE};
use super::limits::Limits;
use super::reader::Table;
use super::source::TomlSource;
use super::{AngleZero, Angles, Drive, Joint, Link, Model, Motor, Robot};
use crate::dynamics::SlideAxis;
use crate::effects::Axis;
use crate::error::Result;
use std::f64::consts::TAU;
use std::path::Path;

const ABOVE_ZERO: Limits = Limits::above(0.0, POSITIVE.1);
const NOT_NEGATIVE: Limits = Limits::within(0.0, POSITIVE.1);
const EITHER_SIGN: Limits = Limits::within(-POSITIVE.1, POSITIVE.1);
/// Heavier gravity than Jupiter's is a slip of the unit.
const GRAVITY: Limits = Limits::within(0.0, 100.0);
/// Beyond a turn, a direction is a slip of the unit.
const ONE_TURN: Limits = Limits::within(-TAU, TAU);
/// A step beyond 0.1 s resolves no servo; one below 10 us only takes time.
/// What an integration step may be, s.
pub const STEP_S: Limits = Limits::within(1e-5, 0.1);

/// Reads a whole model; `file` only names it in errors.
///
/// # Errors
/// The first thing that is unknown, missing or impossible.
pub(super) fn model(text: &str, file: &Path) -> Result<Model> {
    model_of(text, file, None)
}

const TABLES: [&str; 8] = [
    "rig",
    "link",
    "joint",
    "expression",
    "effect",
    "fit",
    "uncertainty",
    "log",
];

/// Reads a model whose robot is this text, not what is in the robot's file.
///
/// # Errors
/// As [`model`].
pub(super) fn model_of(text: &str, file: &Path, robot: Option<&str>) -> Result<Model> {
    let source = TomlSource { text, file };
    let document = source.document()?;
    let root = Table::root(&source, &document);
    root.only(&TABLES)?;

    let rig = root.required_table("rig")?;
    let robot = Robot::read(&rig, file, robot)?;
    let of_shape: &[&str] = match robot {
        None => &["angle_zero", "angles"],
        Some(_) => &["robot", "robot_sha256", "locked"],
    };
    rig.only(&[of_shape, &["name", "gravity_m_s2", "step_s", "guessed"]].concat())?;
    let (links, joints) = match &robot {
        None => {
            let links = links(&root)?;
            let joints = joints(&root, links.len())?;
            (links, joints)
        }
        Some(robot) => (
            in_space::links(&root, robot)?,
            in_space::joints(&root, robot)?,
        ),
    };
    let laws = expressions::read(&root)?;
    let effects = effects::read(&root, &joints, &laws, robot.as_ref())?;
    let log = columns::read(&root, &links, &joints, robot.as_ref())?;
    let (angle_zero, gravity_m_s2) = match &robot {
        None => (
            rig.required("angle_zero", rig.choice("angle_zero", &ANGLE_ZERO)?)?,
            9.81,
        ),
        // Its angles are those of the robot's file.
        Some(robot) => (AngleZero::Hanging, robot.tree.gravity_m_s2.norm()),
    };
    let mut model = Model {
        name: rig.required_text("name")?.to_string(),
        angle_zero,
        angles: rig.choice("angles", &ANGLES)?.unwrap_or(Angles::Relative),
        gravity_m_s2: rig.number("gravity_m_s2", GRAVITY)?.unwrap_or(gravity_m_s2),
        step_s: rig.number("step_s", STEP_S)?.unwrap_or(0.005),
        guessed: rig.flag("guessed")?,
        links,
        joints,
        robot,
        effects,
        laws,
        free: Vec::new(),
        bounds: Vec::new(),
        uncertain: Vec::new(),
        log,
    };
    slides_are_relative(&rig, &model)?;
    in_space::check(&root, &model)?;
    (model.free, model.bounds) = fit::read(&root, &model)?;
    model.uncertain = uncertainty::read(&root, &model)?;
    // What is uncertain takes part in every fit.
    for value in &model.uncertain {
        if !model.free.contains(&value.path) {
            model.free.push(value.path);
        }
    }
    Ok(model)
}

fn slides_are_relative(rig: &Table, model: &Model) -> Result<()> {
    if model.slides() && model.angles == Angles::Absolute {
        return Err(rig.bad(
            "angles",
            "the model has joints that slide, and angles from the world",
            "write `angles = \"relative\"`: each from the link before",
        ));
    }
    Ok(())
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
        table.only(&[&LinkField::ALL.map(LinkField::key)[..], &[JOINT_INERTIA]].concat())?;
        let com_m = table.required_number("com_m", EITHER_SIGN)?;
        let mass_kg = table.required_number("mass_kg", ABOVE_ZERO)?;
        let length_m = table.number("length_m", NOT_NEGATIVE)?;
        // Nothing hangs on the last link, so its length only shows in pictures.
        let length_m = length_m.or_else(|| (i == last).then_some(com_m.abs()));
        Ok(Link {
            length_m: table.required("length_m", length_m)?,
            com_m,
            mass_kg,
            inertia_kg_m2: inertia(table, mass_kg * com_m * com_m)?,
        })
    });
    links.collect()
}

/// The moment about the centre of mass; `steiner_kg_m2` is what the joint's distance adds to it.
fn inertia(table: &Table, steiner_kg_m2: f64) -> Result<f64> {
    let Some(about_joint) = table.number(JOINT_INERTIA, NOT_NEGATIVE)? else {
        return table.required_number(LinkField::Inertia.key(), NOT_NEGATIVE);
    };
    if table.has(LinkField::Inertia.key()) {
        return Err(table.bad_key(
            JOINT_INERTIA,
            "the link has a moment of inertia about its centre of mass too",
            "keep inertia_kg_m2 or joint_inertia_kg_m2",
        ));
    }
    let inertia_kg_m2 = about_joint - steiner_kg_m2;
    if inertia_kg_m2 >= 0.0 {
        Ok(inertia_kg_m2)
    } else {
        Err(table.bad(
            JOINT_INERTIA,
            format!(
                "{about_joint} kg m^2 about the joint is less than mass_kg com_m^2 = \
                 {steiner_kg_m2:.4e} kg m^2"
            ),
            "mend one of the three; about the centre of mass it is inertia_kg_m2",
        ))
    }
}

fn joints(root: &Table, links: usize) -> Result<Vec<Joint>> {
    let tables = root.tables("joint")?;
    let joints = tables.len();
    if let Some(extra) = tables.get(links) {
        return Err(extra.bad_table(
            format!(
                "[[joint]] {} is one joint too many for {links} link(s)",
                links + 1
            ),
            "every link follows one joint: add a `[[link]]` or remove the joint",
        ));
    }
    if joints < links {
        return Err(root.bad_table(
            format!("the file has {links} link(s) but {joints} joint(s)"),
            "every link follows one joint: add a `[[joint]]` for each",
        ));
    }
    let joints = tables.iter().map(|table| {
        let axis = table.choice("axis", &AXES)?.unwrap_or(Axis::Hinge);
        let slide = match axis {
            Axis::Hinge => None,
            Axis::Slide => Some(SlideAxis {
                direction_rad: table.required_number("slide_rad", ONE_TURN)?,
                link_rad: table.number("link_rad", ONE_TURN)?.unwrap_or(0.0),
            }),
        };
        let of_axis: &[&str] = match axis {
            Axis::Hinge => &["axis"],
            Axis::Slide => &["axis", "slide_rad", "link_rad"],
        };
        let drive = drive(table, axis, of_axis)?;
        Ok(Joint { drive, slide })
    });
    joints.collect()
}

/// The keys of what a motor and its regulator are, by how the joint moves: torque or force at
/// standstill, speed without load, gains of a position and of a speed drive.
fn motor_keys(axis: Axis) -> [&'static str; 4] {
    let fields = JointField::ALL.into_iter();
    let keys = fields
        .filter(|field| field.axis() == axis)
        .map(JointField::key);
    let mut sorted = [""; 4];
    for (place, key) in sorted.iter_mut().zip(keys) {
        *place = key;
    }
    sorted
}

/// What drives the joint of a table, which has these keys beside those of its drive.
fn drive(table: &Table, axis: Axis, others: &[&'static str]) -> Result<Drive> {
    let [gain_per_angle, gain_per_speed, stall, no_load] = motor_keys(axis);
    let drive = table.required("drive", table.choice("drive", &DRIVES)?)?;
    let mut known = vec!["drive"];
    known.extend(others);
    if !matches!(drive, "passive" | "torque") {
        known.extend([stall, no_load, "nominal_supply_v"]);
    }
    match drive {
        "position" => known.push(gain_per_angle),
        "speed" => known.push(gain_per_speed),
        _ => {}
    }
    table.only(&known)?;
    let gain = |key: &str| table.required_number(key, ABOVE_ZERO);
    let motor = || motor(table, stall, no_load);
    Ok(match drive {
        "passive" => Drive::Passive,
        "torque" => Drive::Torque,
        "duty" => Drive::Duty(motor()?),
        "position" => Drive::Position {
            gain_per_rad: gain(gain_per_angle)?,
            motor: motor()?,
        },
        _ => Drive::Speed {
            gain_s_per_rad: gain(gain_per_speed)?,
            motor: motor()?,
        },
    })
}

const AXES: [(&str, Axis); 2] = [("hinge", Axis::Hinge), ("slide", Axis::Slide)];

const DRIVES: [(&str, &str); 5] = [
    ("passive", "passive"),
    ("torque", "torque"),
    ("duty", "duty"),
    ("position", "position"),
    ("speed", "speed"),
];

fn motor(table: &Table, stall: &str, no_load: &str) -> Result<Motor> {
    let no_load_speed = table.number(no_load, ABOVE_ZERO)?;
    Ok(Motor {
        stall_torque_nm: table.required_number(stall, ABOVE_ZERO)?,
        no_load_speed_rad_s: no_load_speed.unwrap_or(f64::INFINITY),
        nominal_supply_v: table.number("nominal_supply_v", ABOVE_ZERO)?,
    })
}
