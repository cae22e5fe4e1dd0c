//! Effects as people name them: `coulomb`, `coulomb@2`.

use handstand::diagnose::Candidate;
use handstand::effects::{EFFECTS, Effect, Scope};
use handstand::{Error, Model, Result};

/// The effect of this name.
///
/// # Errors
/// [`Error::Usage`] with the nearest name.
pub fn effect(name: &str) -> Result<&'static dyn Effect> {
    let found = EFFECTS
        .iter()
        .copied()
        .find(|effect| effect.info().id == name);
    found.ok_or_else(|| {
        let remedy = match nearest(name) {
            Some(near) => format!("did you mean `{near}`? `handstand effects` lists all"),
            None => "`handstand effects` lists all".to_string(),
        };
        Error::usage(format!("there is no effect `{name}`"), remedy)
    })
}

fn nearest(name: &str) -> Option<&'static str> {
    let ids = EFFECTS.iter().map(|effect| effect.info().id);
    ids.map(|id| (strsim::jaro_winkler(name, id), id))
        .filter(|(likeness, _)| *likeness > 0.7)
        .max_by(|a, b| a.0.total_cmp(&b.0))
        .map(|(_, id)| id)
}

/// The effect at the joint that `name` says, if the model has room for it. Where there is only one joint it
/// need not be named.
///
/// # Errors
/// [`Error::Usage`] for an unknown effect, a joint that is not there or does not suit it, or an effect the
/// model holds already.
pub fn candidate(name: &str, model: &Model) -> Result<Candidate> {
    let (id, at) = match name.split_once('@') {
        Some((id, at)) => (id, Some(at)),
        None => (name, None),
    };
    let effect = effect(id)?;
    let candidate = Candidate {
        effect,
        joint: joint(effect, at, model)?,
    };
    if candidate.in_model(model) {
        return Err(Error::usage(
            format!("the model holds `{candidate}` already"),
            "refit its values with `handstand fit`",
        ));
    }
    Ok(candidate)
}

fn joint(effect: &dyn Effect, at: Option<&str>, model: &Model) -> Result<Option<usize>> {
    let (id, scope, count) = (effect.info().id, effect.info().scope, model.link_count());
    let joint = match (scope, at) {
        (Scope::WholeRig, None) => return Ok(None),
        (Scope::WholeRig, Some(_)) => {
            return Err(Error::usage(
                format!("`{id}` acts on the whole rig, not on one joint"),
                format!("write `{id}`"),
            ));
        }
        (_, None) if count == 1 => 0,
        (_, None) => {
            return Err(Error::usage(
                format!("`{id}` acts on one joint, and the model has {count}"),
                format!("say which: `{id}@1` to `{id}@{count}`"),
            ));
        }
        (_, Some(at)) => match at.parse::<usize>() {
            Ok(joint) if (1..=count).contains(&joint) => joint - 1,
            _ => {
                return Err(Error::usage(
                    format!("there is no joint `{at}`"),
                    format!("joints of this model count from 1 to {count}"),
                ));
            }
        },
    };
    let driven = model.joints[joint].drive.is_driven();
    match scope {
        Scope::DrivenJoint if !driven => Err(unsuited(id, "driven", joint, model)),
        Scope::PassiveJoint if driven => Err(unsuited(id, "passive", joint, model)),
        _ => Ok(Some(joint)),
    }
}

fn unsuited(id: &str, wanted: &str, joint: usize, model: &Model) -> Error {
    let drive = model.joints[joint].drive.name();
    Error::usage(
        format!(
            "`{id}` acts on {wanted} joints only, and joint {} is `{drive}`",
            joint + 1
        ),
        format!("name a {wanted} joint, or another effect"),
    )
}
