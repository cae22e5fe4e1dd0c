//! `handstand delays MODEL`: the longest delay each controller tolerates, and whether the robot's
//! is shorter.
//!
//! Four figures for each controller, in ms. In the linear loop with the nominal plant:
//! uncompensated, designed for a delay of one sample, and designed for each delay as it comes
//! (compensated). In simulation: compensated, up to which delay 95 % of the robots are stabilised
//! under `--condition` (all non-idealities at once). Every shorter delay of the search is tolerated
//! too, except where a shortest one is given: designed for one sample, a controller may need that
//! delay.
//!
//! Then the latency budget: the ways from sample to torque, what each takes with and without the
//! servo's own dead time (17 to 50 ms), how many controllers are stable with that, and which
//! stabilise the robots.
//!
//! ```console
//! $ handstand delays handstand.toml --controller dlqr --controller best
//! ```
//!
//! `--json` prints `controllers` (`controller`, `uncompensated`, `compensated_one_sample`,
//! `compensated`, `stabilised`, each with `shortest_s`, `delay_s` and `open`) and `paths` (`path`,
//! `bus_s`, `line_s`, `servo_s`, `total_s`, `stable`, `stabilised`: the compensated controllers
//! that tolerate the total).

use super::controllers::{chosen_conditions, chosen_designs};
use super::talk::Talk;
use super::{Outcome, input, show};
use handstand::controllers::{ControllerDesign, DesignModel};
use handstand::study::{
    Case, Judging, Longest, SERVO_DEAD_TIME_S, SIGNAL_PATHS, SignalPath, longest_linear,
    longest_stabilised,
};
use handstand::synth::upright;
use handstand::{Model, Result};
use serde_json::json;
use std::path::PathBuf;

/// Find the delay margin of each controller.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// Model file
    model: PathBuf,
    /// A controller, by name; all without it
    #[arg(long = "controller", value_name = "NAME")]
    controllers: Vec<String>,
    /// Condition of the simulated robots
    #[arg(long, value_name = "NAME", default_value = "all")]
    condition: String,
    /// Robots simulated at each delay; 0 leaves the simulation out
    #[arg(long, value_name = "N", default_value_t = 100)]
    robots: u32,
    /// Step of the linear search, ms; the simulated one takes steps five times as long
    #[arg(long, value_name = "MS", default_value_t = 0.5, value_parser = input::positive)]
    step_ms: f64,
    /// Longest delay that is tried, ms
    #[arg(long, value_name = "MS", default_value_t = 100.0, value_parser = input::positive)]
    until_ms: f64,
    /// Sampling time, s
    #[arg(long, value_name = "S", default_value_t = 0.01, value_parser = input::positive)]
    ts: f64,
    /// Seed of the robots
    #[arg(long, value_name = "N", default_value_t = 1)]
    seed: u64,
}

/// The delays that a controller tolerates.
struct Row {
    design: &'static dyn ControllerDesign,
    uncompensated: Longest,
    one_sample: Longest,
    compensated: Longest,
    stabilised: Option<Longest>,
}

/// Searches and prints.
pub fn run(args: &Args, talk: &Talk) -> Result<Outcome> {
    let designs = chosen_designs(&args.controllers)?;
    let model = Model::load(&args.model)?;
    let rows = search(args, &model, &designs, talk)?;
    if talk.json {
        let paths: Vec<_> = SIGNAL_PATHS
            .iter()
            .flat_map(|path| path_data(path, &rows))
            .collect();
        let controllers: Vec<_> = rows
            .iter()
            .map(|row| {
                json!({
                    "controller": row.design.info().id,
                    "uncompensated": row.uncompensated,
                    "compensated_one_sample": row.one_sample,
                    "compensated": row.compensated,
                    "stabilised": row.stabilised,
                })
            })
            .collect();
        talk.data(&json!({ "controllers": controllers, "paths": paths }))?;
    } else {
        talk.print(&text(&rows, args))?;
    }
    Ok(Outcome::Done)
}

