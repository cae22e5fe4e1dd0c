//! `handstand demo [--robot] [-o DIR]`: the whole loop on a virtual bench, in under a minute, or
//! with `--robot` on a virtual robot that shall balance.
//!
//! Hides an effect in a bench arm, judges its logs, compares, diagnoses, adds what was named, and
//! opens the answer. Every step is a command line that could be typed; they go to stderr with what
//! they say, the last table to stdout.
//!
//! ```console
//! $ handstand demo -o bench
//! ```
//!
//! Without `-o` the folder is a new one among the system's temporary files; its place is said
//! first.
//!
//! `--json` prints what `handstand challenge score --json` prints.
//!
//! `--robot` closes the circle, in under three minutes: a robot hangs on simulated servos behind the
//! CM-5's firmware (its own logic in process). `--seed` draws what its owner's model has not: the
//! drives' lag, and dry friction, a dead zone or a wrong mass. A plan for that model is deployed and
//! falls or sways; the hanging robot is recorded through the firmware; what is missing is diagnosed,
//! added, and a plan for what was learned is deployed. `page.html` shows both attempts side by side.
//! The diagnosis tries lag, dead zone, friction and mass alone, on short recordings; `handstand
//! diagnose` tries all effects on the same files. Exit code 1: the robot does not stand in the end.
//!
//! `--robot --json` prints `seed`, `nominal` and `learned` (`stood_s`, `stands`, `sway_rms_rad`, once
//! 2 s have passed, null if it fell before; `end`), `verdict`, `added`, `effects` (`address`, `key`,
//! `true_value`, `estimate`), `named`.

use super::{Cli, Command, ExitStatus, Talk, challenge, diagnose};
use clap::Parser as _;
use handstand::diagnose::FittedEffect;
use handstand::{Error, Model, Result};
use std::path::PathBuf;

/// Watch the whole loop on a virtual bench with a hidden effect.
#[derive(Debug, clap::Args)]
pub struct DemoArgs {
    /// Folder to make [default: a new one among the temporary files]
    #[arg(long, short, value_name = "DIR")]
    output: Option<PathBuf>,
    /// Seed of the bench
    #[arg(long, value_name = "N", default_value_t = 1)]
    seed: u64,
    /// The effect to hide, or `none`; random without it
    #[arg(long, value_name = "NAME", conflicts_with = "robot")]
    effect: Option<String>,
    /// Balance a virtual robot, measure it, diagnose, and balance it again
    #[arg(long)]
    robot: bool,
}

/// Runs the loop.
pub fn run(args: &DemoArgs, talk: &Talk) -> Result<ExitStatus> {
    let output = match &args.output {
        Some(output) => output.clone(),
        None => temporary(if args.robot { "robot" } else { "bench" })?,
    };
    talk.say(&format!("Everything is written to {}", output.display()));
    if args.robot {
        return robot(args.seed, &output, talk);
    }
    let at = |name: &str| output.join(name).to_string_lossy().into_owned();
    let (folder, nominal, model) = (
        output.to_string_lossy(),
        at("nominal.toml"),
        at("model.toml"),
    );
    let (a, b, c) = (&at("a.csv"), &at("b.csv"), &at("c.csv"));
    let seed = args.seed.to_string();

    talk.say("A bench arm, its model, three logs; something may be missing from the model.");
    let mut new = vec!["challenge", "new", "--seed", &seed, "-o", &folder];
    new.extend(args.effect.iter().flat_map(|effect| ["--effect", effect]));
    step(&new, talk)?;
    talk.say("\nAre the logs fit to be learned from?");
    step(&["log", "check", &nominal, a, b, c], talk)?;
    talk.say("\nHow far is the model from what was measured, and where?");
    step(&["compare", &nominal, a, b, c], talk)?;
    talk.say("\nWhat is missing? c.csv is held out: only the motions it predicts prove an effect.");
    let page = at("report.html");
    let held_out = ["--holdout", c, "--report", &page];
    let found = missing(
        &[&["diagnose", &nominal, a, b], &held_out[..]].concat(),
        talk,
    )?;
    let model = match &found {
        Some((effect, horizon)) => {
            talk.say(
                "\nThe model with it (`add` sets it beside the old model refitted without it), and \
                 the two files side by side as they are, on the motion held out:",
            );
            let horizon: Vec<&str> = horizon.iter().map(String::as_str).collect();
            let add = [
                "add",
                &nominal,
                effect,
                "--fit",
                a,
                b,
                "--holdout",
                c,
                "-o",
                &model,
            ];
            step(&[&add[..], &horizon].concat(), talk)?;
            let compare = ["compare", &nominal, c, "--model", &model];
            step(&[&compare[..], &horizon].concat(), talk)?;
            model
        }
        None => nominal,
    };
    talk.say("\nThe answer:");
    announce(&["challenge", "score", &folder, &model], talk);
    let score = handstand::challenge::score(&output, &Model::load(model.as_ref())?)?;
    if talk.json {
        talk.data(&score)?;
    } else {
        talk.print(&challenge::text(&score))?;
    }
    talk.say(&format!("The page with the pictures: {page}"));
    Ok(ExitStatus::Done)
}

/// A place for a folder that nobody else uses; it stays for the user to look into.
fn temporary(name: &str) -> Result<PathBuf> {
    let folder = tempfile::Builder::new().prefix("handstand-demo-").tempdir();
    let refused = |error| Error::file(std::env::temp_dir(), "write", error);
    Ok(folder.map_err(refused)?.keep().join(name))
}

#[cfg(feature = "virtual-cm5")]
fn robot(seed: u64, output: &std::path::Path, talk: &Talk) -> Result<ExitStatus> {
    super::demo_robot::run(seed, output, talk)
}

#[cfg(not(feature = "virtual-cm5"))]
fn robot(_seed: u64, _output: &std::path::Path, _talk: &Talk) -> Result<ExitStatus> {
    Err(super::simulated::absent())
}

/// Says a command line and runs it.
fn step(words: &[&str], talk: &Talk) -> Result<ExitStatus> {
    let (command, talk) = parsed(words, talk)?;
    command.run(&talk)
}

/// Says a diagnosis's command line and runs it; the first effect it finds, as `add` takes it, and
/// the option that asks for the same horizon.
fn missing(words: &[&str], talk: &Talk) -> Result<Option<(String, Vec<String>)>> {
    let (command, talk) = parsed(words, talk)?;
    let Command::Diagnose(args) = &command else {
        return Ok(None);
    };
    let found = diagnose::find(args, &talk)?;
    let horizon = found
        .horizon_s
        .map(|s| vec!["--horizon".to_string(), s.to_string()]);
    // Where a wrong value does as well as an effect, the bench hides the effect.
    let sets = found.alternatives.iter().map(|rival| &rival.effects);
    let mut effects = std::iter::once(&found.effects).chain(sets).flatten();
    let effect = effects.next().map(FittedEffect::address);
    Ok(effect.map(|effect| (effect, horizon.unwrap_or_default())))
}

fn parsed(words: &[&str], talk: &Talk) -> Result<(Command, Talk)> {
    let line = announce(words, talk);
    let all = std::iter::once(&"handstand").chain(words);
    let cli = Cli::try_parse_from(all).map_err(|error| {
        Error::usage(
            error.to_string(),
            "name a folder that is no option: -o bench",
        )
    })?;
    Ok((cli.command, talk.transcript(line)))
}

fn announce(words: &[&str], talk: &Talk) -> String {
    let line = format!("handstand {}", words.join(" "));
    talk.say(&format!("\n$ {line}"));
    line
}
