//! `handstand gains MODEL`: gains that balance a model at a pose, and the files that carry them on.
//!
//! Linearises the chain exactly, samples it with its delay, solves the regulator's Riccati
//! equation, rounds the gains to fixed point with a proof against overflow. Any model that
//! `handstand add` writes will do: effects without a derivative (Coulomb friction, dead zones, ..)
//! are left out of the design, which says so; `--without` leaves out one more, which the simulated
//! loop keeps.
//! Weights follow from ranges (Bryson's rule) unless given: one number (times the identity), a
//! diagonal `1,1,0.1`, or a CSV file of a matrix.
//!
//! ```console
//! $ handstand gains handstand.toml --ts 0.01 --rust gains.rs --c gains.h
//! ```
//!
//! Then the loop is simulated with every effect of the model, those that the design leaves out
//! included: whether it is stabilised, from how far, and which effect limits it. Exit code 1 when
//! it is not.
//!
//! `--json` prints everything: `omitted_effects`, `k`, `riccati`, `residual`, `loop_poles`,
//! `poles_1_s`, `zeros_1_s`, `continuous` and `sampled` (`a`, `b`, `c`, `d`, ..), `estimator`,
//! `fixed`, `verification`, `provenance`. `--state-space FILE.json` writes the same; `FILE.m` a
//! script for MATLAB and Octave.

use super::weight_arg::{WeightArg, weight};
use super::{Console, ExitStatus, input};
use handstand::model::Model;
use handstand::report::{
    GainsReport, gains_json, gains_page, margins_text, tuned_text, verification_text, with_margins,
};
use handstand::study::{TUNING_STEPS, Tuned, left_out, tune, verification_steps, verify};
use handstand::synth::export::{self, Provenance};
use handstand::synth::{Design, DesignError, LoopFigures, PoseText, Request};
use handstand::{Error, Result};
use serde_json::json;
use std::path::{Path, PathBuf};

mod recovery;
mod request;

use recovery::Unrecovered;
use request::SpeedsArg;
pub(super) use request::requested;

/// Gains that balance a model at a pose.
#[derive(Debug, Clone, clap::Args)]
pub struct GainsArgs {
    /// Model file
    model: PathBuf,
    /// Weight of the states: a number, a diagonal, or a CSV file of a matrix [default: one over the
    /// square of each --range; the paper's are 100]
    #[arg(long, value_name = "WEIGHT", value_parser = weight, allow_hyphen_values = true)]
    q: Option<WeightArg>,
    /// Weight of the inputs, likewise [default: one over the square of each --limit; 1 with --q]
    #[arg(long, value_name = "WEIGHT", value_parser = weight, allow_hyphen_values = true)]
    #[arg(requires = "q")]
    r: Option<WeightArg>,
    /// Integral action: weight of the integrals of the driven joints' angles, one number or a list
    #[arg(long, value_name = "WEIGHT", value_parser = weight, allow_hyphen_values = true)]
    #[arg(conflicts_with_all = ["continuous", "lqg", "tune"])]
    integral: Option<WeightArg>,
    /// Search weights with the largest region under all effects of the model, margins kept
    #[arg(long, conflicts_with_all = ["q", "r", "continuous"])]
    tune: bool,
    /// Sampling time, s
    #[arg(long, value_name = "SECONDS", default_value_t = 0.01)]
    #[arg(allow_negative_numbers = true)]
    ts: f64,
    /// Delay of the inputs, s; the model's own without it
    #[arg(long, value_name = "SECONDS", allow_negative_numbers = true)]
    delay: Option<f64>,
    /// Angles in rad, the model's way: one per joint, some by name as `elbow=0.3,wrist=-1`, or
    /// `upright` [default: upright; in space, and of joints not named, 0 or mid-range]
    #[arg(long, value_name = "ANGLES", value_parser = pose, allow_hyphen_values = true)]
    pose: Option<PoseText>,
    /// Move the passive joints from the pose to where they balance
    #[arg(long)]
    balance: bool,
    /// Design without this effect; the simulated loop keeps it
    #[arg(long, value_name = "EFFECT")]
    without: Vec<String>,
    /// For continuous time: no sampling, no fixed point
    #[arg(long, conflicts_with_all = ["ts", "delay", "lqg", "rust", "c"])]
    continuous: bool,
    /// Add a Kalman filter for rounded angles and a gyro on the first link
    #[arg(long)]
    lqg: bool,
    /// Step of the measured angles, rad [default: the model's; with --lqg 300 degrees / 1024]
    #[arg(long, value_name = "RAD", value_parser = input::positive, conflicts_with = "continuous")]
    position_step: Option<f64>,
    /// Speeds that the simulated law is given
    #[arg(long, value_enum, default_value = "true", conflicts_with_all = ["lqg", "continuous"])]
    speeds: SpeedsArg,
    /// Step of the gyro, rad/s [default: 10 degrees per second]
    #[arg(long, value_name = "RAD_S", requires = "lqg")]
    gyro_step: Option<f64>,
    /// Covariance of the process noise, as a weight [default: inputs err by a hundredth of their
    /// limit]
    #[arg(long, value_name = "WEIGHT", requires = "lqg")]
    #[arg(value_parser = weight, allow_hyphen_values = true)]
    process: Option<WeightArg>,
    /// Loop transfer recovery: design the filter as if inputs erred by this share of their limits,
    /// too
    #[arg(long, value_name = "SHARE", requires = "lqg", value_parser = input::positive)]
    recovery: Option<f64>,
    /// Largest departures of the states, SI: angles, then speeds
    #[arg(long, value_name = "LIST", value_parser = weight, allow_hyphen_values = true)]
    range: Option<WeightArg>,
    /// Largest inputs, SI [default: the drives' own; 2 N m for a torque]
    #[arg(long, value_name = "LIST", value_parser = weight, allow_hyphen_values = true)]
    limit: Option<WeightArg>,
    /// SI value of one step of each state, where sensors set it [default: powers of two]
    #[arg(long, value_name = "LIST", value_parser = weight)]
    state_step: Option<WeightArg>,
    /// SI value of one step of each input, where drives set it
    #[arg(long, value_name = "LIST", value_parser = weight)]
    input_step: Option<WeightArg>,
    /// Write the fixed-point law as a Rust file
    #[arg(long, value_name = "FILE.rs")]
    rust: Option<PathBuf>,
    /// Write it as a C header
    #[arg(long, value_name = "FILE.h")]
    c: Option<PathBuf>,
    /// What the names in the C header begin with, so that one file can include several
    #[arg(long, value_name = "NAME", value_parser = c_name, default_value = export::C_NAME)]
    name: String,
    /// Write K as CSV
    #[arg(long, value_name = "FILE.csv")]
    csv: Option<PathBuf>,
    /// Write plant, weights and gains for other programs: .json or .m
    #[arg(long, value_name = "FILE", value_parser = state_space)]
    state_space: Option<PathBuf>,
    /// Write a page with pictures: responses, margins, poles, region
    #[arg(long, value_name = "FILE.html")]
    report: Option<PathBuf>,
    /// Replace files that exist
    #[arg(long)]
    force: bool,
}

