//! A robot in space as a model file.

use super::{
    drive_figures, fit_table, link_plan, log_table, possible_drive, remarks, write_effects,
};
use crate::dynamics::{SlideAxis, SpatialEquations, SpatialLink, SpatialTree};
use crate::model::import::LogPlan;
use crate::model::import::planar::PlanarLink;
use crate::model::import::space::{InSpace, Locked};
use crate::model::import::tree::TreeJoint;
use crate::model::new_model::{number, write_drive};
use crate::model::robot::link_values;
use std::fmt::Write as _;

/// How a model file names a robot's.
pub(in crate::model::import) struct RobotName<'a> {
    pub file: &'a str,
    pub sha256: &'a str,
    pub locked: &'a [Locked],
}

/// Longest integration step of a model that names none, s.
const USUAL_STEP_S: f64 = 0.005;

/// The model file of a robot in space; `robot` is what it names the robot's file, `text` that
/// file's.
pub(in crate::model::import) fn toml_in_space(
    name: &str,
    found: &mut InSpace,
    format: &str,
    named: &RobotName,
    log: Option<&LogPlan>,
    guessed: &[String],
) -> String {
    let mut effects = String::new();
    let mut links: Vec<PlanarLink> = (found.joints.iter())
        .zip(&found.tree.links)
        .map(|(joint, link)| as_listed(joint, link))
        .collect();
    for (index, link) in links.iter_mut().enumerate() {
        possible_drive(link);
        write_effects(&mut effects, index, link, format);
    }
    (found.left_out).extend(links.iter().flat_map(|link| link.joint.left_out.clone()));
    let mut text = head(format, log);
    text += &remarks(&found.notes, &found.left_out);
    let step_s = short_step_s(&found.tree, &links);
    write_rig(&mut text, name, named, step_s, !guessed.is_empty());
    write_bodies(&mut text, found, &links);
    text.push_str(&effects);
    text.push_str(&fit_table(guessed));
    match log {
        None => text.push_str(&log_table(&links)),
        Some(plan) => write_log(&mut text, plan),
    }
    text
}

/// The comments at the head.
fn head(format: &str, log: Option<&LogPlan>) -> String {
    let mut text = format!(
        "# A robot in space, whose shape is that of its {} file: joints and links stand here in\n\
         # the file's order and by its names.",
        format.to_uppercase()
    );
    let Some(plan) = log else {
        text += " Columns are named after the joints: mend them for\n# your logs.\n";
        return text;
    };
    text += " Guessed from a log; go through it line by line:\n";
    for comment in &plan.comments {
        let _ = writeln!(text, "# - {}", comment.replace(char::is_control, " "));
    }
    text
}

/// Writes the `[log]` of a log.
fn write_log(text: &mut String, plan: &LogPlan) {
    let _ = write!(text, "\n[log]\n{}", plan.head);
    for joint in &plan.joints {
        let _ = write!(text, "\n[[log.joint]]\n{}", joint.columns);
    }
}

/// Writes `[rig]`.
fn write_rig(
    text: &mut String,
    name: &str,
    named: &RobotName,
    step_s: Option<f64>,
    is_guessed: bool,
) {
    let name = name.replace(char::is_control, " ");
    let name = if name.trim().is_empty() {
        "robot"
    } else {
        name.as_str()
    };
    let _ = write!(
        text,
        "\n[rig]\nname = {}\nrobot = {}\nrobot_sha256 = \"{}\"\n",
        quoted(name),
        quoted(named.file),
        named.sha256
    );
    if !named.locked.is_empty() {
        let mut locked = toml_edit::InlineTable::new();
        for (joint, at) in named.locked {
            locked.insert(joint, toml_edit::Value::from(*at));
        }
        let _ = writeln!(text, "locked = {locked}");
    }
    if is_guessed {
        text.push_str(
            "guessed = true # until its drives are measured: they do not judge a log's units\n",
        );
    }
    if let Some(step_s) = step_s {
        let _ = writeln!(
            text,
            "step_s = {} # a motor brakes its link so fast: has it no rotor, no `armature`?",
            number(step_s)
        );
    }
}

/// Writes links and joints.
fn write_bodies(text: &mut String, found: &InSpace, links: &[PlanarLink]) {
    for (index, (name, _)) in found.bodies.iter().enumerate() {
        let values = link_values(&found.tree, index);
        let _ = write!(
            text,
            "\n[[link]] # {}\nname = {}\nmass_kg = {}\ncom_m = {} # from the joint's frame\n\
             inertia_kg_m2 = {} # about the centre of mass, along the joint's axis\n",
            index + 1,
            quoted(name),
            number(values.mass_kg),
            number(values.com_m),
            number(values.inertia_kg_m2),
        );
    }
    for (index, link) in links.iter().enumerate() {
        let plan = link_plan(link);
        let _ = write!(
            text,
            "\n[[joint]] # {}\nname = {}\n",
            index + 1,
            quoted(&link.joint.name)
        );
        write_drive(text, &plan);
    }
}

fn quoted(text: &str) -> String {
    toml_edit::Value::from(text).to_string()
}

/// The step that follows every motor's braking, s; none where the usual one does.
fn short_step_s(tree: &SpatialTree, links: &[PlanarLink]) -> Option<f64> {
    let inertias = SpatialEquations::new(tree).joint_inertias(&vec![0.0; tree.len()]);
    let brakes = links.iter().zip(inertias).filter_map(|(link, inertia)| {
        let drive = drive_figures(&link.joint.drive);
        Some((inertia + link.joint.armature_kg_m2) * drive.speed? / drive.stall?)
    });
    let fastest_s = brakes.fold(f64::INFINITY, f64::min);
    (USUAL_STEP_S > 2.0 * fastest_s).then(|| {
        let rounded = format!("{:.0e}", fastest_s).parse().unwrap_or(fastest_s);
        f64::max(rounded, 1e-5)
    })
}

/// A joint of a robot in space as the writers of effects and columns take one: its angles are the
/// file's.
fn as_listed(joint: &TreeJoint, link: &SpatialLink) -> PlanarLink {
    PlanarLink {
        joint: joint.clone(),
        body: (String::new(), joint.line),
        reversed: false,
        offset_rad: 0.0,
        slide: link.slides.then_some(SlideAxis {
            direction_rad: 0.0,
            link_rad: 0.0,
        }),
        length_m: 0.0,
        com_m: 0.0,
        com_angle_rad: 0.0,
        mass_kg: link.mass_kg,
        inertia_kg_m2: 0.0,
    }
}
