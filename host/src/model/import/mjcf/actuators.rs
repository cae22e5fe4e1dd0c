//! Actuators as drives of joints.

use super::Reader;
use super::defaults::Attributes;
use crate::error::Result;
use crate::model::import::tree::{LeftOut, TreeDrive};
use crate::model::import::xml::Element;

/// torque = gain u + bias0 + bias1 q + bias2 w, at most `limit_nm`.
struct Affine {
    gain: f64,
    bias: [f64; 3],
    limit_nm: Option<f64>,
    /// Whether u lies between -1 and 1.
    is_share: bool,
}

pub(super) fn read(actuators: Element, reader: &mut Reader) -> Result<()> {
    for element in actuators.elements() {
        let own = reader.defaults.attributes(element, None)?;
        let Some(joint) = own.text("joint") else {
            let why = "it moves no joint";
            reader
                .left_out
                .push(LeftOut::new(element.tag(), element.text("name"), why));
            continue;
        };
        let (drive, why) = match affine(&own)? {
            Some(affine) => drive(&affine),
            None => (
                TreeDrive::None,
                Some("no drive here is like it; the joint is passive"),
            ),
        };
        let mut joints = reader.bodies.iter_mut().flat_map(|body| &mut body.joints);
        let Some(found) = joints.find(|known| known.name == joint) else {
            return Err(element.wrong(format!("there is no joint \"{joint}\""), "mend the name"));
        };
        let second = found.drive != TreeDrive::None;
        if second {
            let why = "the joint has another, which is taken";
            reader
                .left_out
                .push(LeftOut::new(element.tag(), Some(joint), why));
            continue;
        }
        found.drive = drive;
        if let Some(why) = why {
            reader
                .left_out
                .push(LeftOut::new(element.tag(), Some(joint), why));
        }
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
    let range = |key: &str| -> Result<Option<[f64; 2]>> {
        let values = own.numbers(key)?;
        Ok(values.and_then(|values| <[f64; 2]>::try_from(values).ok()))
    };
    let force = range("forcerange")?.filter(|[low, high]| *low == -*high && *high > 0.0);
    let control = range("ctrlrange")?.filter(|[low, high]| *low == -*high && *high > 0.0);
    let plain = bias == [0.0; 3];
    let of_control = control
        .filter(|_| plain)
        .map(|[_, high]| (gain * high).abs());
    Ok(Some(Affine {
        // Seen from the joint, the actuator's length is the gear times the angle.
        gain: gear * gain,
        bias: [gear * bias[0], gear * gear * bias[1], gear * gear * bias[2]],
        limit_nm: force
            .map(|[_, high]| high)
            .or(of_control)
            .map(|limit| (gear * limit).abs()),
        is_share: control.is_some_and(|[_, high]| high == 1.0),
    }))
}

/// The drive, and what of the actuator it is not.
fn drive(affine: &Affine) -> (TreeDrive, Option<&'static str>) {
    let Affine {
        gain,
        bias,
        limit_nm,
        is_share,
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
            },
            None,
        ),
        _ => (torque.0, Some("its bias: the joint is driven by torque")),
    }
}
