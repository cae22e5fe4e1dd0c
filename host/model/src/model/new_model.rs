//! A model's file written from plain figures, with comments that say what to look at next.

use super::{Dimension, JointField, Model};
use crate::dynamics::SlideAxis;
use crate::effects::Axis;
use crate::error::{Error, Result};
use serde::Deserialize;
use std::fmt::Write as _;
use std::path::Path;

/// Most links of a model that is made from figures.
const MOST_LINKS: usize = 32;

/// The figures of a model.
#[derive(Debug, Clone, PartialEq, Deserialize)]
pub struct ModelPlan {
    /// Name for reports.
    pub name: String,
    /// `hanging`, `upright` or `horizontal`.
    pub angle_zero: String,
    /// `relative` or `absolute`.
    pub angles: String,
    /// Gravity, m/s^2, where it is not the Earth's.
    #[serde(default)]
    pub gravity_m_s2: Option<f64>,
    /// Whether its figures are guesses or rough estimates.
    #[serde(default)]
    pub guessed: bool,
    /// From the base outwards.
    pub links: Vec<LinkPlan>,
}

/// A link and the joint before it.
#[derive(Debug, Clone, PartialEq, Deserialize)]
pub struct LinkPlan {
    /// Joint to next joint, m.
    pub length_m: f64,
    /// Joint to centre of mass, m.
    pub com_m: f64,
    /// Mass, kg.
    pub mass_kg: f64,
    /// About the centre of mass, kg m^2; that of an even rod of this length without.
    pub inertia_kg_m2: Option<f64>,
    /// `passive`, `torque`, `duty`, `position` or `speed`.
    pub drive: String,
    /// Duty per rad, or per rad/s, of error.
    pub gain: Option<f64>,
    /// Torque at standstill, N m.
    pub stall_torque_nm: Option<f64>,
    /// Speed without load, rad/s.
    pub no_load_speed_rad_s: Option<f64>,
    /// Along what the joint slides; the figures of its drive are then in m, m/s and N.
    #[serde(skip)]
    pub slide: Option<SlideAxis>,
}

/// The model file of a plan.
///
/// # Errors
/// Figures that make no model.
pub fn new_model_toml(plan: &ModelPlan) -> Result<String> {
    let head =
        "# Written from a form. `handstand compare` shows how far it is from a log, and where.\n\n";
    model_toml(plan, head, &[UNCERTAINTY, &log_table(plan)].concat())
}

/// The section of a file whose figures were measured or computed.
pub(super) const UNCERTAINTY: &str = "
# How well masses, moments of inertia and motor figures are known: as such values usually are. Fits
# and diagnoses move them within that. Of one that was weighed, to a hundredth:
# \"link1.mass_kg\" = 0.01
[uncertainty]
typical = true
";

/// The model file of a plan between comments at its head and what follows the joints: effects,
/// `[fit]` and `[log]`.
///
/// # Errors
/// Figures that make no model.
pub fn model_toml(plan: &ModelPlan, head: &str, tail: &str) -> Result<String> {
    if plan.links.is_empty() || plan.links.len() > MOST_LINKS {
        return Err(Error::usage(
            format!("a model has 1 to {MOST_LINKS} links here"),
            "write a longer chain by hand",
        ));
    }
    let quoted = |text: &str| toml_edit::Value::from(text).to_string();
    let mut text = format!("{head}[rig]\n");
    let _ = writeln!(text, "name = {}", quoted(&plan.name));
    let zero = quoted(&plan.angle_zero);
    let _ = writeln!(
        text,
        "angle_zero = {zero} # where the log's angles are zero"
    );
    let _ = writeln!(text, "angles = {}", quoted(&plan.angles));
    if let Some(gravity) = plan.gravity_m_s2 {
        let _ = writeln!(text, "gravity_m_s2 = {}", number(gravity));
    }
    if plan.guessed {
        text.push_str(
            "guessed = true # until its figures are measured: a log's units are not judged by them\n",
        );
    }
    for (index, link) in plan.links.iter().enumerate() {
        write_link(&mut text, index, link);
    }
    for (index, link) in plan.links.iter().enumerate() {
        write_joint(&mut text, index, link);
    }
    text.push_str(tail);
    Model::parse(&text, Path::new("model.toml"))?;
    Ok(text)
}

fn write_link(text: &mut String, index: usize, link: &LinkPlan) {
    let even_rod = link.mass_kg * link.length_m * link.length_m / 12.0;
    let (inertia, why) = match link.inertia_kg_m2 {
        Some(inertia) => (inertia, "about the centre of mass"),
        None => (even_rod, "of an even rod: a guess"),
    };
    let _ = write!(
        text,
        "\n[[link]] # {}\nlength_m = {}\ncom_m = {} # from its joint\nmass_kg = {}\n\
         inertia_kg_m2 = {} # {why}\n",
        index + 1,
        number(link.length_m),
        number(link.com_m),
        number(link.mass_kg),
        number(inertia)
    );
}

fn write_joint(text: &mut String, index: usize, link: &LinkPlan) {
    let _ = write!(text, "\n[[joint]] # {}\n", index + 1);
    if let Some(slide) = &link.slide {
        let (direction, turn) = (number(slide.direction_rad), number(slide.link_rad));
        let _ = writeln!(
            text,
            "axis = \"slide\"\nslide_rad = {direction}\nlink_rad = {turn}"
        );
    }
    write_drive(text, link);
}

