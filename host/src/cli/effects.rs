//! `handstand effects [NAME]`: the physical effects the library knows.
//!
//! Without a name, a line for each; with one, its page: law, values, what a log shows, what it is
//! taken for, and the experiment that tells. A name is an id or what people call it (`stiction`,
//! `back-EMF`); a word that several are called by (`friction`), or that only their titles or laws
//! hold, lists them.
//!
//! ```console
//! $ handstand effects coulomb
//! $ handstand effects damping
//! ```
//!
//! `--json` prints the descriptions: `id`, `title`, `aliases`, `law`, `scope`, `looks_like`,
//! `experiment`, `reference`, `parameters` (`key`, `unit`, `meaning`, `off`, `typical`, `bounds`),
//! `confused_with` (`with`, `why`); one where one is meant, else a list.

use super::{Console, ExitStatus};
use handstand::Result;
use handstand::effects::{EFFECTS, Effect, NameMatch, listed, look_up};
use handstand::fitting::effect_named;
use handstand::report::effect_page;

/// List and explain the physical effects of the library.
#[derive(Debug, clap::Args)]
pub struct EffectsArgs {
    /// One effect by id or by what people call it: `coulomb`, `stiction`; all of them without it
    name: Option<String>,
}

/// Prints the table, the page, or the effects that may be meant.
pub fn run(args: &EffectsArgs, console: &Console) -> Result<ExitStatus> {
    let Some(name) = &args.name else {
        infos(EFFECTS, console, effect_page::overview)?;
        if !console.json {
            console.say("`handstand effects NAME` explains one of them");
        }
        return Ok(ExitStatus::Done);
    };
    match look_up(name) {
        NameMatch::Several(several) => choice(
            &several,
            &format!("{} effects are called `{name}`", several.len()),
            console,
        )?,
        NameMatch::Similar(similar) if similar.len() > 1 => choice(
            &similar,
            &format!(
                "no effect is called `{name}`; {} speak of it",
                similar.len()
            ),
            console,
        )?,
        _ => {
            let effect = effect_named(name)?;
            console.result(effect.info(), || effect_page::page(effect))?;
        }
    }
    Ok(ExitStatus::Done)
}

/// Lists the effects that a word may mean.
fn choice(effects: &[Effect], why: &str, console: &Console) -> Result<()> {
    infos(effects, console, || listed(effects).join("\n"))?;
    if !console.json {
        console.say(&format!(
            "{why}; `handstand effects NAME` explains one of them"
        ));
    }
    Ok(())
}

/// Descriptions for programs, or a text for people.
fn infos(effects: &[Effect], console: &Console, text: impl FnOnce() -> String) -> Result<()> {
    let infos: Vec<_> = effects.iter().map(|effect| effect.info()).collect();
    console.result(&infos, text)
}
