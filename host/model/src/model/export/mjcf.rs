//! MJCF, MuJoCo's format: the chain, its drives, and the effects that MuJoCo has.
//!
//! The plane of the motion is x and z, z up; every joint turns counter-clockwise as seen with x to
//! the right, about -y. Joint coordinates are relative angles, the first from hanging.

use super::Exported;
use super::carried::{NotCarried, not_carried, slide_axis, value};
use super::xml::{comment, escaped, number, numbers};
use crate::dynamics::ChainLink;
use crate::effects::Rig;
use crate::model::{Drive, Model, Motor};
use std::fmt::Write as _;

/// Integration step, s: the friction of MuJoCo is a soft constraint, and the softer the longer the
/// step.
const STEP_S: f64 = 5e-4;
/// MuJoCo refuses a moment of inertia of zero, kg m^2.
const LEAST_INERTIA: f64 = 1e-9;
/// Radius of a drawn link, m.
const RADIUS_M: f64 = 0.008;

/// Effects that MuJoCo has: of the chain, and of its joints.
const HELD: [&str; 7] = [
    "armature",
    "base_tilt",
    "cable_spring",
    "com_angle",
    "coulomb",
    "mass",
    "viscous",
];

/// The model as MJCF.
///
/// Viscous friction is `damping`, Coulomb friction `frictionloss`, a cable spring `stiffness` and
/// `springref`. A position or speed servo is an actuator whose whole torque, its back-EMF
/// included, stops at the stall torque; here the duty alone does, which is listed.
pub fn mjcf(model: &Model) -> Exported {
    let rig = model.rig(false);
    let mut text = String::new();
    let (sin, cos) = rig.gravity_turn_rad.sin_cos();
    let gravity = rig.chain.gravity_m_s2;
    let _ = write!(
        text,
        "<mujoco model=\"{}\">\n  <!-- Joints: relative angles, rad, counter-clockwise; the first \
         from hanging. {} -->\n  <compiler angle=\"radian\" autolimits=\"true\"/>\n  \
         <option timestep=\"{}\" integrator=\"RK4\" gravity=\"{}\"/>\n  <worldbody>\n",
        escaped(&model.name),
        zero(model),
        number(STEP_S),
        numbers(&[gravity * sin, 0.0, -gravity * cos]),
    );
    bodies(&mut text, model, &rig);
    text.push_str("  </worldbody>\n");
    actuators(&mut text, model);
    text.push_str("</mujoco>\n");
    Exported {
        relative_files: Vec::new(),
        text,
        not_carried: left_out(model),
    }
}

/// How the model's angles follow from the joints', as a comment.
fn zero(model: &Model) -> String {
    let zero = number(model.angle_zero.from_hanging_rad());
    comment(&format!(
        "The model's first angle is the first joint's less {zero} rad."
    ))
}

fn bodies(text: &mut String, model: &Model, rig: &Rig) {
    let mut indent = "    ".to_string();
    let mut above_m = 0.0;
    for (joint, link) in rig.chain.links.iter().enumerate() {
        let _ = writeln!(
            text,
            "{indent}<body name=\"link{}\" pos=\"{}\"{}>",
            joint + 1,
            numbers(&[0.0, 0.0, -above_m]),
            turned(link)
        );
        indent.push_str("  ");
        let _ = writeln!(text, "{indent}{}", of_joint(model, link, joint));
        let (sin, cos) = link.com_angle_rad.sin_cos();
        let inertia = link.inertia_kg_m2.max(LEAST_INERTIA);
        let _ = writeln!(
            text,
            "{indent}<inertial pos=\"{}\" mass=\"{}\" diaginertia=\"{}\"/>",
            numbers(&[link.com_m * sin, 0.0, -link.com_m * cos]),
            number(link.mass_kg),
            numbers(&[inertia; 3]),
        );
        let _ = writeln!(
            text,
            "{indent}<geom type=\"capsule\" fromto=\"{}\" size=\"{}\" contype=\"0\" \
             conaffinity=\"0\"/>",
            numbers(&[0.0, 0.0, 0.0, 0.0, 0.0, -link.length_m.max(RADIUS_M)]),
            number(RADIUS_M)
        );
        above_m = link.length_m;
    }
    for _ in &rig.chain.links {
        indent.truncate(indent.len() - 2);
        let _ = writeln!(text, "{indent}</body>");
    }
}

