//! `handstand controllers [MODEL]`: the library's controllers, simulated on robots with the
//! non-idealities that the paper found.
//!
//! Without a model, a line for each controller and each condition. With one: from each of
//! `--robots` random starts at rest, within `--spread-deg` of the pose in each angle, every
//! controller under every condition. A robot is stabilised if no link leans more than 45 deg and
//! every joint stays within 10 deg of the pose over the last two seconds. The region is the largest
//! spread of starts of which 95 % are stabilised. Every effect of the model acts in the simulation;
//! the designs leave out those without a derivative.
//! A robot that stays from the same start without any command, held by friction, does not count as
//! stabilised.
//!
//! A controller knows the nominal model and what can be measured beforehand (sampling time, delay,
//! nominal dead zone, limit, resolutions); it does not know a robot's own dead zone (within a fifth
//! of 10 %), where its masses lie beside their lines (within 2 mm), or what they weigh (within 10
//! %), unless its description says so.
//!
//! ```console
//! $ handstand controllers handstand.toml --robots 200 --condition all
//! ```
//!
//! Exit code 1 when under some condition no controller stabilises 95 %. `--json` prints a list of
//! `controller`, `condition`, `robots`, `stabilised`, `held` (runs that stay without any command),
//! `fallen`, `rms_angle_rad`, `limit_cycle_rad`, `rms_torque_nm`, `region_rad`, `region_open`.

use super::gains_choice::GainsChoice;
use super::{Console, ExitStatus, input, show};
use handstand::study::{
    CONDITIONS, Case, Judging, LoopCondition, REGION_JUDGEMENTS, STABILISED_SHARE, judge, region,
};
use handstand::synth::controllers::{ControllerDesign, DESIGNS};
use handstand::{Error, Model, Result, output};
use serde::Serialize;
use std::path::PathBuf;

mod list;
mod result;

/// Simulate controllers in closed loop with the robot's non-idealities.
#[derive(Debug, clap::Args)]
pub struct ControllersArgs {
    /// Model file; without it, what there is
    model: Option<PathBuf>,
    /// A controller to try, by name; all without it
    #[arg(long = "controller", value_name = "NAME")]
    controllers: Vec<String>,
    #[command(flatten)]
    gains: GainsChoice,
    /// A condition, by name; all without it
    #[arg(long = "condition", value_name = "NAME")]
    conditions: Vec<String>,
    /// Robots let go in each trial
    #[arg(long, value_name = "N", default_value_t = 1000)]
    #[arg(value_parser = clap::value_parser!(u32).range(1..))]
    robots: u32,
    /// Robots in each step of the search for the region; 0 leaves it out
    #[arg(long, value_name = "N", default_value_t = 100)]
    region_robots: u32,
    /// Largest angle of each joint at the start, deg
    #[arg(long, value_name = "DEG", default_value_t = 2.0, value_parser = input::positive)]
    spread_deg: f64,
    /// Seconds each robot runs, above 2
    #[arg(long, value_name = "S", default_value_t = 5.0, value_parser = input::positive)]
    seconds: f64,
    /// Sampling time, s
    #[arg(long, value_name = "S", default_value_t = 0.01, value_parser = input::positive)]
    ts: f64,
    /// Seed of the robots
    #[arg(long, value_name = "N", default_value_t = 1)]
    seed: u64,
    /// Write the figures as a table
    #[arg(long, value_name = "FILE.csv")]
    csv: Option<PathBuf>,
    /// Draw the shares that were stabilised
    #[arg(long, value_name = "FILE.svg")]
    plot: Option<PathBuf>,
    /// Replace the files if they exist
    #[arg(long)]
    force: bool,
}

/// A controller under a condition.
#[derive(Serialize)]
struct ControllerTrial {
    controller: &'static str,
    condition: &'static str,
    robots: usize,
    stabilised: f64,
    /// Runs that stay without any command: not among the stabilised.
    held: usize,
    fallen: f64,
    rms_angle_rad: Option<f64>,
    limit_cycle_rad: Option<f64>,
    rms_torque_nm: Option<f64>,
    region_rad: Option<f64>,
    region_open: Option<bool>,
}