/// Writes what drives a joint.
pub(super) fn write_drive(text: &mut String, link: &LinkPlan) {
    let drive = toml_edit::Value::from(link.drive.as_str());
    let _ = writeln!(text, "drive = {drive}");
    let [per_place, per_speed, stall, no_load] = match link.slide {
        None => [
            JointField::GainPerRad,
            JointField::GainSPerRad,
            JointField::StallTorque,
            JointField::NoLoadSpeed,
        ],
        Some(_) => [
            JointField::GainPerM,
            JointField::GainSPerM,
            JointField::StallForce,
            JointField::NoLoadLinearSpeed,
        ],
    }
    .map(JointField::key);
    let gain = match link.drive.as_str() {
        "position" => Some(per_place),
        "speed" => Some(per_speed),
        _ => None,
    };
    let has_motor = gain.is_some() || link.drive == "duty";
    let figures = [
        (gain, link.gain),
        (has_motor.then_some(stall), link.stall_torque_nm),
        (has_motor.then_some(no_load), link.no_load_speed_rad_s),
    ];
    for (key, value) in figures {
        if let (Some(key), Some(value)) = (key, value) {
            let _ = writeln!(text, "{key} = {}", number(value));
        }
    }
}

/// Columns under names that can be picked later.
fn log_table(plan: &ModelPlan) -> String {
    let mut text = String::from("\n[log]\ntime = { column = \"time_s\", unit = \"s\" }\n");
    for (index, link) in plan.links.iter().enumerate() {
        let joint = index + 1;
        let _ = write!(
            text,
            "\n[[log.joint]]\nposition = {{ column = \"q{joint}_rad\", unit = \"rad\" }}\n"
        );
        if let Some(unit) =
            Dimension::of_input(&link.drive, Axis::Hinge).and_then(|d| d.unit_names().next())
        {
            let _ = writeln!(
                text,
                "input = {{ column = \"input{joint}\", unit = \"{unit}\" }}"
            );
        }
    }
    text
}

/// A number as TOML writes it, with twelve significant digits: what is beyond them is rounding of
/// the arithmetic that made it.
pub(super) fn number(value: f64) -> String {
    let rounded = format!("{value:.11e}").parse().unwrap_or(value);
    toml_edit::Value::from(rounded).to_string()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::Drive;

    #[test]
    fn a_forms_figures_are_as_uncertain_as_such_figures_are() {
        let plan = ModelPlan {
            guessed: false,
            name: "arm".into(),
            angle_zero: "hanging".into(),
            angles: "relative".into(),
            gravity_m_s2: None,
            links: vec![link("duty")],
        };
        let text = new_model_toml(&plan).unwrap();
        let model = Model::parse(&text, Path::new("arm.toml")).unwrap();
        assert_eq!(model.uncertain, model.typically_uncertain());
        assert!(!model.uncertain.is_empty());
    }

    #[test]
    fn a_number_that_was_computed_is_written_without_its_rounding() {
        let even_rod = 0.3 * 0.25 * 0.25 / 12.0;
        assert_eq!(format!("{even_rod}"), "0.0015624999999999999");
        assert_eq!(number(even_rod), "0.0015625");
        assert_eq!(number(9.81), "9.81");
        assert_eq!(number(-2.0), "-2.0");
    }

    fn link(drive: &str) -> LinkPlan {
        LinkPlan {
            length_m: 0.3,
            com_m: 0.15,
            mass_kg: 0.2,
            inertia_kg_m2: None,
            drive: drive.into(),
            gain: Some(5.0),
            stall_torque_nm: Some(1.5),
            no_load_speed_rad_s: None,
            slide: None,
        }
    }

    #[test]
    fn figures_of_every_drive_make_a_model() {
        let drives = ["passive", "torque", "duty", "position", "speed"];
        let plan = ModelPlan {
            name: "five \"links\"\n[joint]".into(),
            angle_zero: "upright".into(),
            angles: "absolute".into(),
            gravity_m_s2: None,
            guessed: false,
            links: drives.map(link).to_vec(),
        };
        let text = new_model_toml(&plan).unwrap();
        let model = Model::parse(&text, Path::new("m.toml")).unwrap();
        assert_eq!(model.name, plan.name);
        assert_eq!(
            model
                .joints
                .iter()
                .map(|j| j.drive.name())
                .collect::<Vec<_>>(),
            drives
        );
        assert!((model.links[0].inertia_kg_m2 - 0.0015).abs() < 1e-12);
        assert!(
            matches!(&model.joints[3].drive, Drive::Position { gain_per_rad, .. }
                if *gain_per_rad == 5.0)
        );
    }

    #[test]
    fn figures_that_make_none_are_refused() {
        let plan = |links| ModelPlan {
            name: "x".into(),
            angle_zero: "hanging".into(),
            angles: "relative".into(),
            gravity_m_s2: None,
            guessed: false,
            links,
        };
        let wrong = LinkPlan {
            mass_kg: f64::NAN,
            ..link("passive")
        };
        assert!(new_model_toml(&plan(vec![wrong])).is_err());
        assert!(new_model_toml(&plan(vec![link("steam")])).is_err());
        assert!(new_model_toml(&plan(Vec::new())).is_err());
    }
}
