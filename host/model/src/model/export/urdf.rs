//! URDF: the chain with its joints' damping and friction.

use super::Exported;
use super::carried::{NotCarried, not_carried, slide_axis, value};
use super::xml::{comment, escaped, number, numbers};
use crate::effects::Rig;
use crate::model::Model;
use std::fmt::Write as _;

/// A moment of inertia of zero is refused by most readers, kg m^2.
const LEAST_INERTIA: f64 = 1e-9;

/// More than any joint does: m, m/s, N.
const UNLIMITED: f64 = 1e5;

/// Effects that URDF holds: in the links, and in the joints' `dynamics`.
const HELD: [&str; 4] = ["com_angle", "coulomb", "mass", "viscous"];

/// The model as URDF.
///
/// Joints turn about -y, counter-clockwise as seen with x to the right and z up; coordinates are
/// relative angles, the first from hanging. Gravity, drives and armatures are the reader's: URDF
/// has no place for them, so they are listed.
pub fn urdf(model: &Model) -> Exported {
    let rig = model.rig(false);
    let zero = number(model.angle_zero.from_hanging_rad());
    let zero = comment(&format!(
        "The model's first angle is the first joint's less {zero} rad."
    ));
    let mut text = format!(
        "<?xml version=\"1.0\"?>\n<robot name=\"{}\">\n  <!-- {zero} -->\n  \
         <link name=\"base\"/>\n",
        escaped(&model.name)
    );
    links(&mut text, &rig);
    joints(&mut text, model, &rig);
    text.push_str("</robot>\n");
    Exported {
        relative_files: Vec::new(),
        text,
        not_carried: left_out(model, &rig),
    }
}

fn links(text: &mut String, rig: &Rig) {
    for (index, link) in rig.chain.links.iter().enumerate() {
        let (sin, cos) = link.com_angle_rad.sin_cos();
        let inertia = number(link.inertia_kg_m2.max(LEAST_INERTIA));
        let _ = write!(
            text,
            "  <link name=\"link{}\">\n    <inertial>\n      <origin xyz=\"{}\" rpy=\"0 0 0\"/>\n      \
             <mass value=\"{}\"/>\n      <inertia ixx=\"{inertia}\" ixy=\"0\" ixz=\"0\" \
             iyy=\"{inertia}\" iyz=\"0\" izz=\"{inertia}\"/>\n    </inertial>\n  </link>\n",
            index + 1,
            numbers(&[link.com_m * sin, 0.0, -link.com_m * cos]),
            number(link.mass_kg),
        );
    }
}

fn joints(text: &mut String, model: &Model, rig: &Rig) {
    let mut above_m = 0.0;
    for (joint, link) in rig.chain.links.iter().enumerate() {
        let parent = match joint {
            0 => "base".to_string(),
            joint => format!("link{joint}"),
        };
        let of = |id| value(model, id, joint, 0).unwrap_or(0.0);
        let (kind, axis, turn) = match link.slide {
            None => ("continuous", "0 -1 0".to_string(), "0 0 0".to_string()),
            Some(slide) => (
                "prismatic",
                numbers(&slide_axis(&slide)),
                numbers(&[0.0, 0.0 - slide.link_rad, 0.0]),
            ),
        };
        let limit = match link.slide {
            None => String::new(),
            Some(_) => limit(model.joints[joint].drive.is_driven()),
        };
        let _ = write!(
            text,
            "  <joint name=\"joint{0}\" type=\"{kind}\">\n    <parent link=\"{parent}\"/>\n    \
             <child link=\"link{0}\"/>\n    <origin xyz=\"{1}\" rpy=\"{4}\"/>\n    \
             <axis xyz=\"{5}\"/>\n    <dynamics damping=\"{2}\" friction=\"{3}\"/>\n{limit}  \
             </joint>\n",
            joint + 1,
            numbers(&[0.0, 0.0, -above_m]),
            number(of("viscous")),
            number(of("coulomb")),
            turn,
            axis,
        );
        above_m = link.length_m;
    }
}

/// A prismatic joint must have limits, and the model knows none.
fn limit(driven: bool) -> String {
    let effort = number(if driven { UNLIMITED } else { 0.0 });
    let unlimited = number(UNLIMITED);
    format!(
        "    <limit lower=\"-{unlimited}\" upper=\"{unlimited}\" effort=\"{effort}\" \
         velocity=\"{unlimited}\"/>\n"
    )
}

fn left_out(model: &Model, rig: &Rig) -> Vec<NotCarried> {
    let mut missing = not_carried(model, &HELD, "URDF has no place for it");
    if rig.chain.gravity_m_s2 != 0.0 {
        let why = "gravity is the simulator's";
        missing.push(NotCarried::new("gravity_m_s2", None, why));
    }
    for (joint, drive) in model.joints.iter().map(|joint| &joint.drive).enumerate() {
        if drive.is_driven() {
            let why = "URDF has no drives";
            missing.push(NotCarried::new(drive.name(), Some(joint + 1), why));
        }
    }
    missing
}
