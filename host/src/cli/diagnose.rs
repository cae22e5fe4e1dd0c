//! `handstand diagnose MODEL LOG... [--holdout LOG]...`: which physical effect is missing from the
//! model?
//!
//! Judges the logs first. Then every effect of the library that could act and be seen is tried, and
//! what it gains on motions that took no part in the fit decides. Without `--holdout` the last
//! third of the motions is held out; where there is but one motion, nothing can be said of new
//! ones.
//!
//! ```console
//! $ handstand diagnose arm.toml a.csv b.csv --holdout c.csv --report report.html
//! ```
//!
//! With the plan of a balancing robot (`--plan GAINS.json`, from `handstand gains --state-space`)
//! the closed loop is simulated too, of the model as it is and with the effects that were found.
//!
//! `--within 60s` ends the search in time for an answer after a minute, Ctrl-C at once: the best so
//! far is judged, and what was left out is said. A second Ctrl-C leaves.
//!
//! `--each FOLDER -o RESULT` diagnoses every log of a folder by itself, in shards if need be
//! (`--shard 2/8`): a line of JSON per log, then a table (`logs.csv`) and a page (`logs.html`).
//!
//! The verdict is `nominal`, `adequate`, `wrong_value`, `named`, `ambiguous`, `unexplained` or
//! `unfit`; exit code 1 for `unfit`, 0 for the others, which are answers. `--json` prints the
//! diagnosis; its keys are in `docs/json.md`.

mod each;

use super::interrupt::Interrupt;
use super::page::{self, PageFile};
use super::{Console, ExitStatus, input};
use each::EachArgs;
use handstand::compare::{ClosedLoopComparison, Comparison, closed_loop_text, compare_all};
use handstand::diagnose::conventions::ModelFile;
use handstand::diagnose::{DiagnoseOptions, Diagnosis, LogDiagnosis, Verdict, diagnose_logs};
use handstand::fitting::{Horizon, Progress, StopSwitch, effect_ids};
use handstand::log::{LogRequest, LogSet, read};
use handstand::model::JointNames;
use handstand::motion::Motion;
use handstand::report::{Report, diagnosis_json, diagnosis_text, html};
use handstand::synth::StateFeedbackPlan;
use handstand::{Model, Result};
use serde_json::json;
use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, Ordering};

/// Diagnose which physical effect a model lacks, from logs.
#[derive(Debug, clap::Args)]
pub struct DiagnoseArgs {
    /// Model file
    model: PathBuf,
    /// Logs to learn from
    #[arg(required_unless_present = "each", value_name = "LOG", value_parser = input::log)]
    logs: Vec<LogRequest>,
    /// Effect to leave out of the candidates
    #[arg(long, value_name = "EFFECT")]
    without: Vec<String>,
    /// Value of the file that was measured by itself, and is right
    #[arg(long, value_name = "PATH")]
    known: Vec<String>,
    /// Seed of the random draws
    #[arg(long, value_name = "N")]
    seed: Option<u64>,
    /// Error that is good enough, mrad: an explanation that leaves no more ends the search, a
    /// model as given that does is `adequate`
    #[arg(long, value_name = "MRAD", value_parser = input::positive)]
    tolerance: Option<f64>,
    /// Time that it may take, log check and judging included: `60s`, `2min`
    #[arg(long, value_name = "TIME", value_parser = input::duration_s)]
    within: Option<f64>,
    /// Diagnose even where another sign, zero, unit or drive in the model file clearly lowers the
    /// error
    #[arg(long)]
    trust_log: bool,
    #[command(flatten)]
    judging: input::HoldoutArgs,
    #[command(flatten)]
    plan: input::PlanFile,
    #[command(flatten)]
    page: PageFile,
    #[command(flatten)]
    each: EachArgs,
}

impl DiagnoseArgs {
    /// The logs to learn from, and those to judge by.
    fn log_set(&self) -> LogSet {
        input::log_set(&self.logs, &self.judging.holdout)
    }
}

/// Diagnoses, prints, writes the page.
pub fn run(args: &DiagnoseArgs, console: &Console) -> Result<ExitStatus> {
    if let Some(folder) = &args.each.folder {
        return each::run(folder, args, console);
    }
    let diagnosis = find(args, console)?;
    Ok(ExitStatus::answer(diagnosis.verdict != Verdict::Unfit))
}

/// The diagnosis itself, printed and written as by [`run`].
pub fn find(args: &DiagnoseArgs, console: &Console) -> Result<Diagnosis> {
    args.page.vacant()?;
    let model = input::model(&args.model)?;
    input::tell_joints(&model, console);
    let plan = args.plan.load(&model)?;
    let LogDiagnosis { diagnosis, split } = try_all(&model, args, console)?;
    if diagnosis.verdict == Verdict::Unfit {
        print((&diagnosis, &model), &[], console)?;
        return Ok(diagnosis);
    }
    let compared = Compared::new(&model, &diagnosis, plan.as_ref(), args)?;
    print((&diagnosis, &model), &compared.named_loops(), console)?;
    let page = || {
        Ok(html(&Report {
            title: format!("What {} lacks", model.name),
            comparisons: compared.comparisons(diagnosis.horizon_s, args),
            diagnosis: Some(diagnosis.clone()),
            provenance: page::provenance(&[&args.model], &split, console)?,
            names: JointNames::of(&model),
        }))
    };
    args.page.write(page, console)?;
    Ok(diagnosis)
}

