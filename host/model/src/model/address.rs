//! Reads the address of a number as people write it: `link1.mass_kg`, `coulomb@1.torque_nm`; of a
//! robot in space by names, too: `link.boom.mass_kg`, `coulomb@luff.torque_nm`.

use super::field::{JointField, LinkField};
use super::path::ParameterPath;
use super::suggest::suggest;
use super::{Model, Robot};
use crate::effects::{self, Axis, EffectInfo};
use crate::error::{Error, Problem};
use std::str::FromStr;

impl FromStr for ParameterPath {
    type Err = Error;

    /// Reads a path as [`Display`](std::fmt::Display) writes it.
    ///
    /// # Errors
    /// [`Error::Usage`]: what of it is unknown, or no joint.
    fn from_str(text: &str) -> Result<Self, Error> {
        read(text).map_err(Problem::usage)
    }
}

impl ParameterPath {
    /// Reads an address in a model: of a robot in space `link.boom.mass_kg`,
    /// `joint.luff.gain_per_rad` and `coulomb@luff.torque_nm` name what `link2`, `joint2` and
    /// `coulomb@2` number.
    ///
    /// # Errors
    /// [`Error::Usage`]: what of it is unknown, or no joint.
    pub fn read(text: &str, model: &Model) -> Result<Self, Error> {
        read_in(text, model.robot.as_ref()).map_err(Problem::usage)
    }
}

/// An address, by numbers or by the names of a robot in space.
pub(super) fn read_in(text: &str, robot: Option<&Robot>) -> Result<ParameterPath, Problem> {
    // A name may have dots, a key has none.
    let (Some(robot), Some((owner, key))) = (robot, text.rsplit_once('.')) else {
        return read(text);
    };
    let at = |what: &str, name: &str, names: &[String]| {
        let found = names.iter().position(|own| own == name);
        let unknown = || {
            let found = format!("`{text}`: the robot has no {what} `{name}`");
            Problem::new(found, suggest(name, names))
        };
        found.map(|index| index + 1).ok_or_else(unknown)
    };
    let numbered = if let Some(name) = owner.strip_prefix("link.") {
        format!("link{}.{key}", at("link", name, &robot.links)?)
    } else if let Some(name) = owner.strip_prefix("joint.") {
        format!("joint{}.{key}", at("joint", name, &robot.joints)?)
    } else {
        match owner.split_once('@') {
            Some((id, name)) if name != "all" && counted(name).is_none() => {
                format!("{id}@{}.{key}", at("joint", name, &robot.joints)?)
            }
            _ => return read(text),
        }
    };
    read(&numbered)
}

pub(super) fn read(text: &str) -> Result<ParameterPath, Problem> {
    let (owner, key) = text.split_once('.').ok_or_else(|| {
        Problem::new(
            format!("`{text}` names no parameter"),
            "write it as `link1.mass_kg`, `joint1.gain_per_rad` or `coulomb@1.torque_nm`",
        )
    })?;
    if let Some(index) = owner.strip_prefix("link").and_then(counted) {
        let field = choose(text, key, LinkField::ALL.map(|f| (f.key(), f)))?;
        return Ok(ParameterPath::Link { index, field });
    }
    if let Some(index) = owner.strip_prefix("joint").and_then(counted) {
        let field = choose(text, key, JointField::ALL.map(|f| (f.key(), f)))?;
        return Ok(ParameterPath::Joint { index, field });
    }
    let (id, joint) = match owner.split_once('@') {
        Some((id, joint)) => (id, Some(joint)),
        None => (owner, None),
    };
    let defined = effects::expression::defined();
    let all = effects::EFFECTS.iter().chain(&defined).copied();
    let effect = choose(text, id, all.map(|effect| (effect.info().id, effect)))?;
    let joint = joint_of([text, key], effect.info(), joint)?;
    let axes = [Axis::Hinge, Axis::Slide].into_iter();
    let keys = axes.filter_map(|axis| effect.on(axis)).flat_map(|effect| {
        let parameters = effect.info().parameters.iter().enumerate();
        parameters.map(move |(i, p)| (p.key, (effect, i)))
    });
    let mut known: Vec<(&str, _)> = Vec::new();
    for (key, value) in keys {
        if known.iter().all(|(known, _)| *known != key) {
            known.push((key, value));
        }
    }
    let (effect, parameter) = choose(text, key, known)?;
    Ok(ParameterPath::at(effect, joint, parameter))
}

/// The joint named behind the `@`, as the effect's scope allows.
fn joint_of(
    [text, key]: [&str; 2],
    info: &EffectInfo,
    joint: Option<&str>,
) -> Result<Option<usize>, Problem> {
    let id = info.id;
    match (joint, info.scope == effects::Scope::WholeRig) {
        (None, true) | (Some("all"), false) => Ok(None),
        (None, false) => Err(Problem::new(
            format!("`{text}` does not say at which joint"),
            format!("write `{id}@1.{key}` for the first joint"),
        )),
        (Some(_), true) => Err(Problem::new(
            format!("`{text}`: `{id}` acts on the whole rig, not on one joint"),
            format!("write `{id}.{key}`"),
        )),
        (Some(joint), false) => match counted(joint) {
            Some(index) => Ok(Some(index)),
            None => Err(Problem::new(
                format!("`{text}`: `{joint}` is no joint"),
                "joints count from 1; `all` are the driven ones",
            )),
        },
    }
}

/// A count from 1, written without sign or leading zero, as an index from 0.
fn counted(text: &str) -> Option<usize> {
    let plain = text.bytes().all(|b| b.is_ascii_digit()) && !text.starts_with('0');
    let count = text.parse::<usize>().ok().filter(|_| plain)?;
    count.checked_sub(1)
}

fn choose<T>(
    text: &str,
    name: &str,
    known: impl IntoIterator<Item = (&'static str, T)>,
) -> Result<T, Problem> {
    let mut names = Vec::new();
    for (known, value) in known {
        if known == name {
            return Ok(value);
        }
        names.push(known);
    }
    let found = format!("`{text}`: unknown name `{name}`");
    Err(Problem::new(found, suggest(name, &names)))
}
