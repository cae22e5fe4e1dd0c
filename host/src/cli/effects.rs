//! `handstand effects [NAME]`: the physical effects the library knows.
//!
//! Without a name, a line for each; with one, its page: law, values, what a log shows, what it is
//! taken for, and the experiment that tells.
//!
//! ```console
//! $ handstand effects coulomb
//! ```
//!
//! `--json` prints the descriptions: `id`, `title`, `law`, `scope`, `looks_like`, `experiment`,
//! `reference`, `parameters` (`key`, `unit`, `meaning`, `off`, `typical`, `bounds`),
//! `confused_with` (`with`, `why`).

use super::{ExitStatus, Talk};
use handstand::Result;
use handstand::effects::EFFECTS;
use handstand::fitting::effect_named;
use handstand::report::effect_page;

/// List and explain the physical effects of the library.
#[derive(Debug, clap::Args)]
pub struct EffectsArgs {
    /// One effect, such as `coulomb`; all of them without it
    name: Option<String>,
}

/// Prints the table or the page.
pub fn run(args: &EffectsArgs, talk: &Talk) -> Result<ExitStatus> {
    match &args.name {
        Some(name) => {
            let effect = effect_named(name)?;
            if talk.json {
                talk.data(effect.info())?;
            } else {
                talk.print(&effect_page::page(effect))?;
            }
        }
        None if talk.json => {
            let infos = EFFECTS.iter().map(|effect| effect.info());
            talk.data(&infos.collect::<Vec<_>>())?;
        }
        None => {
            talk.print(&effect_page::overview())?;
            talk.say("`handstand effects NAME` explains one of them");
        }
    }
    Ok(ExitStatus::Done)
}
