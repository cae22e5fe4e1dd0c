//! `handstand discover MODEL LOG... [--holdout LOG]...`: the law that the model lacks, where no
//! effect of the library explains it.
//!
//! Where `diagnose` ends in `unexplained`, the torque that is missing may still follow from what is
//! measured. Some fifty terms in a joint's angle, speed, load, input, supply and time (powers,
//! springs about a place, detents, ripples, thresholds; frictions that hold at rest) are tried
//! alone and in twos (`--terms 3`: in threes), fitted to the trajectories with the model's free values, and
//! judged on motions that took no part in the fit, like effects that have a name. What is left out
//! is what a law of one instant cannot say: what was before, and bodies that are not measured.
//!
//! ```console
//! $ handstand discover arm.toml a.csv b.csv --holdout c.csv -o better.toml
//! ```
//!
//! `-o` writes the model with the law: an `[[expression]]` and an `[[effect]]` per term, with
//! intervals. `compare`, `fit` and `diagnose` use it as any other effect.
//!
//! The verdict is `found`, `ambiguous` (several laws leave as little), `partial`, `not_found`,
//! `nothing_missing`, `wrong_value` or `unfit`; exit code 1 for `not_found` and `unfit`, and
//! where `-o` asks for a model and there is none to write. `--json` prints it; its keys are in
//! `docs/json.md`.

use super::diagnose::until_stopped;
use super::page::{self, PageFile};
use super::{Console, ExitStatus, input};
use handstand::compare::compare_all;
use handstand::diagnose::DiagnoseOptions;
use handstand::diagnose::conventions::ModelFile;
use handstand::discover::{Discovery, DiscoveryVerdict, LogDiscovery, MOST_TERMS, discover_logs};
use handstand::fitting::{Addition, Horizon};
use handstand::log::{LogRequest, read};
use handstand::model::{JointNames, edit::moved};
use handstand::output;
use handstand::report::{Report, discovery_json, discovery_text, html_with, law_section};
use handstand::{Model, Result};
use serde_json::json;
use std::path::PathBuf;

/// Discover the law that a model and the library lack, as an expression.
#[derive(Debug, clap::Args)]
#[command(mut_arg("force", |arg| arg.help("Replace page and model if they exist")))]
pub struct DiscoverArgs {
    /// Model file
    model: PathBuf,
    /// Logs to learn from
    #[arg(required = true, value_name = "LOG", value_parser = input::log)]
    logs: Vec<LogRequest>,
    /// Write the model with the law
    #[arg(long, short, value_name = "NEW.toml")]
    output: Option<PathBuf>,
    /// Most terms of the law
    #[arg(long, value_name = "N", default_value_t = MOST_TERMS as u8)]
    #[arg(value_parser = clap::value_parser!(u8).range(1..=3))]
    terms: u8,
    /// Value of the file that was measured by itself, and is right
    #[arg(long, value_name = "PATH")]
    known: Vec<String>,
    /// Seed of the random draws
    #[arg(long, value_name = "N")]
    seed: Option<u64>,
    /// Time that it may take, log check and judging included: `60s`, `2min`
    #[arg(long, value_name = "TIME", value_parser = input::duration_s)]
    within: Option<f64>,
    #[command(flatten)]
    judging: input::HoldoutArgs,
    #[command(flatten)]
    page: PageFile,
}

/// Discovers, prints, writes the page and the model.
pub fn run(args: &DiscoverArgs, console: &Console) -> Result<ExitStatus> {
    args.page.vacant()?;
    if let Some(file) = &args.output {
        output::vacant(file, args.page.is_forced())?;
    }
    let text = input::model_text(&args.model)?;
    let model = Model::parse(&text, &args.model)?;
    input::tell_joints(&model, console);
    let found = found(&model, &text, args, console)?;
    let written = write(&found, &text, args, console)?;
    let lacks_model = args.output.is_some() && written.is_none();
    print(&found.discovery, &model, written, console)?;
    args.page.write(|| report(&found, args, console), console)?;
    use DiscoveryVerdict as V;
    let is_answer = !matches!(found.discovery.verdict, V::NotFound | V::Unfit);
    Ok(ExitStatus::answer(is_answer && !lacks_model))
}

fn found(
    model: &Model,
    text: &str,
    args: &DiscoverArgs,
    console: &Console,
) -> Result<LogDiscovery> {
    let defaults = DiagnoseOptions::default();
    let options = DiagnoseOptions {
        seed: args.seed.unwrap_or(defaults.seed),
        known: input::known(model, &args.known)?,
        horizon: args.judging.run.horizon,
        within_s: args.within,
        most_effects: args.terms.into(),
        ..defaults
    };
    let file = ModelFile {
        path: &args.model,
        text,
    };
    let logs = input::log_set(&args.logs, &args.judging.holdout);
    let heard = until_stopped(&options.stop, console);
    discover_logs(model, file, &logs, &options, &heard)
}

/// Writes the model with the law, where one is wanted and found; the file it wrote.
fn write(
    found: &LogDiscovery,
    text: &str,
    args: &DiscoverArgs,
    console: &Console,
) -> Result<Option<PathBuf>> {
    let Some(file) = args.output.as_ref() else {
        return Ok(None);
    };
    if !found.discovery.has_law() {
        console.say("no law to write: there is no new model");
        return Ok(None);
    }
    let progress = console.progress();
    let horizon = args.judging.run.horizon;
    let added = found
        .discovery
        .added_to(text, &args.model, &found.split, horizon, &progress)?;
    drop(progress);
    match added {
        Addition::Added { text, .. } => {
            let text = moved(&text, &args.model, file)?;
            output::write_new(file, &text, args.page.is_forced())?;
            console.say(&format!("wrote {}", file.display()));
            Ok(Some(file.clone()))
        }
        Addition::Undetermined(why) => {
            console.say(&format!("no new model: {why}"));
            Ok(None)
        }
        Addition::Unhelpful(why) => {
            console.say(&format!(
                "no new model: {}",
                why.why(&found.discovery.addresses())
            ));
            Ok(None)
        }
    }
}

fn print(
    discovery: &Discovery,
    model: &Model,
    written: Option<PathBuf>,
    console: &Console,
) -> Result<()> {
    let mut data = discovery_json(discovery);
    data["model"] = json!(written.map(|file| file.to_string_lossy().into_owned()));
    console.result(&data, || discovery_text(discovery, &JointNames::of(model)))
}

/// The page: the model as it is and with the law, against all motions.
fn report(found: &LogDiscovery, args: &DiscoverArgs, console: &Console) -> Result<String> {
    let (diagnosis, model) = (&found.discovery.diagnosis, &found.model);
    let logs = input::log_set(&args.logs, &args.judging.holdout);
    let motions = read(&logs.all(), &model.log)?;
    let models = diagnosis.models(model);
    let named = models
        .iter()
        .map(|(name, model)| (name.as_str(), model, motions.as_slice()));
    let judged_over = diagnosis.horizon_s.map(Horizon::Seconds);
    let report = Report {
        title: format!("What {} lacks", model.name),
        comparisons: compare_all(named, args.judging.run.horizon.or(judged_over)),
        diagnosis: Some(diagnosis.clone()),
        provenance: page::provenance(&[&args.model], &found.split, console)?,
        names: JointNames::of(model),
    };
    let law = law_section(&found.discovery, &JointNames::of(model));
    Ok(html_with(&report, law.into_iter().collect()))
}
