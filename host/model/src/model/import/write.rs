//! A planar chain as a model file.

mod in_space;

pub(super) use in_space::{RobotName, toml_in_space};

use super::planar::{PlanarChain, PlanarLink};
use super::remark::{Remark, told};
use super::tree::TreeDrive;
use crate::effects::{Axis, Parameter, named};
use crate::error::{Error, Place, Result};
use crate::model::field::POSITIVE;
use crate::model::new_model::{LinkPlan, ModelPlan, UNCERTAINTY, model_toml};
use std::fmt::Write as _;
use std::path::Path;

/// Heaviest gravity of a model, m/s^2.
const MOST_GRAVITY_M_S2: f64 = 100.0;

/// Notes, and what is not carried, as comments of a model file.
fn remarks(notes: &[Remark], left_out: &[Remark]) -> String {
    let notes = told(notes).into_iter().map(|note| format!("Note: {note}"));
    let left_out = told(left_out).into_iter();
    let lines = notes.chain(left_out.map(|part| format!("Not carried: {part}")));
    lines
        .map(|line| format!("# {}\n", line.replace(char::is_control, " ")))
        .collect()
}

/// The model file; `path` is the robot's.
///
/// # Errors
/// Figures that no model has, with their place in the robot's file.
pub(super) fn toml(
    name: &str,
    chain: &mut PlanarChain,
    format: &str,
    path: &Path,
    guessed: &[String],
    left_out: &mut Vec<Remark>,
) -> Result<String> {
    possible(chain, path)?;
    let mut effects = String::new();
    for (index, link) in chain.links.iter_mut().enumerate() {
        possible_drive(link);
        write_effects(&mut effects, index, link, format);
    }
    left_out.extend(
        chain
            .links
            .iter()
            .flat_map(|link| link.joint.left_out.clone()),
    );
    let name = name.replace(char::is_control, " ");
    let plan = ModelPlan {
        guessed: !guessed.is_empty(),
        name: match name.trim() {
            "" => "robot".to_string(),
            _ => name,
        },
        angle_zero: "hanging".to_string(),
        angles: "relative".to_string(),
        gravity_m_s2: Some(chain.gravity_m_s2),
        links: chain.links.iter().map(link_plan).collect(),
    };
    let mut head = format!(
        "# Imported from {}. Angles are relative, the first from hanging; [log] turns the file's\n\
         # joint coordinates into them. Columns are named after the joints: mend them for your logs.\n",
        format.to_uppercase()
    );
    head += &remarks(&chain.notes, left_out);
    let text = model_toml(
        &plan,
        &(head + "\n"),
        &format!(
            "{effects}{}{UNCERTAINTY}{}",
            fit_table(guessed),
            log_table(&chain.links)
        ),
    );
    // The model's text is not there for anyone to look into.
    text.map_err(|error| match error {
        Error::Data { problem, .. } => {
            let what = format!("no model follows from its figures: {problem}");
            Error::data(Place::file(path), what, problem.remedy)
        }
        error => error,
    })
}

/// Refuses figures of links that no model has: their bounds are those of `[[link]]` and `[rig]`.
fn possible(chain: &PlanarChain, path: &Path) -> Result<()> {
    let most = POSITIVE.1;
    for link in &chain.links {
        let figures = [
            ("a mass", link.mass_kg, "kg"),
            ("a moment of inertia", link.inertia_kg_m2, "kg m^2"),
            ("a length", link.length_m, "m"),
            ("a centre of mass at", link.com_m, "m"),
        ];
        for (what, value, unit) in figures {
            if value.abs() > most {
                let (name, line) = &link.body;
                let place = Place {
                    line: Some(*line),
                    ..Place::file(path)
                };
                let what = format!(
                    "the link {name}, with what is fixed to it, has {what} {value:.4e} {unit}"
                );
                let remedy =
                    format!("a model's links have up to {most} {unit}: is the unit right?");
                return Err(Error::data(place, what, remedy));
            }
        }
    }
    if chain.gravity_m_s2 > MOST_GRAVITY_M_S2 {
        let what = format!("gravity of {:.4e} m/s^2", chain.gravity_m_s2);
        let remedy = format!("a model has up to {MOST_GRAVITY_M_S2} m/s^2: is the unit right?");
        return Err(Error::data(Place::file(path), what, remedy));
    }
    Ok(())
}

