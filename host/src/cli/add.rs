//! `handstand add MODEL EFFECT[@JOINT]... --fit LOG... -o NEW.toml`: a model with more effects.
//!
//! The effects' values are fitted along with the model's free ones, by the ways that a diagnosis
//! takes and from each of the effects' start values; the best is kept. On the motions fitted it
//! leaves no more than the model refitted without the effects. The new file is the old one with the
//! refitted values and, at its end, the effects with their intervals, the logs it was fitted to,
//! and the error without and with it; those of the values it had are renewed. The error without it
//! is that of the model refitted without it, so that the reduction is the effect's alone;
//! `handstand compare` sets models side by side as they are, where the reduction is also the
//! refit's.
//!
//! ```console
//! $ handstand add arm.toml delay --fit a.csv b.csv --holdout c.csv -o better.toml
//! ```
//!
//! `--from` takes the diagnosis that `diagnose --json` printed: its effects are added unless others
//! are named, and the fit starts from its values, so that it leaves no more of the motions fitted.
//!
//! ```console
//! $ handstand diagnose arm.toml a.csv b.csv --holdout c.csv --json > diagnosis.json
//! $ handstand add arm.toml --from diagnosis.json --fit a.csv b.csv --holdout c.csv -o better.toml
//! ```
//!
//! Exit code 1, and no file, when the logs do not determine the values, when the fit did not find
//! any that reduce the error of the motions fitted by a thousandth at least, or when that on the
//! motions held out is not reduced by as much. `--json` prints what `handstand fit`
//! prints, and `effects`, as `["delay@1"]`.

use super::{Console, ExitStatus, fit, input};
use handstand::fitting::{Addition, Candidate, Unhelpful, add_effects_from, candidates_named};
use handstand::log::LogRequest;
use handstand::model::{JointNames, ParameterPath};
use handstand::report::DiagnosisFile;
use handstand::{Model, Result};
use serde_json::json;
use std::path::PathBuf;

/// Add effects to a model, their parameters fitted to logs.
#[derive(Debug, clap::Args)]
pub struct AddArgs {
    /// Model file
    model: PathBuf,
    /// The effects: `delay`, or `coulomb@2` where there are several joints
    #[arg(required_unless_present = "from", value_name = "EFFECT")]
    effects: Vec<String>,
    /// Diagnosis that `diagnose --json` wrote: adds what it found unless effects are named, and
    /// starts from its values
    #[arg(long, value_name = "DIAGNOSIS.json")]
    from: Option<PathBuf>,
    /// Logs to fit
    #[arg(long = "fit", required = true, num_args = 1..)]
    #[arg(value_name = "LOG", value_parser = input::log)]
    logs: Vec<LogRequest>,
    #[command(flatten)]
    fit: input::RefitArgs,
}

/// Fits, writes, prints.
pub fn run(args: &AddArgs, console: &Console) -> Result<ExitStatus> {
    let text = input::model_text(&args.model)?;
    let model = Model::parse(&text, &args.model)?;
    input::tell_joints(&model, console);
    let (candidates, start) = args.asked(&model, console)?;
    let split = args.fit.motions(&model, &args.logs, console)?;
    let horizon = args.fit.judging.run.horizon;
    let names: Vec<String> = candidates.iter().map(ToString::to_string).collect();
    let called = JointNames::of(&model);
    let (path, progress) = (&args.model, console.progress());
    let added = add_effects_from(&text, path, &candidates, &start, &split, horizon, &progress)?;
    // Nothing is printed beside the bar.
    drop(progress);
    match added {
        Addition::Added { text, refitted } => {
            let before = "for the model refitted without";
            let text = (text.as_str(), args.model.as_path());
            let written = (names.as_slice(), before, &called);
            fit::write(&refitted, text, written, &args.fit, console)
        }
        Addition::Unhelpful(why) => refuse(&why, &names, &called, console),
        Addition::Undetermined(why) => fit::refuse(&why, &called, console),
    }
}

impl AddArgs {
    /// The effects to add, and the values to start from.
    fn asked(&self, model: &Model, console: &Console) -> Result<Asked> {
        let Some(file) = &self.from else {
            return Ok((candidates_named(&self.effects, model)?, Vec::new()));
        };
        let diagnosis = DiagnosisFile::read(file)?;
        let names = match self.effects.as_slice() {
            [] => diagnosis.effects()?,
            named => named.to_vec(),
        };
        let candidates = candidates_named(&names, model)?;
        let start = diagnosis.values(&candidates, model)?;
        let names: Vec<String> = candidates.iter().map(ToString::to_string).collect();
        let (names, file) = (names.join(", "), file.display());
        console.say(&if start.is_empty() {
            format!("{file} gives no values of {names}: none is started from")
        } else {
            format!("{names}: from the values of {file}")
        });
        for path in diagnosis.wrong_values() {
            console.say(&format!(
                "{file}: `{path}` is wrong as well; `handstand fit --free {path}`"
            ));
        }
        Ok((candidates, start))
    }
}

/// Effects, and values to start from.
type Asked = (Vec<Candidate>, Vec<(ParameterPath, f64)>);

/// Says that the effects do not help, and writes nothing.
fn refuse(
    unhelpful: &Unhelpful,
    names: &[String],
    called: &JointNames,
    console: &Console,
) -> Result<ExitStatus> {
    let (error, why) = (unhelpful.error(), unhelpful.why(names));
    if console.json {
        console.data(&json!({ "refused": why, "error": error }))?;
    } else {
        let remedy = match unhelpful {
            Unhelpful::NotFound(_) => {
                "Shorter windows (`--horizon 1`) tell more of a motion that the model loses; other \
                 motions may show what these do not."
            }
            Unhelpful::NotReduced { .. } => {
                "`handstand diagnose` says which effect the logs ask for."
            }
        };
        let text = format!("refused: {why}; nothing is written. {remedy}");
        console.print(&called.in_text(&text))?;
    }
    Ok(ExitStatus::Refused)
}
