//! `handstand demo [--robot] [-o DIR]`: the whole loop on a virtual bench, in under a minute, or
//! with `--robot` on a virtual robot that shall balance.
//!
//! Hides an effect in a bench arm, judges its logs, compares, diagnoses, does what the diagnosis
//! advises (adds what was named, refits what is wrong), and opens the answer. Every step is a
//! command line that could be typed; they go to stderr with what they say, the last table to
//! stdout. Without `--seed` it is a bench whose effect is named; others (`--seed 1`) end ambiguous:
//! then nothing is added, and `handstand next` proposes the experiment that decides.
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
//! `--robot` closes the circle, in a few minutes: a robot hangs on simulated servos behind the
//! CM-5's firmware (its own logic in process). `--seed` draws what its owner's model has not: the
//! drives' lag, and dry friction, a dead zone or a wrong mass. A plan for that model is deployed
//! and falls or sways; the hanging robot is recorded through the firmware; what is missing is
//! diagnosed, added, and a plan for what was learned is deployed. `page.html` shows both attempts
//! side by side. The diagnosis tries lag, dead zone, friction and mass alone, on short recordings;
//! `handstand diagnose` tries all effects on the same files. Exit code 1: the robot does not stand
//! in the end.
//!
//! `--robot --json` prints `seed`, `nominal` and `learned` (`stood_s`, `stands`, `sway_rms_rad`,
//! once 2 s have passed, null if it fell before; `end`), `verdict`, `added`, `effects` (`address`,
//! `key`, `true_value`, `estimate`, `interval`), `named`.

use super::challenge::text as challenge_text;
use super::{Cli, Command, Console, ExitStatus, diagnose};
use clap::Parser as _;
use handstand::challenge::{self, ChallengeScore};
use handstand::diagnose::{Diagnosis, FittedEffect, Verdict, whole_error_rad};
use handstand::{Error, Model, Result};
use std::path::{Path, PathBuf};

/// Watch the whole loop on a virtual bench with a hidden effect.
#[derive(Debug, clap::Args)]
pub struct DemoArgs {
    /// Folder to make [default: a new one among the temporary files]
    #[arg(long, short, value_name = "DIR")]
    output: Option<PathBuf>,
    /// Seed of the bench or robot [default: 3, of the robot 2]
    #[arg(long, value_name = "N")]
    seed: Option<u64>,
    /// The effect to hide, or `none`; random without it
    #[arg(long, value_name = "NAME", conflicts_with = "robot")]
    effect: Option<String>,
    /// Balance a virtual robot, measure it, diagnose, and balance it again
    #[arg(long)]
    robot: bool,
}

/// The bench whose effect is named, and adds much.
const BENCH_SEED: u64 = 3;
/// The robot whose lag and wrong mass are found.
const ROBOT_SEED: u64 = 2;

/// Runs the loop.
pub fn run(args: &DemoArgs, console: &Console) -> Result<ExitStatus> {
    let (name, seed, takes) = if args.robot {
        ("robot", ROBOT_SEED, "one to four minutes")
    } else {
        ("bench", BENCH_SEED, "about half a minute")
    };
    let output = match &args.output {
        Some(output) => output.clone(),
        None => temporary(name)?,
    };
    let seed = args.seed.unwrap_or(seed);
    console.say(&format!(
        "This takes {takes} on a machine with two cores free."
    ));
    console.say(&format!("Everything is written to {}", output.display()));
    if args.robot {
        robot(seed, &output, console)
    } else {
        bench(args.effect.as_deref(), seed, &output, console)
    }
}

/// The files of the bench as command lines name them.
struct Files {
    folder: String,
    nominal: String,
    model: String,
    page: String,
    logs: [String; 3],
}

impl Files {
    fn of(folder: &Path) -> Files {
        let at = |name: &str| folder.join(name).to_string_lossy().into_owned();
        Files {
            folder: folder.to_string_lossy().into_owned(),
            nominal: at("nominal.toml"),
            model: at("model.toml"),
            page: at("report.html"),
            logs: ["a.csv", "b.csv", "c.csv"].map(at),
        }
    }
}

fn bench(effect: Option<&str>, seed: u64, output: &Path, console: &Console) -> Result<ExitStatus> {
    let files = Files::of(output);
    let (nominal, [a, b, c]) = (&files.nominal, &files.logs);
    let seed = seed.to_string();

    console.say("A bench arm, its model, three logs; something may be missing from the model.");
    let mut new = vec!["challenge", "new", "--seed", &seed, "-o", &files.folder];
    new.extend(effect.iter().flat_map(|effect| ["--effect", effect]));
    step(&new, console)?;
    console.say("\nAre the logs fit to be learned from?");
    step(&["log", "check", nominal, a, b, c], console)?;
    console.say("\nHow far is the model from what was measured, and where?");
    step(&["compare", nominal, a, b, c], console)?;
    console
        .say("\nWhat is missing? c.csv is held out: only the motions it predicts prove an effect.");
    let held_out = ["--holdout", c, "--report", &files.page];
    let words = [&["diagnose", nominal, a, b], &held_out[..]].concat();
    let Some(found) = diagnosed(&words, console)? else {
        return Ok(ExitStatus::Refused);
    };
    let model = improved(&found, &files, console)?;
    let end = Model::load(model.unwrap_or(nominal).as_ref())?;
    let score = challenge::score(output, &end, whole_error_rad)?;
    match model {
        Some(model) => {
            console.say("\nThe answer:");
            announce(&["challenge", "score", &files.folder, model], console);
            console.result(&score, || challenge_text(&score))?;
        }
        None => {
            console.say(&format!("\n{}", left(&found, &files)));
            console.result(&score, || opened(&found, &score))?;
        }
    }
    console.say(&format!("The page with the pictures: {}", files.page));
    Ok(ExitStatus::Done)
}

