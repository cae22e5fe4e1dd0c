//! The `[[effect]]` tables.

use super::super::limits::Limits;
use super::super::reader::Table;
use super::super::{EffectInstance, Joint};
use crate::effects::{EFFECTS, Effect, Scope};
use crate::error::Result;

pub(super) fn read(root: &Table, joints: &[Joint]) -> Result<Vec<EffectInstance>> {
    let mut effects: Vec<EffectInstance> = Vec::new();
    for table in root.tables("effect")? {
        let effect = effect(&table, joints)?;
        if effects
            .iter()
            .any(|other| other.effect == effect.effect && other.joint == effect.joint)
        {
            return Err(table.bad(
                "kind",
                format!("`{}` is there twice", effect.effect.info().id),
                "keep one of the two, or give it another joint",
            ));
        }
        effects.push(effect);
    }
    Ok(effects)
}

fn effect(table: &Table, joints: &[Joint]) -> Result<EffectInstance> {
    let kinds: Vec<(&str, &'static dyn Effect)> = EFFECTS
        .iter()
        .map(|effect| (effect.info().id, *effect))
        .collect();
    let effect = table
        .choice("kind", &kinds)?
        .ok_or_else(|| table.lacks("kind"))?;
    let info = effect.info();

    let mut known = vec!["kind", "joint", "fitted"];
    known.extend(info.parameters.iter().map(|parameter| parameter.key));
    table.only(&known)?;
    // Where its values came from: for people and reports, so any content will do.
    table.table("fitted")?;

    let joint = at(table, info.id, info.scope, joints)?;
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

/// The joint it acts on, if it acts on one.
fn at(table: &Table, id: &str, scope: Scope, joints: &[Joint]) -> Result<Option<usize>> {
    if scope == Scope::WholeRig {
        if table.has("joint") {
            let what = format!("`{id}` acts on the whole rig, not on one joint");
            return Err(table.bad_key("joint", what, "remove `joint`"));
        }
        return Ok(None);
    }
    let joint = table
        .index("joint", joints.len())?
        .ok_or_else(|| table.lacks("joint"))?;
    let driven = joints[joint].drive.is_driven();
    let wanted = match scope {
        Scope::DrivenJoint if !driven => "driven",
        Scope::PassiveJoint if driven => "passive",
        _ => return Ok(Some(joint)),
    };
    Err(table.bad(
        "joint",
        format!(
            "`{id}` acts on {wanted} joints only, and joint {} is `{}`",
            joint + 1,
            joints[joint].drive.name()
        ),
        format!("name a {wanted} joint, or remove the effect"),
    ))
}
