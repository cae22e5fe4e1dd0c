//! `cargo xtask measured`: renews the pages of `docs/measured` that take minutes, each by the
//! command that stands on it, and names the commands of the others. With `--rows` it renews none,
//! and measures one row of each again.

use super::program::built;
use clap::builder::PossibleValuesParser;
use handstand_measure::pages::{Answer, Cost, MeasuredPage, PAGES, Programs, Sample, command};
use handstand_xtask::{program, root};
use std::path::PathBuf;
use std::process::Command;
use std::time::Instant;

/// Renew the pages of docs/measured that take minutes, and name the commands of the others.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// Renew nothing: name the commands of all
    #[arg(long)]
    list: bool,
    /// Renew nothing: measure one row of each page again, of these alone if any are named
    #[arg(long, value_name = "PAGES", num_args = 0.., value_delimiter = ',')]
    #[arg(conflicts_with = "list")]
    #[arg(value_parser = PossibleValuesParser::new(names()))]
    rows: Option<Vec<String>>,
}

fn names() -> Vec<&'static str> {
    PAGES.iter().map(|page| page.name).collect()
}

/// Whether every page that is cheap was renewed and met its targets; with `rows`, whether every row
/// is what its page says.
pub fn run(args: &Args) -> bool {
    if let Some(names) = &args.rows {
        let named = |page: &&MeasuredPage| names.is_empty() || names.iter().any(|n| n == page.name);
        return rows_hold(PAGES.iter().filter(named));
    }
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

/// Whether the row of each page is what is measured today, the dear ones too.
fn rows_hold<'a>(pages: impl Iterator<Item = &'a MeasuredPage>) -> bool {
    let (Some(handstand), Ok(measure)) = (built(), std::env::current_exe()) else {
        return false;
    };
    let programs = Programs {
        measure: &measure,
        handstand: &handstand,
    };
    let mut well = true;
    for page in pages {
        let begun = Instant::now();
        let said = match &page.sample {
            Sample::Nothing(why) => Ok(Answer::LeftOut(why)),
            _ if !file(page).exists() => Ok(Answer::LeftOut("there is no page yet")),
            Sample::Seconds(row) | Sample::Longer(_, row) => {
                text(page).and_then(|text| row.measured_again(&text, &programs))
            }
        };
        let said = match said {
            Ok(Answer::Same) => "as on the page".to_string(),
            Ok(Answer::LeftOut(why)) => format!("left out: {why}"),
            Err(why) => {
                well = false;
                why
            }
        };
        println!(
            "{}: {said} ({:.0} s)",
            page.name,
            begun.elapsed().as_secs_f64()
        );
    }
    well
}

fn file(page: &MeasuredPage) -> PathBuf {
    let folder = root().join("docs/measured");
    folder.join(page.name).with_extension("md")
}

fn text(page: &MeasuredPage) -> Result<String, String> {
    let file = file(page);
    std::fs::read_to_string(&file).map_err(|why| format!("{}: {why}", file.display()))
}

/// Words of the command that stands on a page; where there is no page yet, its chore without
/// options.
fn words(page: &MeasuredPage) -> Result<Vec<String>, String> {
    let file = file(page);
    if !file.exists() {
        return Ok(vec![page.name.into()]);
    }
    command(&text(page)?).map_err(|why| format!("{}: {why}", file.display()))
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
