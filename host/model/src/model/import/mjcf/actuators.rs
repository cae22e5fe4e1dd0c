//! Actuators as drives of joints.

use super::Reader;
use super::defaults::Attributes;
use super::option::Options;
use super::orientation::Compiler;
use crate::error::{Error, Result};
use crate::model::import::remark::Remark;
use crate::model::import::tree::{Fault, FaultyPart, TreeDrive, TreeJoint};
use crate::model::import::xml::Element;

/// Attributes that are read, or say nothing of an actuator at a joint without dynamics of its own.
const READ: [&str; 26] = [
    "actdim",
    "actearly",
    "actlimited",
    "actrange",
    "biasprm",
    "biastype",
    "class",
    "ctrllimited",
    "ctrlrange",
    "dampratio",
    "dynprm",
    "dyntype",
    "forcelimited",
    "forcerange",
    "gainprm",
    "gaintype",
    "gear",
    "group",
    "joint",
    "jointinparent",
    "kp",
    "kv",
    "lengthrange",
    "name",
    "timeconst",
    "user",
];

/// torque = gain u + bias0 + bias1 q + bias2 w, at most `limit_nm`.
struct Affine {
    gear: f64,
    gain: f64,
    bias: [f64; 3],
    limit_nm: Option<f64>,
    limited_by: &'static str,
    /// Whether u lies between -1 and 1.
    is_share: bool,
}

/// A range that limits both ways alike: so much, or not at all; or why a limit here is not like it.
pub(super) fn symmetric(
    element: Element,
    key: &str,
    text: &str,
) -> Result<std::result::Result<Option<f64>, String>> {
    let ends: Vec<&str> = text.split_whitespace().collect();
    let [low, high] = ends[..] else {
        return Err(element.wrong(format!("{key} has {} numbers", ends.len()), "write two"));
    };
    let ends = (element.limit_of(key, low)?, element.limit_of(key, high)?);
    Ok(match ends {
        // Not given, as in MuJoCo.
        (Some(0.0), Some(0.0)) | (None, None) => Ok(None),
        (Some(low), Some(high)) if low == -high && high > 0.0 => Ok(Some(high)),
        _ => Err(format!(
            "from {low} to {high}; a limit here is the same both ways, so none is taken"
        )),
    })
}

pub(super) fn read(actuators: Element, reader: &mut Reader) {
    for element in actuators.elements() {
        if let Err((body, error)) = one(element, reader) {
            reader
                .faults
                .push(Fault::new(body, FaultyPart::Joint, &error));
        }
    }
}

/// Reads an actuator; what is wrong with it, and the body of its joint.
fn one(element: Element, reader: &mut Reader) -> std::result::Result<(), (usize, Error)> {
    let line = element.line();
    let mut leave = |name: Option<&str>, why: &str| {
        let remark = Remark::new(element.tag(), name, why);
        reader.left_out.push(remark.on(line));
    };
    // A class that is not there is no fault of a joint.
    let own = match reader.defaults.attributes(element, None) {
        Ok(own) => own,
        Err(error) => {
            leave(element.text("name"), &error.to_string());
            return Ok(());
        }
    };
    let Some(name) = own.text("joint").or(own.text("jointinparent")) else {
        leave(element.text("name"), "it moves no joint");
        return Ok(());
    };
    let has = |joint: &TreeJoint| joint.name == name;
    let bodies = &mut reader.bodies;
    let Some(body) = bodies.iter().position(|body| body.joints.iter().any(has)) else {
        leave(
            element.text("name"),
            &format!("there is no joint \"{name}\""),
        );
        return Ok(());
    };
    let group = own.text("group").unwrap_or("0");
    let is_off =
        !reader.options.actuation || reader.options.groups_off.iter().any(|off| off == group);
    for joint in bodies[body].joints.iter_mut().filter(|joint| has(joint)) {
        if is_off {
            joint.leave(element.tag(), line, "<option> switches it off");
            continue;
        }
        if joint.drive != TreeDrive::None {
            joint.leave(element.tag(), line, "the joint has another, which is taken");
            continue;
        }
        let settings = (&reader.compiler, &reader.options);
        take(&own, settings, joint).map_err(|error| (body, error))?;
    }
    Ok(())
}

