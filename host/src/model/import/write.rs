//! A planar chain as a model file.

use super::planar::{PlanarChain, PlanarLink};
use super::tree::{LeftOut, TreeDrive};
use crate::effects::{Axis, named, on_axis};
use crate::error::Result;
use crate::model::new_model::{LinkPlan, ModelPlan, model_toml};
use std::fmt::Write as _;

pub(super) fn toml(
    name: &str,
    chain: &PlanarChain,
    format: &str,
    left_out: &mut Vec<LeftOut>,
) -> Result<String> {
    let mut effects = String::new();
    for (index, link) in chain.links.iter().enumerate() {
        write_effects(&mut effects, index, link, left_out);
    }
    let plan = ModelPlan {
        guessed: false,
        name: name.replace(char::is_control, " "),
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
    for part in left_out.iter() {
        let of = part
            .name
            .as_ref()
            .map_or(String::new(), |name| format!(" of {name}"));
        let line = format!("{}{of}: {}", part.part, part.why);
        let _ = writeln!(
            head,
            "# Not carried: {}",
            line.replace(char::is_control, " ")
        );
    }
    model_toml(
        &plan,
        &(head + "\n"),
        &format!("{effects}{}", log_table(chain)),
    )
}

fn link_plan(link: &PlanarLink) -> LinkPlan {
    let (drive, gain, stall, speed) = match link.joint.drive {
        TreeDrive::None => ("passive", None, None, None),
        TreeDrive::Torque(_) => ("torque", None, None, None),
        TreeDrive::Duty {
            stall_nm,
            damping_nm_s,
        } => ("duty", None, Some(stall_nm), Some(stall_nm / damping_nm_s)),
        TreeDrive::Position {
            stiffness_nm,
            damping_nm_s,
            limit_nm,
        } => (
            "position",
            Some(stiffness_nm / limit_nm),
            Some(limit_nm),
            (damping_nm_s > 0.0).then(|| limit_nm / damping_nm_s),
        ),
        TreeDrive::Speed {
            gain_nm_s,
            limit_nm,
        } => ("speed", Some(gain_nm_s / limit_nm), Some(limit_nm), None),
    };
    LinkPlan {
        length_m: link.length_m,
        com_m: link.com_m,
        mass_kg: link.mass_kg,
        inertia_kg_m2: Some(link.inertia_kg_m2.max(0.0)),
        drive: drive.to_string(),
        gain,
        stall_torque_nm: stall,
        no_load_speed_rad_s: speed,
        slide: link.slide,
    }
}

fn write_effects(text: &mut String, index: usize, link: &PlanarLink, left_out: &mut Vec<LeftOut>) {
    let joint = &link.joint;
    let axis = match link.slide {
        None => Axis::Hinge,
        Some(_) => Axis::Slide,
    };
    let key = |kind: &str, index: usize| {
        let effect = named(kind).and_then(|effect| on_axis(effect, axis));
        effect.map_or("", |effect| effect.info().parameters[index].key)
    };
    let mut effect = |kind: &str, values: &[(&str, f64)]| {
        let _ = write!(
            text,
            "\n[[effect]]\nkind = \"{kind}\"\njoint = {}\n",
            index + 1
        );
        for (key, value) in values {
            let _ = writeln!(text, "{key} = {}", toml_edit::Value::from(*value));
        }
    };
    let mut leave = |part: &str, why: &str| {
        left_out.push(LeftOut::new(part, Some(&joint.name), why));
    };
    if link.com_angle_rad != 0.0 {
        effect("com_angle", &[("angle_rad", link.com_angle_rad)]);
    }
    if joint.damping_nm_s > 0.0 {
        effect("viscous", &[(key("viscous", 0), joint.damping_nm_s)]);
    }
    if joint.friction_nm > 0.0 {
        effect("coulomb", &[(key("coulomb", 0), joint.friction_nm)]);
    }
    if joint.armature_kg_m2 > 0.0 {
        match joint.drive {
            TreeDrive::None => leave("armature", "a rotor needs a drive: --driven makes it one"),
            _ => effect("armature", &[(key("armature", 0), joint.armature_kg_m2)]),
        }
    }
    if joint.stiffness_nm > 0.0 {
        let sign = if link.reversed { -1.0 } else { 1.0 };
        let rest_rad = link.offset_rad + sign * joint.spring_rest_rad;
        effect(
            "cable_spring",
            &[
                (key("cable_spring", 0), joint.stiffness_nm),
                (key("cable_spring", 1), rest_rad),
            ],
        );
    }
    if let TreeDrive::Torque(Some(limit_nm)) = joint.drive {
        effect(
            "torque_saturation",
            &[(key("torque_saturation", 0), limit_nm)],
        );
    }
    if joint.range_rad.is_some() {
        leave("range", "links here have no end stops");
    }
    if joint.speed_rad_s.is_some() {
        leave(
            "velocity limit",
            "no drive here stops at a speed of its own; see speed_limit",
        );
    }
}

fn log_table(chain: &PlanarChain) -> String {
    let mut text = String::from("\n[log]\ntime = { column = \"time_s\", unit = \"s\" }\n");
    for link in &chain.links {
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
