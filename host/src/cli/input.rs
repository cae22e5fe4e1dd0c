//! Arguments that several commands take.

use super::Console;
use handstand::compare::ClosedLoopComparison;
use handstand::error::Place;
use handstand::fitting::{Horizon, free_parameters};
use handstand::log::{LogFinding, LogFormat, LogRequest, LogSet, read_with_findings};
use handstand::model::{LogColumns, ParameterPath};
use handstand::motion::{Motion, Split};
#[cfg(feature = "robot")]
use handstand::output::number::{exact, short};
use handstand::output::vacant;
use handstand::study::compare_closed_loop;
use handstand::synth::StateFeedbackPlan;
use handstand::{Error, Model, Result};
use std::path::{Path, PathBuf};

#[cfg(feature = "robot")]
/// The value of an option, in the unit in which it is given.
///
/// # Errors
/// A value outside the range, or none at all.
pub fn within(name: &str, value: f64, least: f64, most: f64) -> Result<f64> {
    if (least..=most).contains(&value) {
        return Ok(value);
    }
    Err(Error::usage(
        format!("{name} {} does not fit", exact(value)),
        format!("give {} to {}", short(least), short(most)),
    ))
}

/// How long models run.
#[derive(Debug, clap::Args)]
pub struct RunLength {
    /// Most seconds a model runs without correction, or `whole`; shorter in motions whose start
    /// errors grow faster
    #[arg(long, value_name = "SECONDS", value_parser = horizon, allow_negative_numbers = true)]
    pub horizon: Option<Horizon>,
}

impl RunLength {
    /// The horizon that is asked for, if one is, for these motions.
    ///
    /// # Errors
    /// Windows of too few samples.
    pub fn of<'a>(
        &self,
        model: &Model,
        motions: impl IntoIterator<Item = &'a Motion>,
    ) -> Result<Option<Horizon>> {
        if let Some(horizon) = self.horizon {
            horizon.check(model, motions)?;
        }
        Ok(self.horizon)
    }
}

/// The controller of a robot that balances.
#[derive(Debug, clap::Args)]
pub struct PlanFile {
    /// Simulate the closed loop with the plan that `gains --state-space` wrote
    #[arg(long, value_name = "GAINS.json")]
    plan: Option<PathBuf>,
}

impl PlanFile {
    /// The plan, if one is given, for a robot like `model`.
    ///
    /// # Errors
    /// As [`StateFeedbackPlan::load`].
    pub fn load(&self, model: &Model) -> Result<Option<StateFeedbackPlan>> {
        let load = |file: &PathBuf| StateFeedbackPlan::load(file, model);
        self.plan.as_ref().map(load).transpose()
    }
}

/// The model's closed loop against the measured one, if there is a plan.
///
/// # Errors
/// As [`compare_closed_loop`].
pub fn closed_loop(
    model: &Model,
    plan: Option<&StateFeedbackPlan>,
    motions: &[Motion],
) -> Result<Option<ClosedLoopComparison>> {
    plan.map(|plan| compare_closed_loop(model, plan, motions))
        .transpose()
}

/// How models are judged.
#[derive(Debug, clap::Args)]
pub struct HoldoutArgs {
    /// Logs to judge by, which are not fitted
    #[arg(long, num_args = 1.., value_name = "LOG", value_parser = log)]
    pub holdout: Vec<LogRequest>,
    /// How long models run
    #[command(flatten)]
    pub run: RunLength,
}

/// How a fit is judged, and where the new model goes.
#[derive(Debug, clap::Args)]
pub struct RefitArgs {
    /// How it is judged
    #[command(flatten)]
    pub judging: HoldoutArgs,
    /// New model file
    #[arg(long, short, value_name = "NEW.toml")]
    pub output: PathBuf,
    /// Replace the file if it exists
    #[arg(long)]
    pub force: bool,
}

impl RefitArgs {
    /// Reads the motions to fit and those to judge by; the new model's name is checked before that
    /// work, and the horizon after it.
    ///
    /// # Errors
    /// As [`vacant`], [`LogSet::read`] and [`RunLength::of`].
    pub fn motions(&self, model: &Model, logs: &[LogRequest], console: &Console) -> Result<Split> {
        vacant(&self.output, self.force)?;
        let logs = log_set(logs, &self.judging.holdout);
        let (split, findings) = logs.read_with_findings(&model.log)?;
        warn(&findings, console);
        let motions = split.training.iter().chain(&split.held_out);
        self.judging.run.of(model, motions)?;
        Ok(split)
    }
}

/// The motions of logs; what is left out of them is said.
///
/// # Errors
/// As [`read_with_findings`].
pub fn motions(
    logs: &[LogRequest],
    columns: &LogColumns,
    console: &Console,
) -> Result<Vec<Motion>> {
    let (motions, findings) = read_with_findings(logs, columns)?;
    warn(&findings, console);
    Ok(motions)
}

/// Says what is left out of logs.
pub fn warn(findings: &[LogFinding], console: &Console) {
    for finding in findings {
        console.say(&finding.to_string());
    }
}

/// A model or a log, whichever comes, its error with the remedy.
#[cfg(feature = "lab")]
pub fn file(text: &str) -> Result<LogRequest, String> {
    text.parse().map_err(said)
}

/// A log argument, its error with the remedy: `drop.csv`, `drop.csv:26-139`.
pub fn log(text: &str) -> Result<LogRequest, String> {
    let request: LogRequest = text.parse().map_err(said)?;
    let ending = request.path.extension();
    if ending.is_some_and(|ending| ending.eq_ignore_ascii_case("toml")) {
        Err(format!(
            "this is a model file, not a log; are the two swapped? {MODEL_FIRST}"
        ))
    } else {
        Ok(request)
    }
}