/// Gives a joint the drive that an actuator is.
fn take(
    own: &Attributes,
    (compiler, options): (&Compiler, &Options),
    joint: &mut TreeJoint,
) -> Result<()> {
    let (tag, line) = (own.element.tag(), own.element.line());
    joint.actuator_at = Some(own.element.at());
    let Some(mut affine) = affine(own)? else {
        joint.leave(tag, line, "no drive here is like it; the joint is passive");
        return Ok(());
    };
    let mut range = |key: &'static str, limited: &str| -> Result<Option<f64>> {
        let Some(text) = own.text(key).filter(|_| compiler.limits(own, limited)) else {
            return Ok(None);
        };
        let limit = symmetric(own.element, key, text)?;
        Ok(limit.unwrap_or_else(|why| {
            joint.leave(key, line, why);
            None
        }))
    };
    let gear = affine.gear;
    let force = range("forcerange", "forcelimited")?.map(|most| (gear * most).abs());
    let control = if options.clamps {
        range("ctrlrange", "ctrllimited")?
    } else {
        None
    };
    affine.is_share = control == Some(1.0);
    let is_plain = affine.bias == [0.0; 3];
    let of_control = control.map(|most| (affine.gain * most).abs());
    for (limit, by) in [
        (force, "forcerange"),
        (of_control.filter(|_| is_plain), "ctrlrange"),
        (joint.most_nm, "actuatorfrcrange"),
    ] {
        if let Some(limit) = limit.filter(|own| affine.limit_nm.is_none_or(|least| *own < least)) {
            (affine.limit_nm, affine.limited_by) = (Some(limit), by);
        }
    }
    let (drive, why) = drive(&affine);
    let is_duty = matches!(drive, TreeDrive::Duty { .. });
    if control.is_some() && !is_plain && !is_duty {
        joint.leave(
            "ctrlrange",
            line,
            "what is asked of a drive here has no limit",
        );
    }
    (joint.drive, joint.limited_by) = (drive, (affine.limited_by, line));
    if let Some(why) = why {
        joint.leave(tag, line, why);
    }
    for key in own.others(&READ) {
        joint.leave(key, line, "an attribute that is not read");
    }
    Ok(())
}

fn affine(own: &Attributes) -> Result<Option<Affine>> {
    let number = |key: &str, without: f64| -> Result<f64> {
        let values = own.numbers(key)?;
        Ok(values
            .and_then(|values| values.first().copied())
            .unwrap_or(without))
    };
    let is = |key: &str, value: &str| own.text(key).is_none_or(|text| text == value);
    let list = |key: &str| own.numbers(key).map(Option::unwrap_or_default);
    let at = |values: &[f64], index: usize| values.get(index).copied().unwrap_or(0.0);
    let kp = number("kp", 1.0)?;
    let (gain, bias) = match own.element.tag() {
        "motor" => (1.0, [0.0; 3]),
        "position" if own.number("dampratio")?.is_none_or(|ratio| ratio == 0.0) => {
            (kp, [0.0, -kp, -number("kv", 0.0)?])
        }
        "velocity" => {
            let kv = number("kv", 1.0)?;
            (kv, [0.0, 0.0, -kv])
        }
        "general" if is("dyntype", "none") && is("gaintype", "fixed") => {
            let bias = list("biasprm")?;
            let gain = list("gainprm")?;
            let gain = if own.text("gainprm").is_some() {
                at(&gain, 0)
            } else {
                1.0
            };
            match own.text("biastype").unwrap_or("none") {
                "none" => (gain, [0.0; 3]),
                "affine" => (gain, [at(&bias, 0), at(&bias, 1), at(&bias, 2)]),
                _ => return Ok(None),
            }
        }
        _ => return Ok(None),
    };
    if number("timeconst", 0.0)? != 0.0 {
        return Ok(None);
    }
    let gear = number("gear", 1.0)?;
    Ok(Some(Affine {
        gear,
        // Seen from the joint, the actuator's length is the gear times the angle.
        gain: gear * gain,
        bias: [gear * bias[0], gear * gear * bias[1], gear * gear * bias[2]],
        limit_nm: None,
        limited_by: "",
        is_share: false,
    }))
}

/// The drive, and what of the actuator it is not.
fn drive(affine: &Affine) -> (TreeDrive, Option<&'static str>) {
    let Affine {
        gain,
        bias,
        limit_nm,
        is_share,
        ..
    } = *affine;
    let torque = (TreeDrive::Torque(limit_nm), None);
    match bias {
        [0.0, 0.0, 0.0] if gain == 1.0 => torque,
        [0.0, 0.0, 0.0] => (
            torque.0,
            Some("gear and gain: the drive's input is the joint's torque in N m"),
        ),
        [0.0, stiffness, damping] if stiffness < 0.0 && damping <= 0.0 => match limit_nm {
            Some(limit_nm) if (gain + stiffness).abs() <= 1e-12 * gain.abs() => (
                TreeDrive::Position {
                    stiffness_nm: gain,
                    damping_nm_s: -damping,
                    limit_nm,
                },
                Some("a limit of the whole torque: here the duty alone stops at 1"),
            ),
            Some(limit_nm) => (
                TreeDrive::Position {
                    stiffness_nm: -stiffness,
                    damping_nm_s: -damping,
                    limit_nm,
                },
                Some("gear: the drive's input is the joint's goal angle in rad"),
            ),
            None => (
                torque.0,
                Some("a position actuator without forcerange: its joint is driven by torque"),
            ),
        },
        [0.0, 0.0, damping] if damping < 0.0 && (gain + damping).abs() <= 1e-12 * gain.abs() => {
            match limit_nm {
                Some(limit_nm) => (
                    TreeDrive::Speed {
                        gain_nm_s: gain,
                        limit_nm,
                    },
                    Some("a limit of the whole torque: here the duty alone stops at 1"),
                ),
                None => (
                    torque.0,
                    Some("a velocity actuator without forcerange: its joint is driven by torque"),
                ),
            }
        }
        [0.0, 0.0, damping] if damping < 0.0 && gain > 0.0 && is_share => (
            TreeDrive::Duty {
                stall_nm: gain,
                damping_nm_s: -damping,
                limit_nm,
            },
            None,
        ),
        _ => (torque.0, Some("its bias: the joint is driven by torque")),
    }
}