fn state_space(text: &str) -> Result<PathBuf, String> {
    let path = PathBuf::from(text);
    match path.extension().and_then(|ending| ending.to_str()) {
        Some("json" | "m") => Ok(path),
        _ => Err("end the name in .json (python-control and others) or .m (MATLAB, Octave)".into()),
    }
}

fn pose(text: &str) -> Result<PoseText, String> {
    text.parse()
}

fn c_name(text: &str) -> Result<String, String> {
    if export::is_c_name(text) {
        Ok(text.to_string())
    } else {
        Err("give small letters, digits and _, a letter first".into())
    }
}

/// Designs, prints, writes the files.
pub fn run(args: &GainsArgs, console: &Console) -> Result<ExitStatus> {
    let (part, mut request, made) = requested(args, console).map_err(of_options)?;
    let whole = Model::load(&args.model)?;
    let tuned = tuned(args, &whole, &part, &request, console)?;
    if let Some(tuned) = &tuned {
        request = tuned.request(&request);
    }
    let design = match Design::of(&part, &request) {
        // Gains that exist and lose their stability in fixed point are the answer no.
        Err(error @ DesignError::Rounded(_)) => {
            console.error(error.into());
            return Ok(ExitStatus::Refused);
        }
        design => design.map_err(|error| of_options(error.into()))?,
    };
    let left_out = left_out(&whole, &part, &design);
    let bar = console.bar(verification_steps(&left_out) as u64);
    bar.set_message("simulations of the loop");
    let verified = verify(&whole, &design, &request, &left_out, &|| bar.inc(1))?;
    drop(bar);
    let figures = LoopFigures::of(&part, &design)?;
    let recovered = Unrecovered::of(&part, &request)?;
    let mut data = with_margins(gains_json(&design, &made, &verified), figures.as_ref());
    if let Some(before) = &recovered {
        data["without_recovery"] = before.json();
    }
    if let Some(tuned) = &tuned {
        data["tuned"] = json!(tuned);
    }
    console.result(&data, || {
        format!(
            "{}\n\n{}{}\n{}",
            export::text(&design).trim_end(),
            margins_text(figures.as_ref(), &design),
            recovered
                .as_ref()
                .map_or(String::new(), |before| before.text()),
            verification_text(&verified, &whole)
        )
    })?;
    write(args, &design, &made, &data, console)?;
    if let Some(file) = &args.report {
        let page = gains_page(&GainsReport {
            model: &whole,
            request: &request,
            design: &design,
            figures: figures.as_ref(),
            verified: &verified,
            made: &made,
        })?;
        console.write(file, &page, args.force)?;
    }
    let estimation = design.estimator.as_ref();
    let is_linear = estimation.is_none_or(|it| it.beyond(&design).is_none());
    if !verified.stabilised && !verified.held && !args.tune && !args.continuous {
        console.say("--tune looks for weights that hold it");
    }
    Ok(ExitStatus::answer(verified.stabilised && is_linear))
}

