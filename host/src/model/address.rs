//! Reads the address of a number as people write it: `link1.mass_kg`, `coulomb@1.torque_nm`.

use super::field::{JointField, LinkField};
use super::path::ParameterPath;
use super::suggest::suggest;
use crate::effects::{self, EffectInfo};
use crate::error::Error;
use std::str::FromStr;

impl FromStr for ParameterPath {
    type Err = Error;

    /// Reads a path as [`Display`](std::fmt::Display) writes it.
    ///
    /// # Errors
    /// [`Error::Usage`] with the nearest known name.
    fn from_str(text: &str) -> Result<Self, Error> {
        let (owner, key) = text.split_once('.').ok_or_else(|| {
            Error::usage(
                format!("`{text}` names no parameter"),
                "write it as `link1.mass_kg`, `joint1.gain_per_rad` or `coulomb@1.torque_nm`",
            )
        })?;
        if let Some(index) = numbered(owner, "link") {
            let field = choose(text, key, LinkField::ALL.map(|f| (f.key(), f)))?;
            return Ok(ParameterPath::Link { index, field });
        }
        if let Some(index) = numbered(owner, "joint") {
            let field = choose(text, key, JointField::ALL.map(|f| (f.key(), f)))?;
            return Ok(ParameterPath::Joint { index, field });
        }
        effect_path(text, owner, key)
    }
}

fn effect_path(text: &str, owner: &str, key: &str) -> Result<ParameterPath, Error> {
    let (id, joint) = match owner.split_once('@') {
        Some((id, joint)) => (id, Some(joint)),
        None => (owner, None),
    };
    let infos = effects::EFFECTS.iter().map(|effect| effect.info());
    let info: &'static EffectInfo = choose(text, id, infos.map(|info| (info.id, info)))?;
    let whole_rig = info.scope == effects::Scope::WholeRig;
    let joint = match joint {
        Some(joint) if !whole_rig => {
            let joint = counted(joint).ok_or_else(|| {
                Error::usage(
                    format!("`{text}`: `{joint}` is no joint"),
                    "joints count from 1",
                )
            })?;
            Some(joint)
        }
        None if whole_rig => None,
        Some(_) => {
            return Err(Error::usage(
                format!("`{text}`: `{id}` acts on the whole rig, not on one joint"),
                format!("write `{id}.{key}`"),
            ));
        }
        None => {
            return Err(Error::usage(
                format!("`{text}` does not say at which joint"),
                format!("write `{id}@1.{key}` for the first joint"),
            ));
        }
    };
    let keys = info.parameters.iter().enumerate().map(|(i, p)| (p.key, i));
    Ok(ParameterPath::Effect {
        id: info.id,
        joint,
        parameter: choose(text, key, keys)?,
    })
}

/// The index from 0 in `link3`, if the name is of that kind.
fn numbered(owner: &str, kind: &str) -> Option<usize> {
    counted(owner.strip_prefix(kind)?)
}

/// A count from 1, written without sign or leading zero, as an index from 0.
fn counted(text: &str) -> Option<usize> {
    let plain = text.bytes().all(|b| b.is_ascii_digit()) && !text.starts_with('0');
    text.parse::<usize>()
        .ok()
        .filter(|_| plain)
        .and_then(|n| n.checked_sub(1))
}

fn choose<T>(
    text: &str,
    name: &str,
    known: impl IntoIterator<Item = (&'static str, T)>,
) -> Result<T, Error> {
    let mut names = Vec::new();
    for (known, value) in known {
        if known == name {
            return Ok(value);
        }
        names.push(known);
    }
    Err(Error::usage(
        format!("`{text}`: unknown name `{name}`"),
        suggest(name, &names),
    ))
}
