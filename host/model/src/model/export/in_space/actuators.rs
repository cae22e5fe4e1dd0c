//! Gains and limits of a robot's actuators in MJCF, as a model has them.

use super::edits::Edits;
use super::joints::changed;
use super::{Pair, Source, is_near, rounded};
use crate::model::export::carried::value;
use crate::model::export::xml::{escaped, number, numbers};
use crate::model::import::mjcf::defaults::{Attributes, Defaults};
use crate::model::import::mjcf::orientation::Compiler;
use crate::model::{Drive, Model};

/// What a drive does: torque = gain * input - stiffness * angle - damping * speed, N m and rad, at
/// most `limit_nm`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Law {
    pub gain: f64,
    pub stiffness: f64,
    pub damping: f64,
    pub limit_nm: Option<f64>,
}

impl Law {
    /// Of a joint's drive; `saturation_nm` is the limit that an effect sets.
    pub fn of(drive: &Drive, saturation_nm: Option<f64>) -> Option<Law> {
        let back_emf = drive.motor().map_or(0.0, |motor| {
            motor.stall_torque_nm / motor.no_load_speed_rad_s
        });
        let stall_nm = drive.motor().map(|motor| motor.stall_torque_nm);
        let (gain, stiffness, damping, limit_nm) = match drive {
            Drive::Passive => return None,
            Drive::Torque => (1.0, 0.0, 0.0, saturation_nm),
            Drive::Duty(motor) => (motor.stall_torque_nm, 0.0, back_emf, saturation_nm),
            Drive::Position {
                gain_per_rad,
                motor,
            } => {
                let stiffness = gain_per_rad * motor.stall_torque_nm;
                (stiffness, stiffness, back_emf, stall_nm)
            }
            Drive::Speed {
                gain_s_per_rad,
                motor,
            } => {
                // Its goal is asked of the motor without load, too.
                let gain = gain_s_per_rad * motor.stall_torque_nm + back_emf;
                (gain, 0.0, gain, stall_nm)
            }
        };
        Some(Law {
            gain,
            stiffness,
            damping,
            limit_nm,
        })
    }

    /// Of a model's joint.
    pub fn at(model: &Model, joint: usize) -> Option<Law> {
        let saturation_nm = value(model, "torque_saturation", joint, 0);
        Law::of(&model.joints[joint].drive, saturation_nm)
    }

    /// Whether two are the same but for their limits.
    pub fn acts_as(&self, other: &Law) -> bool {
        is_near(self.gain, other.gain)
            && is_near(self.stiffness, other.stiffness)
            && is_near(self.damping, other.damping)
    }
}

/// Writes what drives the joints.
pub(super) fn write(edits: &mut Edits, source: &Source, models: &Pair, defaults: &Defaults) {
    let mut added = Vec::new();
    for joint in 0..models.own.joints.len() {
        let Some(own) = Law::at(models.own, joint) else {
            continue;
        };
        let file = Law::at(models.file(joint), joint);
        let in_file = &source.found.joints[joint];
        let is_torque = models.own.joints[joint].drive == Drive::Torque;
        let Some(at) = in_file.actuator_at else {
            if is_torque {
                limit_joint(edits, source, models, joint);
            } else if let Some(name) = source.element(in_file.at).text("name") {
                added.push(general(name, &own));
            }
            continue;
        };
        let Ok(actuator) = defaults.attributes(source.element(at), None) else {
            continue;
        };
        if file.is_none_or(|file| !own.acts_as(&file)) {
            gains(edits, &actuator, &own, file.as_ref());
        }
        limit(edits, source, (&actuator, joint), &own, file.as_ref());
    }
    if added.is_empty() {
        return;
    }
    let root = source.root();
    match root.first("actuator") {
        Some(actuators) => edits.insert(&actuators.node, &added.join("\n    ")),
        None => {
            let all = added.join("\n    ");
            let text = format!("  <actuator>\n    {all}\n  </actuator>\n");
            edits.append(&root.node, &text);
        }
    }
}

/// The least word of an attribute, or what MuJoCo takes without.
fn first(own: &Attributes, key: &str, without: f64) -> f64 {
    let values = own.numbers(key).ok().flatten();
    values
        .and_then(|values| values.first().copied())
        .unwrap_or(without)
}

