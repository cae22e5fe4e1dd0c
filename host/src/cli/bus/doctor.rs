//! `bus doctor`: why a servo gives no status packet. Likely causes first, each with what was seen
//! and what to do.
//!
//! It listens for an echo, pings every servo twenty times, and where no servo answers tries a CM-5's
//! firmware, other speeds and other ids. Nothing is written to any servo. Exit code 0: all is well;
//! 1: causes were found.

use super::super::Outcome;
use super::super::port::{Ids, Port, id_list};
use super::super::talk::Talk;
use handstand::Result;
use handstand::link::doctor::examine;

/// Find what is wrong.
#[derive(Debug, clap::Args)]
pub struct Args {
    #[command(flatten)]
    port: Port,
    /// Servos that should be there
    #[arg(long, default_value = "1-18", value_parser = id_list)]
    ids: Ids,
}

/// Examines, shows.
pub fn run(args: &Args, talk: &Talk) -> Result<Outcome> {
    let link = args.port.open()?;
    let bar = talk.bar();
    let diagnosis = examine(link, &args.ids.0, |step| {
        bar.set_message(step.to_string());
        bar.tick();
    })?;
    bar.finish_and_clear();
    let well = diagnosis.causes.is_empty();
    if talk.json {
        talk.data(&diagnosis)?;
    } else if well {
        talk.print(&format!(
            "All is well: {} servos answer every ping.",
            diagnosis.pings.len()
        ))?;
    } else {
        let causes = diagnosis.causes.iter().enumerate().map(|(place, cause)| {
            format!(
                "{}. {}\n   seen: {}\n   do:   {}",
                place + 1,
                cause.cause,
                cause.evidence,
                cause.remedy
            )
        });
        talk.print(&causes.collect::<Vec<_>>().join("\n"))?;
    }
    Ok(if well {
        Outcome::Done
    } else {
        Outcome::Refused
    })
}