/// Whether a figure of a drive is one that a model may have.
fn is_possible(value: f64) -> bool {
    value > 0.0 && value <= POSITIVE.1
}

/// Replaces a drive whose figures no model has by a torque, and says so; says of a speed without
/// load that no model has that it is left out.
fn possible_drive(link: &mut PlanarLink) {
    let figures = drive_figures(&link.joint.drive);
    let of_drive = [figures.gain, figures.stall];
    let (by, line) = link.joint.limited_by;
    let most = POSITIVE.1;
    if of_drive.into_iter().flatten().all(is_possible) {
        if let Some(speed) = figures.beyond_all_speeds {
            let (unit, effort) = match link.slide {
                None => ("rad/s", "torque"),
                Some(_) => ("m/s", "force"),
            };
            let why = format!(
                "{speed:.4e} {unit} is beyond the {most} that a drive here has: its {effort} does \
                 not fall with its speed"
            );
            link.joint.leave("speed without load", line, why);
        }
        return;
    }
    let limit_nm = figures.stall.filter(|_| !by.is_empty());
    let why = format!(
        "its stiffness or limit makes a gain or a stall torque beyond the {most} that a drive here \
         has: its joint is driven by torque"
    );
    link.joint.drive = TreeDrive::Torque(limit_nm);
    link.joint.leave("actuator", line, why);
}

/// What a drive is called, and its figures, of which a model has bounds.
struct DriveFigures {
    name: &'static str,
    gain: Option<f64>,
    stall: Option<f64>,
    speed: Option<f64>,
    /// A speed that no model has, in place of `speed`.
    beyond_all_speeds: Option<f64>,
}

fn drive_figures(drive: &TreeDrive) -> DriveFigures {
    let (gain, stall, speed) = match *drive {
        TreeDrive::None | TreeDrive::Torque(_) => (None, None, None),
        TreeDrive::Duty {
            stall_nm,
            damping_nm_s,
            ..
        } => (None, Some(stall_nm), Some(stall_nm / damping_nm_s)),
        TreeDrive::Position {
            stiffness_nm,
            damping_nm_s,
            limit_nm,
        } => (
            Some(stiffness_nm / limit_nm),
            Some(limit_nm),
            (damping_nm_s > 0.0).then(|| limit_nm / damping_nm_s),
        ),
        TreeDrive::Speed {
            gain_nm_s,
            limit_nm,
        } => (Some(gain_nm_s / limit_nm), Some(limit_nm), None),
    };
    // Torque that falls to nothing beyond all speeds hardly falls.
    let is_beyond = |speed: &f64| *speed > POSITIVE.1;
    DriveFigures {
        name: drive.name(),
        gain,
        stall,
        speed: speed.filter(|speed| !is_beyond(speed)),
        // Without any damping there is no such speed.
        beyond_all_speeds: speed.filter(|speed| speed.is_finite() && is_beyond(speed)),
    }
}

fn link_plan(link: &PlanarLink) -> LinkPlan {
    let drive = drive_figures(&link.joint.drive);
    LinkPlan {
        length_m: link.length_m,
        com_m: link.com_m,
        mass_kg: link.mass_kg,
        inertia_kg_m2: Some(link.inertia_kg_m2),
        drive: drive.name.to_string(),
        gain: drive.gain,
        stall_torque_nm: drive.stall,
        no_load_speed_rad_s: drive.speed,
        slide: link.slide,
    }
}

/// What acts on a joint: the effect, the attribute and its line, and the values.
struct Acting<'a> {
    kind: &'a str,
    attribute: (&'a str, usize),
    values: &'a [f64],
}

/// Writes an effect, or says that its values are beyond what it may have.
fn write_effect(text: &mut String, index: usize, link: &mut PlanarLink, acting: &Acting) {
    let axis = match link.slide {
        None => Axis::Hinge,
        Some(_) => Axis::Slide,
    };
    let known = named(acting.kind).and_then(|effect| effect.on(axis));
    let parameters: &[Parameter] = known.map_or(&[], |effect| effect.info().parameters);
    let (attribute, line) = acting.attribute;
    for (own, value) in parameters.iter().zip(acting.values) {
        let (low, high) = own.bounds;
        if !(low..=high).contains(value) {
            let unit = own.unit;
            let why = format!("{value} {unit}; `{}` here has {low} to {high}", acting.kind);
            link.joint.leave(attribute, line, why);
            return;
        }
    }
    let _ = write!(
        text,
        "\n[[effect]]\nkind = \"{}\"\njoint = {}\n",
        acting.kind,
        index + 1
    );
    for (own, value) in parameters.iter().zip(acting.values) {
        let _ = writeln!(text, "{} = {}", own.key, toml_edit::Value::from(*value));
    }
}