/// What the options ask for.
fn options(model: &Model, args: &DiagnoseArgs) -> Result<DiagnoseOptions> {
    let defaults = DiagnoseOptions::default();
    Ok(DiagnoseOptions {
        seed: args.seed.unwrap_or(defaults.seed),
        without: effect_ids(&args.without)?,
        known: input::known(model, &args.known)?,
        horizon: args.judging.run.horizon,
        trust_log: args.trust_log,
        tolerance_rad: args.tolerance.map(|mrad| 1e-3 * mrad),
        within_s: args.within,
        ..defaults
    })
}

fn try_all(model: &Model, args: &DiagnoseArgs, console: &Console) -> Result<LogDiagnosis> {
    let options = options(model, args)?;
    let logs = args.log_set();
    let text = input::text(&args.model)?;
    let file = ModelFile {
        path: &args.model,
        text: &text,
    };
    let heard = until_stopped(&options.stop, console);
    diagnose_logs(model, file, &logs, &options, &heard)
}

/// Shows progress until Ctrl-C, which accepts the best so far; that is told once.
pub fn until_stopped(stop: &StopSwitch, console: &Console) -> impl Fn(Progress) + Sync {
    let interrupt = Interrupt::accepting(stop);
    let shown = console.progress();
    let told = AtomicBool::new(false);
    let console = console.clone();
    move |progress: Progress| {
        if interrupt.has_come() && !told.swap(true, Ordering::Relaxed) {
            console.say(&stopping(&progress));
        }
        shown(progress);
    }
}

/// That the best so far is judged, and what it is: a second Ctrl-C leaves no more than this line.
fn stopping(progress: &Progress) -> String {
    let best = progress.best.as_ref();
    let best = best.map_or("nothing is found yet".to_string(), |best| {
        format!("best so far {best}")
    });
    format!("Ctrl-C: judging what was found ({best}); once more to leave at once")
}

/// Prints the diagnosis, and the closed loops before and after it where there are any.
fn print(
    (diagnosis, model): (&Diagnosis, &Model),
    loops: &[NamedLoop],
    console: &Console,
) -> Result<()> {
    if console.json {
        let mut value = diagnosis_json(diagnosis);
        let after = loops.get(1).map(|(_, after)| after);
        value["closed_loop"] = loops.first().map_or(
            json!(null),
            |(_, before)| json!({ "before": before, "after": after }),
        );
        return console.data(&value);
    }
    let names = JointNames::of(model);
    console.print(&(diagnosis_text(diagnosis, &names) + &closed_loop_text(loops)))
}

/// A model's name and its closed loop.
type NamedLoop<'a> = (&'a str, &'a ClosedLoopComparison);

/// The model as it is and with the effects that were found, against all motions.
struct Compared {
    motions: Vec<Motion>,
    /// Each with its name, and its closed loop if there is a plan.
    models: Vec<(String, Model, Option<ClosedLoopComparison>)>,
}

impl Compared {
    fn new(
        model: &Model,
        diagnosis: &Diagnosis,
        plan: Option<&StateFeedbackPlan>,
        args: &DiagnoseArgs,
    ) -> Result<Compared> {
        let motions = read(&args.log_set().all(), &model.log)?;
        let mut models = Vec::new();
        for (name, model) in diagnosis.models(model) {
            let closed_loop = input::closed_loop(&model, plan, &motions)?;
            models.push((name, model, closed_loop));
        }
        Ok(Compared { motions, models })
    }

    fn named_loops(&self) -> Vec<NamedLoop<'_>> {
        let models = self.models.iter();
        models
            .filter_map(|(name, _, closed_loop)| Some((name.as_str(), closed_loop.as_ref()?)))
            .collect()
    }

    /// The comparisons of the page, all over the first one's horizon.
    fn comparisons(&self, judged_over_s: Option<f64>, args: &DiagnoseArgs) -> Vec<Comparison> {
        let judged_over = judged_over_s.map(Horizon::Seconds);
        let models = self.models.iter();
        let named = models.map(|(name, model, _)| (name.as_str(), model, self.motions.as_slice()));
        let mut comparisons = compare_all(named, args.judging.run.horizon.or(judged_over));
        for (comparison, (_, _, closed_loop)) in comparisons.iter_mut().zip(&self.models) {
            comparison.closed_loop = closed_loop.clone();
        }
        comparisons
    }
}