/// Writes an actuator's gains, as far as its kind has them; what it cannot say stays as it is.
fn gains(edits: &mut Edits, actuator: &Attributes, own: &Law, file: Option<&Law>) {
    let node = &actuator.element.node;
    let gear = first(actuator, "gear", 1.0);
    // Seen from the joint, the actuator's length is the gear times the angle.
    let (stiffness, damping) = (own.stiffness / (gear * gear), own.damping / (gear * gear));
    let mut set = |key: &str, value: f64, without: f64| {
        if !is_near(value, first(actuator, key, without)) {
            edits.set_first(node, key, &number(rounded(value)));
        }
    };
    match actuator.element.tag() {
        "position" if own.stiffness > 0.0 => {
            set("kp", stiffness, 1.0);
            set("kv", damping, 0.0);
        }
        "velocity" if own.stiffness == 0.0 && gear == 1.0 && own.gain == own.damping => {
            set("kv", own.gain, 1.0);
        }
        "general" => {
            let before = file.map_or(own.gain, |file| file.gain);
            let gain = if gear == 1.0 {
                own.gain
            } else {
                first(actuator, "gainprm", 1.0) * own.gain / before
            };
            set("gainprm", gain, 1.0);
            let bias = actuator.numbers("biasprm").ok().flatten();
            let bias = bias.unwrap_or_default().into_iter().skip(3);
            let own = [0.0, 0.0 - stiffness, 0.0 - damping].map(rounded);
            let bias: Vec<f64> = own.into_iter().chain(bias).collect();
            edits.set(node, "biasprm", &numbers(&bias));
            if actuator.text("biastype") != Some("affine") {
                edits.set(node, "biastype", "affine");
            }
        }
        _ => {}
    }
}

/// Writes the largest torque where the file has another.
fn limit(
    edits: &mut Edits,
    source: &Source,
    (actuator, joint): (&Attributes, usize),
    own: &Law,
    file: Option<&Law>,
) {
    let before = file.and_then(|file| file.limit_nm);
    let Some(most_nm) = own.limit_nm else { return };
    if before.is_some_and(|before| is_near(most_nm, before)) {
        return;
    }
    let gear = first(actuator, "gear", 1.0).abs();
    let node = &actuator.element.node;
    match source.found.joints[joint].limited_by.0 {
        "actuatorfrcrange" => {
            let element = source.element(source.found.joints[joint].at);
            edits.set(&element.node, "actuatorfrcrange", &range(most_nm));
        }
        "ctrlrange" => {
            let gain = first(actuator, "gainprm", 1.0).abs();
            edits.set(node, "ctrlrange", &range(most_nm / (gear * gain)));
        }
        _ => {
            edits.set(node, "forcerange", &range(most_nm / gear));
            let limits = |compiler: &Compiler| compiler.limits(actuator, "forcelimited");
            if !source.compiler.as_ref().is_some_and(limits) {
                edits.set(node, "forcelimited", "true");
            }
        }
    }
}

/// Writes the largest torque of a joint that the file does not drive.
fn limit_joint(edits: &mut Edits, source: &Source, models: &Pair, joint: usize) {
    let limit = changed(models, "torque_saturation", joint, 0);
    if let Some(most_nm) = limit.filter(|most_nm| *most_nm > 0.0) {
        let node = source.element(source.found.joints[joint].at).node;
        edits.set(&node, "actuatorfrcrange", &range(most_nm));
        edits.set(&node, "actuatorfrclimited", "true");
    }
}

fn range(most: f64) -> String {
    numbers(&[-most, most].map(rounded))
}

/// An actuator of a joint that the file does not drive.
fn general(joint: &str, own: &Law) -> String {
    let joint = escaped(joint);
    let limit = own.limit_nm.map_or(String::new(), |most_nm| {
        format!(" forcelimited=\"true\" forcerange=\"{}\"", range(most_nm))
    });
    // A duty is a share: its input ends at 1.
    let control = if own.stiffness == 0.0 && own.gain != own.damping {
        " ctrllimited=\"true\" ctrlrange=\"-1.0 1.0\""
    } else {
        ""
    };
    format!(
        "<general name=\"{joint}_drive\" joint=\"{joint}\" gaintype=\"fixed\" biastype=\"affine\" \
         gainprm=\"{}\" biasprm=\"{}\"{control}{limit}/>",
        number(rounded(own.gain)),
        numbers(&[0.0, 0.0 - own.stiffness, 0.0 - own.damping].map(rounded)),
    )
}
