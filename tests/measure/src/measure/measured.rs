//! `cargo xtask measured`: renews the pages of `docs/measured` that take minutes, each by the
//! command that stands on it, and names the commands of the others.

use handstand_measure::pages::{Cost, MeasuredPage, PAGES, command};
use handstand_xtask::{program, root};
use std::process::Command;
use std::time::Instant;

/// Renew the pages of docs/measured that take minutes, and name the commands of the others.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// Renew nothing: name the commands of all
    #[arg(long)]
    list: bool,
}

/// Whether every page that is cheap was renewed and met its targets.
pub fn run(args: &Args) -> bool {
    let is_renewed = |page: &&MeasuredPage| page.cost == Cost::Cheap && !args.list;
    let (renewed, named): (Vec<_>, Vec<_>) = PAGES.iter().partition(is_renewed);
    let failed: Vec<&str> = renewed
        .into_iter()
        .filter(|page| !renew(page))
        .map(|page| page.name)
        .collect();
    if !args.list {
        println!("\nNot renewed, for it takes longer:");
    }
    for page in named {
        println!("{}", line(page));
    }
    if !failed.is_empty() {
        eprintln!("\nThese failed, or missed a target: {}", failed.join(", "));
    }
    failed.is_empty()
}

/// Words of the command that stands on a page; where there is no page yet, its chore without
/// options.
fn words(page: &MeasuredPage) -> Result<Vec<String>, String> {
    let file = root()
        .join("docs/measured")
        .join(page.name)
        .with_extension("md");
    if !file.exists() {
        return Ok(vec![page.name.into()]);
    }
    let text = std::fs::read_to_string(&file);
    text.map_err(|error| error.to_string())
        .and_then(|text| command(&text))
        .map_err(|why| format!("{}: {why}", file.display()))
}

fn renew(page: &MeasuredPage) -> bool {
    let begun = Instant::now();
    let run = words(page).and_then(|words| {
        let own = std::env::current_exe().map_err(|error| error.to_string())?;
        Ok(program::run(Command::new(own).args(words).arg("--write")))
    });
    let well = run.unwrap_or_else(|why| {
        eprintln!("{why}");
        false
    });
    println!("{}: {:.0} s", page.name, begun.elapsed().as_secs_f64());
    well
}

/// A page, the command that renews it and how long that takes.
fn line(page: &MeasuredPage) -> String {
    let typed = || match words(page) {
        Ok(words) => format!("cargo xtask {} --write", words.join(" ")),
        Err(why) => why,
    };
    let (command, takes) = match page.cost {
        Cost::Cheap => (typed(), "minutes"),
        Cost::Dear(takes) => (typed(), takes),
        Cost::Script(takes, script) => (script.to_string(), takes),
    };
    format!("{}: {command} ({takes})", page.name)
}
