//! `handstand controllers [MODEL]`: the library's controllers, simulated on robots with the
//! non-idealities that the paper found.
//!
//! Without a model, a line for each controller and each condition. With one: from each of
//! `--robots` random starts at rest, within `--spread-deg` of the pose in each angle, every
//! controller under every condition. A robot is stabilised if no link leans more than 45 deg and
//! every joint stays within 10 deg of the pose over the last two seconds. The region is the largest
//! spread of starts of which 95 % are stabilised. Every effect of the model acts in the simulation;
//! the designs leave out those without a derivative.
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
//! `controller`, `condition`, `robots`, `stabilised`, `fallen`, `rms_angle_rad`, `limit_cycle_rad`,
//! `rms_torque_nm`, `region_rad`, `region_open`.

use super::talk::Talk;
use super::{Outcome, input, show};
use handstand::controllers::{ControllerDesign, DESIGNS, design};
use handstand::study::{
    CONDITIONS, Case, Condition, Figures, Judging, REGION_JUDGEMENTS, Region, STABILISED_SHARE,
    condition, judge, region,
};
use handstand::{Error, Model, Result, output};
use std::path::PathBuf;

mod list;
mod result;

/// Simulate controllers in closed loop with the robot's non-idealities.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// Model file; without it, what there is
    model: Option<PathBuf>,
    /// A controller to try, by name; all without it
    #[arg(long = "controller", value_name = "NAME")]
    controllers: Vec<String>,
    /// A condition, by name; all without it
    #[arg(long = "condition", value_name = "NAME")]
    conditions: Vec<String>,
    /// Robots let go in each trial
    #[arg(long, value_name = "N", default_value_t = 1000, value_parser = clap::value_parser!(u32).range(1..))]
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
struct Row {
    design: &'static dyn ControllerDesign,
    condition: &'static Condition,
    figures: Figures,
    region: Option<Region>,
}

/// Lists or tries.
pub fn run(args: &Args, talk: &Talk) -> Result<Outcome> {
    let Some(file) = &args.model else {
        return list::run(talk);
    };
    let (designs, conditions) = (
        chosen_designs(&args.controllers)?,
        chosen_conditions(&args.conditions)?,
    );
    if args.seconds <= 2.0 {
        return Err(Error::usage(
            format!(
                "--seconds {}: a robot is judged by its last 2 s",
                args.seconds
            ),
            "give more than 2",
        ));
    }
    for file in args.csv.iter().chain(&args.plot) {
        input::vacant(file, args.force)?;
    }
    let model = Model::load(file)?;
    show::omitted(&model, talk)?;
    let rows = trials(args, &model, &designs, &conditions, talk)?;
    if let Some(file) = &args.csv {
        output::write_new(file, &result::csv(&rows), args.force)?;
    }
    if let Some(file) = &args.plot {
        output::write_new(
            file,
            &result::plot(&rows, &designs, &conditions),
            args.force,
        )?;
    }
    if talk.json {
        talk.data(&rows.iter().map(result::data).collect::<Vec<_>>())?;
    } else {
        talk.print(&result::text(&rows, &designs, &conditions))?;
    }
    let answered = |condition: &&Condition| {
        rows.iter().any(|row| {
            row.condition.id == condition.id && row.figures.stabilised_share >= STABILISED_SHARE
        })
    };
    Ok(match conditions.iter().all(answered) {
        true => Outcome::Done,
        false => Outcome::Refused,
    })
}

fn trials(
    args: &Args,
    model: &Model,
    designs: &[&'static dyn ControllerDesign],
    conditions: &[&'static Condition],
    talk: &Talk,
) -> Result<Vec<Row>> {
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
    let bar = talk.bar();
    let each = judging.runs + REGION_JUDGEMENTS * few.runs;
    bar.set_length((each * designs.len() * conditions.len()) as u64);
    let mut rows = Vec::new();
    for condition in conditions {
        for design in designs {
            bar.set_message(format!("{} under {}", design.info().title, condition.title));
            let done = || bar.inc(1);
            let mut case = Case::ideal(model.clone(), *design, args.ts);
            let uncertain = condition.apply(&mut case);
            rows.push(Row {
                design: *design,
                condition,
                figures: judge(&case, &uncertain, &judging, &done)?,
                region: match few.runs {
                    0 => None,
                    _ => Some(region(&case, &uncertain, &few, &done)?),
                },
            });
            bar.set_position((each * rows.len()) as u64);
        }
    }
    bar.finish_and_clear();
    Ok(rows)
}

/// The controllers of these names, all without any.
pub fn chosen_designs(names: &[String]) -> Result<Vec<&'static dyn ControllerDesign>> {
    if names.is_empty() {
        return Ok(DESIGNS.to_vec());
    }
    let one = |name: &String| {
        design(name).ok_or_else(|| {
            unknown(
                "controller",
                name,
                DESIGNS.iter().map(|design| design.info().id),
            )
        })
    };
    names.iter().map(one).collect()
}

/// The conditions of these names, all without any.
pub fn chosen_conditions(names: &[String]) -> Result<Vec<&'static Condition>> {
    if names.is_empty() {
        return Ok(CONDITIONS.iter().collect());
    }
    let one = |name: &String| {
        condition(name).ok_or_else(|| {
            unknown(
                "condition",
                name,
                CONDITIONS.iter().map(|condition| condition.id),
            )
        })
    };
    names.iter().map(one).collect()
}

fn unknown<'a>(what: &str, name: &str, known: impl Iterator<Item = &'a str>) -> Error {
    Error::usage(
        format!("there is no {what} `{name}`"),
        format!("one of these: {}", known.collect::<Vec<_>>().join(", ")),
    )
}