fn write_effects(text: &mut String, index: usize, link: &mut PlanarLink, format: &str) {
    let joint = link.joint.clone();
    let com_angle_rad = link.com_angle_rad;
    let sign = if link.reversed { -1.0 } else { 1.0 };
    let rest_rad = link.offset_rad + sign * joint.spring_rest_rad;
    let friction = match format {
        "urdf" => "friction",
        _ => "frictionloss",
    };
    let mut effect = |kind: &str, attribute: (&str, usize), values: &[f64]| {
        let acting = Acting {
            kind,
            attribute,
            values,
        };
        write_effect(text, index, link, &acting);
    };
    let of_joint = |attribute| (attribute, joint.line);
    if com_angle_rad != 0.0 {
        effect("com_angle", of_joint("inertial"), &[com_angle_rad]);
    }
    if joint.damping_nm_s != 0.0 {
        effect("viscous", of_joint("damping"), &[joint.damping_nm_s]);
    }
    if joint.friction_nm != 0.0 {
        effect("coulomb", of_joint(friction), &[joint.friction_nm]);
    }
    if joint.stiffness_nm != 0.0 {
        let values = [joint.stiffness_nm, rest_rad];
        effect("cable_spring", of_joint("stiffness"), &values);
    }
    if let TreeDrive::Torque(Some(limit_nm))
    | TreeDrive::Duty {
        limit_nm: Some(limit_nm),
        ..
    } = joint.drive
    {
        effect("torque_saturation", joint.limited_by, &[limit_nm]);
    }
    if joint.armature_kg_m2 != 0.0 {
        match joint.drive {
            TreeDrive::None => {
                let why = "a rotor needs a drive: --driven makes it one";
                link.joint.leave("armature", joint.line, why);
            }
            _ => effect("armature", of_joint("armature"), &[joint.armature_kg_m2]),
        }
    }
}

/// `[fit]` of values that are guesses; nothing without.
fn fit_table(guessed: &[String]) -> String {
    if guessed.is_empty() {
        return String::new();
    }
    let mut text = String::from(
        "\n# Guesses that a fit may change. What the logs do not determine, it says: take that \
         off.\n[fit]\nfree = [\n",
    );
    for address in guessed {
        let _ = writeln!(text, "    {},", toml_edit::Value::from(address.as_str()));
    }
    text.push_str("]\n");
    text
}

fn log_table(links: &[PlanarLink]) -> String {
    let mut text = String::from("\n[log]\ntime = { column = \"time_s\", unit = \"s\" }\n");
    for link in links {
        let column = |of: &str| toml_edit::Value::from(format!("{}.{of}", link.joint.name));
        let reversed = if link.reversed {
            ", reversed = true"
        } else {
            ""
        };
        let [place, speed, torque] = match link.slide {
            None => ["rad", "rad/s", "N m"],
            Some(_) => ["m", "m/s", "N"],
        };
        let offset = match link.offset_rad {
            0.0 => String::new(),
            offset => format!(", offset_{place} = {}", toml_edit::Value::from(offset)),
        };
        let _ = write!(
            text,
            "\n[[log.joint]]\nposition = {{ column = {}, unit = \"{place}\"{reversed}{offset} }}\n",
            column("position")
        );
        let (of, unit, offset) = match link.joint.drive {
            TreeDrive::None => continue,
            TreeDrive::Torque(_) => ("effort", torque, ""),
            TreeDrive::Duty { .. } => ("duty", "1", ""),
            TreeDrive::Position { .. } => ("goal", place, offset.as_str()),
            TreeDrive::Speed { .. } => ("goal_speed", speed, ""),
        };
        let _ = writeln!(
            text,
            "input = {{ column = {}, unit = \"{unit}\"{reversed}{offset} }}",
            column(of)
        );
    }
    text
}
