//! `handstand next MODEL LOG... [-o MOTION.csv]`: which experiment parts the explanations that the
//! logs leave open, or tightens values.
//!
//! The logs are diagnosed. Where several explanations are left, motions within the limits are
//! simulated with each of them, under every condition that a person can set (a known mass, the rig
//! turned, another supply); the one that puts the closest two farthest apart is proposed, with what
//! to do before it runs. What no motion parts is measured by itself, and said so. Where one
//! explanation is left, the motion is proposed that tightens its values and the model's free ones;
//! `--value` names others and needs no diagnosis.
//!
//! ```console
//! $ handstand next arm.toml a.csv b.csv --holdout c.csv -o next.csv
//! $ handstand replay next.csv --record next_log.csv
//! $ handstand diagnose arm.toml a.csv b.csv next_log.csv --holdout c.csv
//! ```
//!
//! The file has the log's own columns of time, inputs and `torque_on`. `replay` plays it where the
//! inputs are goals of servos, `goal1_rad`; otherwise it is for the rig's own controller.
//!
//! Angles and speeds stay within what the logs have covered, unless options say otherwise. Exit
//! code 1 where nothing within the limits helps. The keys of `--json` are in `docs/json.md`.

use super::input::{self, positive};
use super::{Console, ExitStatus};
use handstand::diagnose::conventions::ModelFile;
use handstand::diagnose::{DiagnoseOptions, Diagnosis, Verdict, diagnose_logs};
use handstand::experiment::{
    Criterion, ExperimentLimits, ExperimentProposal, FollowUp, ProposeOptions, can_be_moved,
    inputs_alone, is_replayable, propose, propose_values,
};
use handstand::fitting::{Horizon, effect_ids, free_parameters};
use handstand::log::{LogRequest, LogSet, to_csv};
use handstand::model::{JointNames, Model};
use handstand::report::{next_steps, proposal_text};
use handstand::{Result, output};
use serde_json::json;
use std::path::{Path, PathBuf};

/// Propose the next experiment.
#[derive(Debug, clap::Args)]
pub struct NextArgs {
    /// Model file
    model: PathBuf,
    /// Logs that there are
    #[arg(required = true, value_name = "LOG", value_parser = input::log)]
    logs: Vec<LogRequest>,
    #[command(flatten)]
    judging: input::HoldoutArgs,
    /// Value to tighten, whatever a diagnosis says: link1.mass_kg
    #[arg(long, value_name = "PATH")]
    value: Vec<String>,
    /// What tightening makes small: the volume of all values' confidence region (d), or the sum of
    /// their variances (a)
    #[arg(long, default_value = "d", value_parser = criterion)]
    criterion: Criterion,
    /// Lowest and highest angle, rad: for all joints, or for each; as in the logs without it
    #[arg(long, value_name = "LOW..HIGH[/..]", allow_hyphen_values = true)]
    angles: Option<String>,
    /// Fastest speed of a joint, rad/s; as in the logs without it
    #[arg(long, value_name = "RAD_S", value_parser = positive)]
    speed: Option<f64>,
    /// Largest torque of a drive, N m
    #[arg(long, value_name = "N_M", value_parser = positive)]
    torque: Option<f64>,
    /// Longest duration, s
    #[arg(long, default_value = "20", value_parser = positive)]
    seconds: f64,
    /// Known mass that can be bolted onto the last link, kg; 0 for none
    #[arg(long, value_name = "KG")]
    mass: Option<f64>,
    /// Effect to leave out of the candidates
    #[arg(long, value_name = "EFFECT")]
    without: Vec<String>,
    /// Value of the file that was measured by itself, and is right
    #[arg(long, value_name = "PATH")]
    known: Vec<String>,
    /// Diagnose even where another sign, zero, unit or drive clearly lowers the error
    #[arg(long)]
    trust_log: bool,
    /// Seed of random motions and draws
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// File of the motion to write, .csv
    #[arg(long, short, value_name = "MOTION.csv")]
    output: Option<PathBuf>,
    /// Replace the file if it exists
    #[arg(long)]
    force: bool,
}

fn criterion(text: &str) -> Result<Criterion, String> {
    match text {
        "d" => Ok(Criterion::D),
        "a" => Ok(Criterion::A),
        _ => Err("write d or a".to_string()),
    }
}