/// Weights for `--tune`, and what to say of them on stderr.
fn tuned(
    args: &GainsArgs,
    whole: &Model,
    part: &Model,
    request: &Request,
    console: &Console,
) -> Result<Option<Tuned>> {
    if !args.tune {
        return Ok(None);
    }
    let bar = console.bar(TUNING_STEPS as u64);
    bar.set_message("weights tried");
    let tuned = tune(whole, part, request, &|| bar.inc(1)).map_err(of_options)?;
    drop(bar);
    console.say(&tuned_text(&tuned));
    Ok(Some(tuned))
}

/// What lies in the options' numbers is a request that makes no sense.
pub(super) fn of_options(error: Error) -> Error {
    match error {
        Error::Design {
            problem,
            in_request: true,
        } => problem.usage(),
        other => other,
    }
}

impl GainsArgs {
    #[cfg(feature = "robot")]
    /// The model file.
    pub(super) fn model(&self) -> &Path {
        &self.model
    }

    #[cfg(feature = "robot")]
    /// An option that serves the regulator on plain states alone, if one is given.
    pub(super) fn for_plain_states(&self) -> Option<&'static str> {
        let given = [
            (self.q.is_some(), "--q"),
            (self.r.is_some(), "--r"),
            (self.integral.is_some(), "--integral"),
            (self.tune, "--tune"),
            (self.ts != 0.01, "--ts"),
            (self.delay.is_some(), "--delay"),
            (
                self.pose
                    .as_ref()
                    .is_some_and(|pose| *pose != PoseText::Upright),
                "--pose",
            ),
            (self.balance, "--balance"),
            (!self.without.is_empty(), "--without"),
            (self.continuous, "--continuous"),
            (self.lqg, "--lqg"),
            (self.position_step.is_some(), "--position-step"),
            (self.speeds != SpeedsArg::True, "--speeds"),
            (self.range.is_some(), "--range"),
            (self.limit.is_some(), "--limit"),
            (self.state_step.is_some(), "--state-step"),
            (self.input_step.is_some(), "--input-step"),
            (self.rust.is_some(), "--rust"),
            (self.c.is_some(), "--c"),
            (self.name != export::C_NAME, "--name"),
            (self.csv.is_some(), "--csv"),
            (self.state_space.is_some(), "--state-space"),
            (self.report.is_some(), "--report"),
        ];
        let mut names = given.into_iter().filter(|(given, _)| *given);
        names.next().map(|(_, name)| name)
    }

    #[cfg(feature = "robot")]
    /// Whether the gains act on sums of angles.
    pub(super) fn is_integral(&self) -> bool {
        self.integral.is_some()
    }

    #[cfg(feature = "robot")]
    /// Whether files are replaced.
    pub(super) fn force(&self) -> bool {
        self.force
    }
}

/// Writes the files that the options ask for; `data` is what the JSON file holds.
pub(super) fn write(
    args: &GainsArgs,
    design: &Design,
    made: &Provenance,
    data: &serde_json::Value,
    console: &Console,
) -> Result<()> {
    let put = |file: &Path, text: &str| console.write(file, text, args.force);
    if let Some(fixed) = &design.fixed {
        if let Some(file) = &args.rust {
            put(file, &export::rust_file(design, fixed, made))?;
        }
        if let Some(file) = &args.c {
            put(file, &export::c_header(design, fixed, made, &args.name))?;
        }
    }
    if let Some(file) = &args.csv {
        put(file, &export::csv(design))?;
    }
    if let Some(file) = &args.state_space {
        let text = if file.extension().is_some_and(|ending| ending == "m") {
            export::matlab(design, made)
        } else {
            format!("{data:#}\n")
        };
        put(file, &text)?;
    }
    Ok(())
}
