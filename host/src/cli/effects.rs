//! `handstand effects [NAME]`: the physical effects the library knows.
//!
//! Without a name, a line for each; with one, its page: law, values, what a log shows, what it is taken for,
//! and the experiment that tells.
//!
//! ```console
//! $ handstand effects coulomb
//! ```
//!
//! `--json` prints the descriptions: `id`, `title`, `law`, `scope`, `looks_like`, `experiment`, `reference`,
//! `parameters` (`key`, `unit`, `meaning`, `off`, `typical`, `bounds`), `confused_with` (`with`, `why`).

use super::Outcome;
use super::talk::Talk;
use handstand::Result;
use handstand::effects::{EFFECTS, EffectInfo, Parameter, Scope, glossary};
use handstand::fitting::effect_named;
use serde_json::{Value, json};

/// List and explain the physical effects of the library.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// One effect, such as `coulomb`; all of them without it
    name: Option<String>,
}

/// Prints the table or the page.
pub fn run(args: &Args, talk: &Talk) -> Result<Outcome> {
    match &args.name {
        Some(name) => {
            let effect = effect_named(name)?;
            if talk.json {
                talk.data(&info(effect.info()))?;
            } else {
                talk.print(&glossary::page(effect))?;
            }
        }
        None if talk.json => {
            let infos: Vec<Value> = EFFECTS.iter().map(|effect| info(effect.info())).collect();
            talk.data(&infos)?;
        }
        None => {
            talk.print(&glossary::overview().to_string())?;
            talk.say("`handstand effects NAME` explains one of them");
        }
    }
    Ok(Outcome::Done)
}

fn info(info: &EffectInfo) -> Value {
    let confusions = info.confused_with.iter();
    json!({
        "id": info.id,
        "title": info.title,
        "law": info.law,
        "scope": match info.scope {
            Scope::AnyJoint => "any_joint",
            Scope::DrivenJoint => "driven_joint",
            Scope::PassiveJoint => "passive_joint",
            Scope::WholeRig => "whole_rig",
        },
        "parameters": info.parameters.iter().map(parameter).collect::<Vec<_>>(),
        "looks_like": info.looks_like,
        "confused_with": confusions
            .map(|other| json!({ "with": other.with, "why": other.why }))
            .collect::<Vec<_>>(),
        "experiment": info.experiment,
        "reference": info.reference,
    })
}

/// JSON knows no infinity: an effect that is off at infinity has `off: null`, as a shape parameter has.
fn parameter(parameter: &Parameter) -> Value {
    json!({
        "key": parameter.key,
        "unit": parameter.unit,
        "meaning": parameter.meaning,
        "off": parameter.off,
        "typical": [parameter.typical.0, parameter.typical.1],
        "bounds": [parameter.bounds.0, parameter.bounds.1],
    })
}