const MODEL_FIRST: &str = "The model comes first, then the logs: MODEL.toml LOG.csv";

/// The model in a file.
///
/// # Errors
/// As [`Model::load`]; a log.
pub fn model(path: &Path) -> Result<Model> {
    no_log(path)?;
    Model::load(path)
}

/// Says what the file of a robot in space calls the joints, which are numbered elsewhere.
pub fn tell_joints(model: &Model, console: &Console) {
    if let Some(robot) = &model.robot {
        let numbered = (1..).zip(&robot.joints);
        let joints: Vec<String> = numbered.map(|(at, name)| format!("{at} {name}")).collect();
        console.say(&format!("joints: {}", joints.join(", ")));
    }
}

/// The text of a model's file.
///
/// # Errors
/// As [`text`]; a log.
pub fn model_text(path: &Path) -> Result<String> {
    no_log(path)?;
    text(path)
}

fn no_log(path: &Path) -> Result<()> {
    if LogFormat::is_log(path) && path.is_file() {
        Err(Error::data(
            Place::file(path),
            "this is a log, not a model file",
            format!("are the two swapped? {MODEL_FIRST}"),
        ))
    } else {
        Ok(())
    }
}

/// A horizon argument: seconds, or `whole`.
pub fn horizon(text: &str) -> Result<Horizon, String> {
    match text.parse::<f64>() {
        _ if text == "whole" => Ok(Horizon::Whole),
        Ok(seconds) if seconds.is_finite() && seconds > 0.0 => Ok(Horizon::Seconds(seconds)),
        _ => Err("give seconds above 0, or `whole` to run whole motions freely".to_string()),
    }
}

/// A number above 0.
pub fn positive(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(value) if value.is_finite() && value > 0.0 => Ok(value),
        _ => Err("give a number above 0".to_string()),
    }
}

/// A length of time, s: `60s`, `2min`, or plain seconds.
pub fn duration_s(text: &str) -> Result<f64, String> {
    let number = text.trim_end_matches(|c: char| c.is_alphabetic());
    let unit_s = match text[number.len()..].trim() {
        "" | "s" => 1.0,
        "min" => 60.0,
        "h" => 3600.0,
        _ => return Err("give seconds (60s), minutes (2min) or hours (1h)".to_string()),
    };
    let time_s = positive(number.trim())? * unit_s;
    // A year is as good as no limit, and a clock can count it.
    if time_s <= 3.2e7 {
        Ok(time_s)
    } else {
        Err("give no more than a year, or leave it out".to_string())
    }
}

/// Two numbers, `LOW..HIGH`.
///
/// # Errors
/// Text that is no range.
pub fn range(option: &str, text: &str) -> Result<(f64, f64)> {
    let ends = text.split_once("..");
    let ends = ends.and_then(|(low, high)| Some((low.parse().ok()?, high.parse().ok()?)));
    ends.ok_or_else(|| {
        Error::usage(
            format!("--{option} {text} is no range"),
            "write two numbers, such as -0.5..0.5",
        )
    })
}

/// A range for each of so many joints: one that is given for all, or one for each, parted by `/`.
///
/// # Errors
/// Another number of them, or what is no range.
pub fn ranges(option: &str, text: &str, joints: usize) -> Result<Vec<(f64, f64)>> {
    let given: Vec<&str> = text.split('/').collect();
    if given.len() != 1 && given.len() != joints {
        return Err(Error::usage(
            format!("{} ranges for {joints} joints", given.len()),
            "give one range for all joints, or one for each",
        ));
    }
    let of_joint = |joint: usize| range(option, given.get(joint).unwrap_or(&given[0]));
    (0..joints).map(of_joint).collect()
}

/// Addresses of values that were measured by themselves.
///
/// # Errors
/// What is no address, or not of this model.
pub fn known(model: &Model, named: &[String]) -> Result<Vec<ParameterPath>> {
    match named {
        [] => Ok(Vec::new()),
        named => Ok(free_parameters(model, named)?),
    }
}

/// An error and its remedy in one line, as argument errors are told.
pub fn said(error: Error) -> String {
    match error.remedy() {
        Some(remedy) => format!("{error}; {remedy}"),
        None => error.to_string(),
    }
}

/// The logs to learn from, and those to judge by.
pub fn log_set(logs: &[LogRequest], held_out: &[LogRequest]) -> LogSet {
    LogSet {
        training: logs.to_vec(),
        held_out: held_out.to_vec(),
    }
}

/// The text of a file.
///
/// # Errors
/// [`Error::File`] if the system refuses.
pub fn text(path: &Path) -> Result<String> {
    std::fs::read_to_string(path).map_err(|error| Error::file(path, "read", error))
}

#[cfg(test)]
mod tests {
    use super::duration_s;

    #[test]
    fn a_length_of_time_has_a_unit_or_is_in_seconds() {
        for (text, seconds) in [
            ("60s", 60.0),
            ("2min", 120.0),
            ("1.5 h", 5400.0),
            ("90", 90.0),
        ] {
            assert_eq!(duration_s(text), Ok(seconds), "{text}");
        }
        for refused in ["", "s", "0s", "-1", "1ms", "inf", "nan", "9999999h", "1 2"] {
            let value = duration_s(refused);
            assert!(value.is_err() || refused == "{refused}: {value:?}");
        }
    }
}