/// How a link that slides stands to the one before.
fn turned(link: &ChainLink) -> String {
    match link.slide.filter(|slide| slide.link_rad != 0.0) {
        Some(slide) => format!(" axisangle=\"0 -1 0 {}\"", number(slide.link_rad)),
        None => String::new(),
    }
}

fn of_joint(model: &Model, link: &ChainLink, joint: usize) -> String {
    let kind = match link.slide {
        None => "type=\"hinge\" axis=\"0 -1 0\"".to_string(),
        Some(slide) => {
            let axis = numbers(&slide_axis(&slide));
            format!("type=\"slide\" axis=\"{axis}\"")
        }
    };
    let mut hinge = format!("<joint name=\"joint{}\" {kind}", joint + 1);
    let mut attribute = |name: &str, value: Option<f64>| {
        if let Some(value) = value.filter(|value| *value != 0.0) {
            let _ = write!(hinge, " {name}=\"{}\"", number(value));
        }
    };
    let zero = model.zero_rad(joint);
    attribute("armature", Some(link.armature_kg_m2));
    attribute("damping", value(model, "viscous", joint, 0));
    attribute("frictionloss", value(model, "coulomb", joint, 0));
    attribute("stiffness", value(model, "cable_spring", joint, 0));
    attribute(
        "springref",
        value(model, "cable_spring", joint, 1).map(|rest| rest + zero),
    );
    if value(model, "coulomb", joint, 0).is_some() {
        // As hard as the step allows.
        hinge.push_str(" solreffriction=\"0.001 1\" solimpfriction=\"0.999 0.9999 0.001\"");
    }
    hinge.push_str("/>");
    hinge
}

fn actuators(text: &mut String, model: &Model) {
    let driven = model.driven_joints();
    if driven.is_empty() {
        return;
    }
    text.push_str("  <actuator>\n");
    for joint in driven {
        let name = format!("name=\"drive{0}\" joint=\"joint{0}\"", joint + 1);
        let general = |gain: f64, bias: [f64; 3], limit: String| {
            format!(
                "<general {name} gaintype=\"fixed\" biastype=\"affine\" gainprm=\"{}\" \
                 biasprm=\"{}\" {limit}/>",
                number(gain),
                numbers(&bias)
            )
        };
        let back_emf = |motor: &Motor| motor.stall_torque_nm / motor.no_load_speed_rad_s;
        let force = |motor: &Motor| {
            let limit = number(motor.stall_torque_nm);
            format!("forcerange=\"-{limit} {limit}\"")
        };
        let line = match &model.joints[joint].drive {
            Drive::Passive => continue,
            Drive::Torque => format!("<motor {name}/>"),
            Drive::Duty(motor) => general(
                motor.stall_torque_nm,
                [0.0, 0.0, -back_emf(motor)],
                "ctrlrange=\"-1.0 1.0\"".to_string(),
            ),
            Drive::Position {
                gain_per_rad,
                motor,
            } => {
                let per_rad = gain_per_rad * motor.stall_torque_nm;
                general(per_rad, [0.0, -per_rad, -back_emf(motor)], force(motor))
            }
            Drive::Speed {
                gain_s_per_rad,
                motor,
            } => {
                let gain = gain_s_per_rad * motor.stall_torque_nm;
                let bias = [0.0, 0.0, -gain - back_emf(motor)];
                general(gain + back_emf(motor), bias, force(motor))
            }
        };
        let _ = writeln!(text, "    {line}");
    }
    text.push_str("  </actuator>\n");
}

fn left_out(model: &Model) -> Vec<NotCarried> {
    let mut missing = not_carried(model, &HELD, "no element of MJCF is written for it");
    for (joint, drive) in model.joints.iter().map(|joint| &joint.drive).enumerate() {
        if matches!(drive, Drive::Position { .. } | Drive::Speed { .. }) {
            let why = "the limit of the duty: MuJoCo limits the torque, back-EMF included";
            missing.push(NotCarried::new(drive.name(), Some(joint + 1), why));
        }
        if drive
            .motor()
            .is_some_and(|motor| motor.nominal_supply_v.is_some())
        {
            let why = "MuJoCo's actuators know no supply";
            missing.push(NotCarried::new("nominal_supply_v", Some(joint + 1), why));
        }
    }
    missing
}
