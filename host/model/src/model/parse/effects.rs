//! The `[[effect]]` tables.

use super::super::limits::Limits;
use super::super::reader::Table;
use super::super::{EffectInstance, Joint, Robot};
use crate::effects::{EFFECTS, Effect, Scope};
use crate::error::{Error, Result};
use crate::model::effect_on;

pub(super) fn read(
    root: &Table,
    joints: &[Joint],
    laws: &[Effect],
    robot: Option<&Robot>,
) -> Result<Vec<EffectInstance>> {
    let mut effects: Vec<EffectInstance> = Vec::new();
    for table in root.tables("effect")? {
        let effect = effect(&table, joints, laws, robot)?;
        let id = effect.effect.info().id;
        if robot.is_some() && !effect.effect.acts_in_space() {
            return Err(table.bad(
                "kind",
                format!("`{id}` is that of a planar chain, and this is a robot in space"),
                "remove it",
            ));
        }
        let meets = |other: &EffectInstance| other.meets(id, effect.joint, joints);
        if effects.iter().any(meets) {
            return Err(effect_twice(&table, "kind", id));
        }
        effects.push(effect);
    }
    Ok(effects)
}

/// An effect twice at one joint.
pub(super) fn effect_twice(table: &Table, key: &str, id: &str) -> Error {
    table.bad(
        key,
        format!("`{id}` is there twice"),
        "keep one of the two, or give it another joint",
    )
}

fn effect(
    table: &Table,
    joints: &[Joint],
    laws: &[Effect],
    robot: Option<&Robot>,
) -> Result<EffectInstance> {
    let kinds = EFFECTS
        .iter()
        .chain(laws)
        .map(|effect| (effect.info().id, *effect));
    let kinds: Vec<(&str, Effect)> = kinds.collect();
    let effect = table.required("kind", table.choice("kind", &kinds)?)?;
    let joint = at(table, effect, joints, robot)?;
    let id = effect.info().id;
    let effect = effect_on(effect, joint, joints).ok_or_else(|| {
        table.bad(
            "kind",
            format!("`{id}` does not act on joints that slide"),
            "name a joint that turns, or another effect",
        )
    })?;
    let info = effect.info();

    let mut known = vec!["kind", "joint", "fitted"];
    known.extend(info.parameters.iter().map(|parameter| parameter.key));
    table.only(&known)?;
    // Where its values came from: for people and reports, so any content will do.
    table.table("fitted")?;

    let values = info.parameters.iter().map(|parameter| {
        let (low, high) = parameter.bounds;
        table.required_number(parameter.key, Limits::within(low, high))
    });
    Ok(EffectInstance {
        effect,
        joint,
        values: values.collect::<Result<_>>()?,
    })
}

/// The joint it acts on; none if it acts on the whole rig, or on `"all"` driven joints.
fn at(
    table: &Table,
    effect: Effect,
    joints: &[Joint],
    robot: Option<&Robot>,
) -> Result<Option<usize>> {
    let (id, scope) = (effect.info().id, effect.info().scope);
    if scope == Scope::WholeRig {
        return if table.has("joint") {
            Err(table.bad_key(
                "joint",
                format!("`{id}` acts on the whole rig, not on one joint"),
                "leave the joint out",
            ))
        } else {
            Ok(None)
        };
    }
    if table.is_text("joint", "all") {
        let driven = joints.iter().any(|joint| joint.drive.is_driven());
        return if driven && scope != Scope::PassiveJoint {
            Ok(None)
        } else {
            Err(table.bad(
                "joint",
                format!("`{id}` acts on no driven joint of this model"),
                "name a joint, counted from 1",
            ))
        };
    }
    let names = robot.map_or(&[][..], |robot| &robot.joints);
    let named = names.iter().position(|name| table.is_text("joint", name));
    let joint = match named {
        Some(joint) => joint,
        None => table.required("joint", table.index("joint", joints.len())?)?,
    };
    let drive = &joints[joint].drive;
    let wanted = match (scope, drive.is_driven()) {
        (Scope::DrivenJoint, false) => "driven",
        (Scope::PassiveJoint, true) => "passive",
        _ => return Ok(Some(joint)),
    };
    Err(table.bad(
        "joint",
        format!(
            "`{id}` acts on {wanted} joints only, and joint {} is `{}`",
            joint + 1,
            drive.name()
        ),
        format!("name a {wanted} joint, or another effect"),
    ))
}
