//! `bus doctor`: why a servo gives no status packet. Likely causes first, each with what was seen
//! and what to do.
//!
//! It listens for an echo, pings every servo twenty times, and where no servo answers tries a
//! CM-5's firmware, other speeds and other ids. Nothing is written to any servo. Exit code 0: all
//! is well; 1: causes were found.

use crate::cli::port::{Ids, Port, id_list};
use crate::cli::{ExitStatus, Talk};
use handstand::Result;
use handstand::link::doctor::{BusDiagnosis, examine};

/// Find what is wrong.
#[derive(Debug, clap::Args)]
pub struct DoctorArgs {
    #[command(flatten)]
    port: Port,
    /// Servos that should be there
    #[arg(long, default_value = "1-18", value_parser = id_list)]
    ids: Ids,
}

/// Examines, shows.
pub fn run(args: &DoctorArgs, talk: &Talk) -> Result<ExitStatus> {
    let link = args.port.open()?;
    let bar = talk.bar(0);
    let diagnosis = examine(link, &args.ids.0, |step| {
        bar.set_message(step.to_string());
        bar.tick();
    })?;
    drop(bar);
    talk.result(&diagnosis, || text(&diagnosis))?;
    Ok(ExitStatus::answer(diagnosis.causes.is_empty()))
}

fn text(diagnosis: &BusDiagnosis) -> String {
    let causes = diagnosis.causes.iter().zip(1..).map(|(found, number)| {
        let (cause, evidence, remedy) = (&found.cause, &found.evidence, &found.remedy);
        format!("{number}. {cause}\n   seen: {evidence}\n   do:   {remedy}")
    });
    match diagnosis.causes.len() {
        0 => format!(
            "All is well: {} servos answer every ping.",
            diagnosis.pings.len()
        ),
        _ => causes.collect::<Vec<_>>().join("\n"),
    }
}