/// Lists or tries.
pub fn run(args: &ControllersArgs, console: &Console) -> Result<ExitStatus> {
    let Some(file) = &args.model else {
        return list::run(console);
    };
    let designs = chosen_designs(&args.controllers)?;
    let conditions = chosen_conditions(&args.conditions)?;
    if args.seconds <= 2.0 {
        let seconds = args.seconds;
        return Err(Error::usage(
            format!("--seconds {seconds}: a robot is judged by its last 2 s"),
            "give more than 2",
        ));
    }
    for file in args.csv.iter().chain(&args.plot) {
        output::vacant(file, args.force)?;
    }
    let model = Model::load(file)?;
    let designs = args
        .gains
        .designs(&args.controllers, designs, (&model, args.ts))?;
    show::omitted(&model, console)?;
    let trials = trials(args, &model, &designs, &conditions, console)?;
    if let Some(file) = &args.csv {
        output::write_new(file, &result::csv(&trials), args.force)?;
    }
    if let Some(file) = &args.plot {
        let plot = result::plot(&trials, &designs, &conditions);
        output::write_new(file, &plot, args.force)?;
    }
    console.result(&trials, || result::text(&trials, &designs, &conditions))?;
    let answered = |condition: &&LoopCondition| {
        let mut own = trials.iter().filter(|t| t.condition == condition.id);
        own.any(|trial| trial.stabilised >= STABILISED_SHARE)
    };
    Ok(ExitStatus::answer(conditions.iter().all(answered)))
}

fn trials(
    args: &ControllersArgs,
    model: &Model,
    designs: &[&'static dyn ControllerDesign],
    conditions: &[&'static LoopCondition],
    console: &Console,
) -> Result<Vec<ControllerTrial>> {
    let judging = Judging {
        runs: args.robots as usize,
        start_rad: args.spread_deg.to_radians(),
        seconds: args.seconds,
        seed: args.seed,
    };
    let few = Judging {
        runs: args.region_robots as usize,
        ..judging
    };
    let each = judging.runs + REGION_JUDGEMENTS * few.runs;
    let bar = console.bar((each * designs.len() * conditions.len()) as u64);
    let mut trials = Vec::new();
    for condition in conditions {
        for design in designs {
            bar.set_message(format!("{} under {}", design.info().title, condition.title));
            let done = || bar.inc(1);
            let mut case = Case::ideal(model.clone(), *design, args.ts);
            args.gains.weigh(&mut case)?;
            let uncertain = condition.apply(&mut case);
            let figures = judge(&case, &uncertain, &judging, &done)?;
            let region = match few.runs {
                0 => None,
                _ => Some(region(&case, &uncertain, &few, &done)?),
            };
            trials.push(ControllerTrial {
                controller: design.info().id,
                condition: condition.id,
                robots: figures.runs,
                stabilised: figures.stabilised_share,
                held: figures.held,
                fallen: figures.fallen_share,
                rms_angle_rad: figures.rms_angle_rad,
                limit_cycle_rad: figures.limit_cycle_rad,
                rms_torque_nm: figures.rms_torque_nm,
                region_rad: region.map(|region| region.spread_rad),
                region_open: region.map(|region| region.open),
            });
            bar.set_position((each * trials.len()) as u64);
        }
    }
    Ok(trials)
}

/// The controllers of these names; all where none is named.
///
/// # Errors
/// An unknown name.
pub fn chosen_designs(names: &[String]) -> Result<Vec<&'static dyn ControllerDesign>> {
    chosen("controller", names, DESIGNS.iter().copied(), |design| {
        design.info().id
    })
}

/// The conditions of these names; all where none is named.
///
/// # Errors
/// An unknown name.
pub fn chosen_conditions(names: &[String]) -> Result<Vec<&'static LoopCondition>> {
    chosen("condition", names, CONDITIONS.iter(), |condition| {
        condition.id
    })
}

fn chosen<T: Copy>(
    what: &str,
    names: &[String],
    all: impl Iterator<Item = T>,
    id: impl Fn(T) -> &'static str,
) -> Result<Vec<T>> {
    let all: Vec<T> = all.collect();
    let one = |name: &String| {
        let found = all.iter().copied().find(|one| id(*one) == name);
        found.ok_or_else(|| {
            let known: Vec<&str> = all.iter().map(|one| id(*one)).collect();
            Error::usage(
                format!("there is no {what} `{name}`"),
                format!("one of these: {}", known.join(", ")),
            )
        })
    };
    match names {
        [] => Ok(all),
        names => names.iter().map(one).collect(),
    }
}
