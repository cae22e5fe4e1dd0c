//! `bus doctor`: why a servo gives no status packet. Likely causes first, each with what was seen
//! and what to do.
//!
//! It listens for an echo, pings every servo twenty times and reads it twenty times, and where no
//! servo answers tries a CM-5's firmware, other speeds and other ids. Nothing is written to any
//! servo. Exit code 0: all is well; 1: causes were found.
//!
//! `--bring-up` walks through the checklist of a CM-5's first power-on. What the line can tell is
//! measured; what needs instruments is asked for, and not done where there is no terminal. The
//! first of `--ids` gets a tenth of its torque and holds its position. `--json` prints each step's
//! `id`, `title`, `outcome` (`passed`, `failed`, `not_done`) and `found`.

use super::bring_up;
use crate::cli::port::{AnyLink, DEFAULT_IDS, Ids, Port, id_list, say_found};
use crate::cli::{Console, ExitStatus};
use handstand::Result;
use handstand::link::doctor::{BusDiagnosis, examine};
use std::path::PathBuf;

/// Find what is wrong.
#[derive(Debug, clap::Args)]
pub struct BusDoctorArgs {
    #[command(flatten)]
    port: Port,
    /// Servos that should be there; without, those of 1-18 from which anything comes
    #[arg(long, value_parser = id_list)]
    ids: Option<Ids>,
    /// Walk through the first power-on checklist (docs/bring-up.md) instead, with a CM-5
    #[arg(long)]
    bring_up: bool,
    /// Write what the checklist found, in Markdown
    #[arg(long, value_name = "FILE.md", requires = "bring_up")]
    report: Option<PathBuf>,
    /// Allow the first servo a tenth of its torque without asking
    #[arg(long, requires = "bring_up")]
    yes: bool,
}

/// Examines, shows.
pub fn run(args: &BusDoctorArgs, console: &Console) -> Result<ExitStatus> {
    let mut link = args.port.open()?;
    let given = args.ids.as_ref().map(|Ids(ids)| ids.clone());
    if args.bring_up {
        let report = args.report.as_deref();
        let ids = given.unwrap_or(DEFAULT_IDS.to_vec());
        return bring_up::run(link, &ids, report, args.yes, console);
    }
    let ids = match given {
        Some(ids) => ids,
        None => with_a_sign_of_life(args, &mut link, console)?,
    };
    let bar = console.bar(0);
    let diagnosis = examine(link, &ids, args.port.protocol(), |step| {
        bar.set_message(step.to_string());
        bar.tick();
    })?;
    drop(bar);
    console.result(&diagnosis, || text(&diagnosis))?;
    Ok(ExitStatus::answer(diagnosis.causes.is_empty()))
}

/// Ids from which anything comes; all that were asked where nothing does.
fn with_a_sign_of_life(
    args: &BusDoctorArgs,
    link: &mut AnyLink,
    console: &Console,
) -> Result<Vec<u8>> {
    let found = args.port.on(link).answering(&DEFAULT_IDS)?;
    say_found(&found, console);
    let mut ids = [found.ids(), found.garbled].concat();
    ids.sort_unstable();
    Ok(if ids.is_empty() {
        DEFAULT_IDS.to_vec()
    } else {
        ids
    })
}

fn text(diagnosis: &BusDiagnosis) -> String {
    let causes = diagnosis.causes.iter().zip(1..).map(|(found, number)| {
        let (cause, evidence, remedy) = (&found.cause, &found.evidence, &found.remedy);
        format!("{number}. {cause}\n   seen: {evidence}\n   do:   {remedy}")
    });
    match diagnosis.causes.len() {
        0 => format!(
            "All is well: {} servos answer every ping and reading.",
            diagnosis.pings.len()
        ),
        _ => causes.collect::<Vec<_>>().join("\n"),
    }
}