fn search(
    args: &Args,
    model: &Model,
    designs: &[&'static dyn ControllerDesign],
    talk: &Talk,
) -> Result<Vec<Row>> {
    let nominal = DesignModel::new(model, &upright(model), args.ts)?;
    let conditions = chosen_conditions(std::slice::from_ref(&args.condition))?;
    let judging = Judging {
        runs: args.robots as usize,
        start_rad: 2f64.to_radians(),
        seconds: 5.0,
        seed: args.seed,
    };
    let (step_s, until_s) = (1e-3 * args.step_ms, 1e-3 * args.until_ms);
    let bar = talk.bar();
    bar.set_length(designs.len() as u64);
    let mut rows = Vec::new();
    for design in designs {
        bar.set_message(design.info().title.to_string());
        let linear =
            |known_s: Option<f64>| longest_linear(*design, &nominal, known_s, step_s, until_s);
        let mut case = Case::ideal(model.clone(), *design, args.ts);
        let uncertain = conditions[0].apply(&mut case);
        rows.push(Row {
            design: *design,
            uncompensated: linear(Some(0.0))?,
            one_sample: linear(Some(args.ts))?,
            compensated: linear(None)?,
            stabilised: match args.robots {
                0 => None,
                _ => Some(longest_stabilised(
                    &case,
                    &uncertain,
                    &judging,
                    5.0 * step_s,
                    until_s,
                )?),
            },
        });
        bar.inc(1);
    }
    bar.finish_and_clear();
    Ok(rows)
}

fn text(rows: &[Row], args: &Args) -> String {
    let mut table = show::table([
        "Controller",
        "uncompensated",
        "one sample compensated",
        "compensated",
        "stabilised, compensated",
    ]);
    for row in rows {
        table.add_row([
            row.design.info().id.to_string(),
            ms(row.uncompensated),
            ms(row.one_sample),
            ms(row.compensated),
            row.stabilised.map_or(String::new(), ms),
        ]);
    }
    let mut paths = show::table([
        "From sample to torque",
        "ms",
        "stable",
        "stabilised, compensated",
    ]);
    for path in SIGNAL_PATHS {
        for dead_s in std::iter::once(0.0).chain(SERVO_DEAD_TIME_S) {
            let total_s = path.total_s() + dead_s;
            let title = match dead_s {
                0.0 => path.title.to_string(),
                dead_s => format!("  and a servo's dead time of {:.0} ms", 1e3 * dead_s),
            };
            let stable = tolerant(rows, total_s, |row| Some(row.compensated)).len();
            paths.add_row([
                title,
                format!("{:.1}", 1e3 * total_s),
                format!("{stable} of {}", rows.len()),
                names(tolerant(rows, total_s, |row| row.stabilised)),
            ]);
        }
    }
    format!(
        "Longest delay tolerated, ms; the linear loop, and 95 % of robots stabilised under `{}`:\n{table}\n\n{paths}",
        args.condition
    )
}

fn tolerant(
    rows: &[Row],
    delay_s: f64,
    longest: impl Fn(&Row) -> Option<Longest>,
) -> Vec<&'static str> {
    let tolerates = |row: &&Row| longest(row).is_some_and(|longest| longest.tolerates(delay_s));
    rows.iter()
        .filter(tolerates)
        .map(|row| row.design.info().id)
        .collect()
}

fn names(names: Vec<&str>) -> String {
    match names.as_slice() {
        [] => "none".into(),
        names => names.join(", "),
    }
}

fn ms(longest: Longest) -> String {
    let (Some(least), Some(most)) = (longest.shortest_s, longest.delay_s) else {
        return "none".into();
    };
    let sign = if longest.open { ">" } else { "" };
    match least {
        0.0 => format!("{sign}{:.1}", 1e3 * most),
        least => format!("{:.1} to {sign}{:.1}", 1e3 * least, 1e3 * most),
    }
}

fn path_data(path: &SignalPath, rows: &[Row]) -> Vec<serde_json::Value> {
    let with = |dead_s: f64| {
        let total_s = path.total_s() + dead_s;
        json!({
            "path": path.title,
            "bus_s": path.bus_s(),
            "line_s": path.line_s(),
            "servo_s": dead_s,
            "total_s": total_s,
            "stable": tolerant(rows, total_s, |row| Some(row.compensated)),
            "stabilised": tolerant(rows, total_s, |row| row.stabilised),
        })
    };
    std::iter::once(0.0)
        .chain(SERVO_DEAD_TIME_S)
        .map(with)
        .collect()
}
