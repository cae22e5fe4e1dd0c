//! What of a model its robot's exported file does not hold: it is read again and compared.

use super::actuators::Law;
use super::{Pair, is_near};
use crate::dynamics::SpatialTree;
use crate::effects::Scope;
use crate::model::export::NotCarried;
use crate::model::{Drive, EffectInstance};

/// Why a value that the format has is not in the file as it is in the model.
pub(super) const OTHERWISE: &str =
    "the robot's file sets it in another way, as by <compiler> or <option>";

/// Every part of the model that a model of the exported file lacks or has otherwise.
pub(super) fn lacking(read: &Pair, format: &'static str) -> Vec<NotCarried> {
    let mut missing = Vec::new();
    let robot = read.own.robot.as_ref();
    for (name, at) in robot.iter().flat_map(|robot| &robot.locked) {
        missing.push(NotCarried::new(
            format!("lock of {name}"),
            None,
            format!("it is held at {at} here and stays a joint of the file"),
        ));
    }
    bodies(&mut missing, read, format);
    for effect in &read.own.effects {
        missing.extend(effect_lacks(effect, read, format));
    }
    for joint in 0..read.own.joints.len() {
        drive_lacks(&mut missing, joint, read, format);
        remains(&mut missing, joint, read);
    }
    for part in &mut missing {
        let name = part.joint.and_then(|joint| read.own.joint_name(joint - 1));
        part.joint_name = name.map(str::to_string);
    }
    missing
}

/// Gravity, masses, centres of mass, moments of inertia.
fn bodies(missing: &mut Vec<NotCarried>, read: &Pair, format: &str) {
    let (Some(own), Some(file)) = (read.own.rig(false).tree, read.free.tree()) else {
        return;
    };
    if !is_near(own.gravity_m_s2.norm(), file.gravity_m_s2.norm()) {
        let why = match format {
            "urdf" => "gravity is the simulator's",
            _ => OTHERWISE,
        };
        missing.push(NotCarried::new("gravity_m_s2", None, why));
    }
    let SpatialTree { links, .. } = own;
    for (index, (own, file)) in links.iter().zip(&file.links).enumerate() {
        let off = |own: f64, file: f64| !is_near(own, file);
        let far = (own.com_m - file.com_m).norm() > super::NEAR * own.com_m.norm().max(1e-3);
        let turned = (own.inertia_kg_m2 - file.inertia_kg_m2).norm();
        let heavy = turned > super::NEAR * own.inertia_kg_m2.norm().max(1e-12);
        for (part, is_off) in [
            ("mass_kg", off(own.mass_kg, file.mass_kg)),
            ("com_m", far),
            ("inertia_kg_m2", heavy),
        ] {
            if is_off {
                let why = if file.mass_kg == 0.0 {
                    "the link has no mass in the robot's file: give it an <inertial> there"
                } else {
                    OTHERWISE
                };
                missing.push(NotCarried::new(part, Some(index + 1), why));
            }
        }
    }
}

/// An effect, where the file's model has none of these values at some joint.
fn effect_lacks(own: &EffectInstance, read: &Pair, format: &str) -> Option<NotCarried> {
    let id = own.effect.info().id;
    // It is in the masses.
    if id == "mass" {
        return None;
    }
    let held = |joint: usize| {
        let mut there = read.file(joint).effects_at(joint);
        there.any(|other| other.effect.info().id == id && are_near(&own.values, &other.values))
    };
    let joints = &read.own.joints;
    let acts = |joint: &usize| own.acts_on(*joint, &joints[*joint]);
    let is_held =
        own.effect.info().scope != Scope::WholeRig && (0..joints.len()).filter(acts).all(held);
    let why = match (id, format) {
        ("viscous" | "coulomb", _) | ("cable_spring" | "armature", "mjcf") => OTHERWISE,
        ("torque_saturation", "urdf") => "its joint has no <limit> in the robot's file",
        ("torque_saturation", _) => OTHERWISE,
        (_, "urdf") => "URDF has no place for it",
        _ => "no element of MJCF is written for it",
    };
    (!is_held).then(|| NotCarried::new(id, own.joint.map(|joint| joint + 1), why))
}

fn drive_lacks(missing: &mut Vec<NotCarried>, joint: usize, read: &Pair, format: &'static str) {
    let drive = &read.own.joints[joint].drive;
    let file = read.file(joint);
    let mut lacks = |part: &str, why: &'static str| {
        missing.push(NotCarried::new(part.to_string(), Some(joint + 1), why));
    };
    let same = match (Law::at(read.own, joint), Law::at(file, joint)) {
        (Some(own), Some(file)) => own.acts_as(&file),
        (own, file) => own.is_none() && file.is_none(),
    };
    if !same || drive.name() != file.joints[joint].drive.name() {
        let why = match (format, drive) {
            (_, Drive::Passive) => "the drive of the robot's file stays",
            ("urdf", _) => "URDF has no drives",
            _ => "no actuator of the robot's file does what it does",
        };
        lacks(drive.name(), why);
        return;
    }
    if let Some(motor) = drive.motor() {
        let other = file.joints[joint].drive.motor();
        if other.is_none_or(|other| !is_near(motor.stall_torque_nm, other.stall_torque_nm)) {
            lacks("stall_torque_nm", OTHERWISE);
        }
        if motor.nominal_supply_v.is_some() {
            lacks("nominal_supply_v", "MuJoCo's actuators know no supply");
        }
    }
    if matches!(drive, Drive::Position { .. } | Drive::Speed { .. }) {
        let why = "the limit of the duty: MuJoCo limits the torque, back-EMF included";
        lacks(drive.name(), why);
    }
}

/// What acts on a joint in the file and not in the model.
fn remains(missing: &mut Vec<NotCarried>, joint: usize, read: &Pair) {
    for effect in read.file(joint).effects_at(joint) {
        let id = effect.effect.info().id;
        if !read.own.has_effect(id, Some(joint)) {
            let why = "the model has none, and that of the robot's file stays";
            missing.push(NotCarried::new(id, Some(joint + 1), why));
        }
    }
}

fn are_near(own: &[f64], other: &[f64]) -> bool {
    own.len() == other.len()
        && own
            .iter()
            .zip(other)
            .all(|(own, other)| is_near(*own, *other))
}