/// Does what the diagnosis advises, and compares; the better model, where it advises one.
fn improved<'a>(found: &Diagnosis, files: &'a Files, console: &Console) -> Result<Option<&'a str>> {
    let (nominal, model, [a, b, c]) = (&files.nominal, &files.model, &files.logs);
    let horizon = found.horizon_s.map(|s| s.to_string());
    let horizon: Vec<&str> = horizon.iter().flat_map(|s| ["--horizon", s]).collect();
    let effects: Vec<String> = found.effects.iter().map(FittedEffect::address).collect();
    let wrong = found.wrong_values.iter();
    let wrong: Vec<&str> = wrong.map(|wrong| wrong.fitted.path.as_str()).collect();
    let (why, mut words) = match found.verdict {
        Verdict::Named => {
            let mut words = vec!["add", nominal];
            words.extend(effects.iter().map(String::as_str));
            let why = "The model with it (`add` sets it beside the old model refitted without it)";
            (why, words)
        }
        Verdict::WrongValue => {
            let free = wrong.iter().flat_map(|path| ["--free", path]);
            let words = ["fit", nominal, a, b].into_iter().chain(free);
            ("The model with the value mended", words.collect())
        }
        _ => return Ok(None),
    };
    console.say(&format!(
        "\n{why}, and the two files side by side as they are, on the motion held out:"
    ));
    if found.verdict == Verdict::Named {
        words.extend(["--fit", a, b]);
    }
    words.extend(["--holdout", c, "-o", model]);
    words.extend(&horizon);
    if step(&words, console)? != ExitStatus::Done {
        return Ok(None);
    }
    let compare = ["compare", nominal, c, "--model", model];
    step(&[&compare[..], &horizon].concat(), console)?;
    Ok(Some(model))
}

/// Why no model was written, and what to do.
fn left(found: &Diagnosis, files: &Files) -> String {
    let [a, b, c] = &files.logs;
    match found.verdict {
        Verdict::Ambiguous => format!(
            "Several explanations do as well, so none is added. Another experiment decides; this \
             proposes one:\n$ handstand next {} {a} {b} --holdout {c}",
            files.nominal
        ),
        Verdict::Nominal | Verdict::Adequate => {
            "The model explains the logs: nothing is added.".to_string()
        }
        _ => "No explanation holds, so nothing is added.".to_string(),
    }
}

/// What was hidden, and whether the diagnosis said so.
fn opened(found: &Diagnosis, score: &ChallengeScore) -> String {
    let is_hidden = |set: &[FittedEffect]| {
        let names: Vec<String> = set.iter().map(FittedEffect::address).collect();
        score
            .hidden
            .as_ref()
            .is_some_and(|hidden| names == [hidden.as_str()])
    };
    let named = is_hidden(&found.effects)
        || (found.alternatives.iter()).any(|other| is_hidden(&other.effects));
    let explains_all = matches!(found.verdict, Verdict::Nominal | Verdict::Adequate);
    match (&score.hidden, found.verdict) {
        (None, _) if explains_all => "Nothing was hidden, and nothing was added.".to_string(),
        (None, _) => "Nothing was hidden: undecided is not an answer yet.".to_string(),
        (Some(hidden), Verdict::Ambiguous) if named => {
            format!("{hidden} was hidden: one of the explanations that these logs leave open.")
        }
        (Some(hidden), _) => format!("{hidden} was hidden, and the diagnosis does not name it."),
    }
}

/// A place for a folder that nobody else uses; it stays for the user to look into.
fn temporary(name: &str) -> Result<PathBuf> {
    let folder = tempfile::Builder::new().prefix("handstand-demo-").tempdir();
    let refused = |error| Error::file(std::env::temp_dir(), "write", error);
    Ok(folder.map_err(refused)?.keep().join(name))
}

#[cfg(feature = "virtual-cm5")]
fn robot(seed: u64, output: &Path, console: &Console) -> Result<ExitStatus> {
    super::demo_robot::run(seed, output, console)
}

#[cfg(not(feature = "virtual-cm5"))]
fn robot(_seed: u64, _output: &Path, _talk: &Console) -> Result<ExitStatus> {
    Err(super::simulated::absent())
}

/// Says a command line and runs it.
fn step(words: &[&str], console: &Console) -> Result<ExitStatus> {
    let (command, console) = parsed(words, console)?;
    command.run(&console)
}

/// Says a diagnosis's command line and runs it.
fn diagnosed(words: &[&str], console: &Console) -> Result<Option<Diagnosis>> {
    let (command, console) = parsed(words, console)?;
    match &command {
        Command::Diagnose(args) => Ok(Some(diagnose::find(args, &console)?)),
        _ => Ok(None),
    }
}

fn parsed(words: &[&str], console: &Console) -> Result<(Command, Console)> {
    let line = announce(words, console);
    let all = std::iter::once(&"handstand").chain(words);
    let cli = Cli::try_parse_from(all).map_err(|error| {
        Error::usage(
            error.to_string(),
            "name a folder that is no option: -o bench",
        )
    })?;
    let command = cli
        .command
        .ok_or_else(|| Error::usage("no command", "name one"))?;
    Ok((command, console.transcript(line)))
}

fn announce(words: &[&str], console: &Console) -> String {
    let line = format!("handstand {}", words.join(" "));
    console.say(&format!("\n$ {line}"));
    line
}