/// Proposes, prints, writes the motion.
pub fn run(args: &NextArgs, console: &Console) -> Result<ExitStatus> {
    if let Some(file) = &args.output {
        output::vacant(file, args.force)?;
    }
    effect_ids(&args.without)?;
    let mut model = input::model(&args.model)?;
    model.hinges_only("proposed motions are for servos that turn")?;
    can_be_moved(&model)?;
    let known = input::known(&model, &args.known)?;
    model.free.retain(|path| !known.contains(path));
    let logs = input::log_set(&args.logs, &args.judging.holdout);
    let motions = input::motions(&logs.all(), &model.log, console)?;
    let horizon = args.judging.run.of(&model, &motions)?;
    let options = ProposeOptions {
        limits: args.limits(
            &model,
            ExperimentLimits::of_logs(&model, &motions, args.seconds),
        )?,
        mass_kg: args.mass,
        criterion: args.criterion,
        seed: args.seed,
    };
    let (proposal, diagnosis) = match args.value.as_slice() {
        [] => {
            let diagnosis = args.diagnosed(&model, &logs, console)?;
            let proposal = match diagnosis.verdict {
                Verdict::Unfit => None,
                _ => Some(propose(&model, &diagnosis, motions, &options)?),
            };
            (proposal, Some(diagnosis))
        }
        named => {
            let values = free_parameters(&model, named)?;
            let horizon = horizon.unwrap_or(Horizon::Whole);
            let proposal = propose_values(&model, &values, motions, horizon, &options)?;
            (Some(proposal), None)
        }
    };
    let helps = proposal.as_ref().is_some_and(ExperimentProposal::helps);
    let experiment = proposal.as_ref().and_then(|p| p.experiment.as_ref());
    let names = JointNames::of(&model);
    let mut written: Option<&Path> = None;
    if let (Some(file), Some(experiment)) = (&args.output, experiment) {
        let columns = inputs_alone(&model);
        let comments = [names.in_text(&experiment.instructions.join("\n"))];
        let text = to_csv(&experiment.motion, &columns, &comments);
        output::write_new(file, &text, args.force)?;
        written = Some(file);
    }
    let (diagnosis, proposal) = (diagnosis.as_ref(), proposal.as_ref());
    let follow_up = args.follow_up(&logs, written, is_replayable(&model));
    let data = json!({
        "proposal": proposal,
        "diagnosis": diagnosis.map(|d| &d.summary),
        "file": written.map(|file| file.display().to_string()),
        "next": next_steps(diagnosis, proposal, &follow_up),
        "replayable": follow_up.replayable,
    });
    console.result(&data, || {
        names.in_text(&proposal_text(diagnosis, proposal, &follow_up))
    })?;
    Ok(ExitStatus::answer(helps))
}

impl NextArgs {
    /// What the commands that follow name.
    fn follow_up<'a>(
        &'a self,
        logs: &'a LogSet,
        motion: Option<&'a Path>,
        replayable: bool,
    ) -> FollowUp<'a> {
        FollowUp {
            model: &self.model,
            logs,
            motion,
            replayable,
            values: &self.value,
            without: &self.without,
            known: &self.known,
            trust_log: self.trust_log,
            horizon: self.judging.run.horizon,
        }
    }

    fn diagnosed(&self, model: &Model, logs: &LogSet, console: &Console) -> Result<Diagnosis> {
        let options = DiagnoseOptions {
            without: effect_ids(&self.without)?,
            known: input::known(model, &self.known)?,
            horizon: self.judging.run.horizon,
            trust_log: self.trust_log,
            ..DiagnoseOptions::default()
        };
        let text = input::text(&self.model)?;
        let file = ModelFile {
            path: &self.model,
            text: &text,
        };
        let found = diagnose_logs(model, file, logs, &options, &console.progress())?;
        Ok(found.diagnosis)
    }

    /// The logs' limits with those that options give.
    fn limits(&self, model: &Model, of_logs: ExperimentLimits) -> Result<ExperimentLimits> {
        let mut limits = of_logs;
        let joints = model.link_count();
        if let Some(text) = &self.angles {
            let angles = input::ranges("angles", text, joints)?;
            (limits.low_rad, limits.high_rad) = angles.into_iter().unzip();
        }
        if let Some(speed) = self.speed {
            limits.speed_rad_s = vec![speed; joints];
        }
        limits.torque_nm = self.torque;
        Ok(limits)
    }
}
