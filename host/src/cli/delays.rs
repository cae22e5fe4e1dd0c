//! `handstand delays MODEL`: the longest delay each controller survives, and whether the robot's is shorter.
//!
//! Four figures for each controller, in ms. In the linear loop with the nominal plant: told there is no delay, told
//! one sample, told each delay as it comes. In simulation: told each delay, how long it holds 95 % of the robots under
//! `--condition` (all troubles at once). Every shorter delay of the search is survived too, except where a shortest one
//! is given: told one sample, a controller may need that delay.
//!
//! Then the ways from sample to torque, what each takes with and without the servo's own dead time (17 to 50 ms), how
//! many controllers are stable with that, and which hold the robots.
//!
//! ```console
//! $ handstand delays handstand.toml --controller dlqr --controller best
//! ```
//!
//! `--json` prints `controllers` (`controller`, `untold`, `told_one_sample`, `told`, `held`, each with
//! `shortest_s`, `delay_s` and `open`) and `chains` (`chain`, `bus_s`, `line_s`, `servo_s`, `total_s`, `stable`, `held`: the
//! controllers that survive the total, told it).

use super::controllers::{chosen_conditions, chosen_designs};
use super::talk::Talk;
use super::{Outcome, input, show};
use handstand::controllers::{
    CHAINS, Chain, Design, Known, Longest, Robots, SERVO_DEAD_TIME_S, longest_held, longest_linear,
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
    /// What else troubles the simulated robots
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

/// What a controller survives.
struct Row {
    design: &'static dyn Design,
    untold: Longest,
    one: Longest,
    told: Longest,
    held: Option<Longest>,
}

/// Searches and prints.
pub fn run(args: &Args, talk: &Talk) -> Result<Outcome> {
    let designs = chosen_designs(&args.controllers)?;
    let model = Model::load(&args.model)?;
    let rows = search(args, &model, &designs, talk)?;
    if talk.json {
        let chains: Vec<_> = CHAINS
            .iter()
            .flat_map(|chain| chain_data(chain, &rows))
            .collect();
        let controllers: Vec<_> = rows
            .iter()
            .map(|row| {
                json!({
                    "controller": row.design.card().id,
                    "untold": row.untold,
                    "told_one_sample": row.one,
                    "told": row.told,
                    "held": row.held,
                })
            })
            .collect();
        talk.data(&json!({ "controllers": controllers, "chains": chains }))?;
    } else {
        talk.print(&text(&rows, args))?;
    }
    Ok(Outcome::Done)
}

fn search(
    args: &Args,
    model: &Model,
    designs: &[&'static dyn Design],
    talk: &Talk,
) -> Result<Vec<Row>> {
    let pose_rad = upright(model);
    let known = Known::ideal(model, &pose_rad, args.ts)?;
    let conditions = chosen_conditions(std::slice::from_ref(&args.condition))?;
    let robots = Robots {
        model,
        pose_rad: &pose_rad,
        period_s: args.ts,
        count: args.robots as usize,
        spread_rad: 2f64.to_radians(),
        seconds: 5.0,
        seed: args.seed,
    };
    let (step_s, until_s) = (1e-3 * args.step_ms, 1e-3 * args.until_ms);
    let bar = talk.bar();
    bar.set_length(designs.len() as u64);
    let mut rows = Vec::new();
    for design in designs {
        bar.set_message(design.card().title.to_string());
        let linear = |told: Option<f64>| longest_linear(*design, &known, told, step_s, until_s);
        let (untold, one, told) = (linear(Some(0.0))?, linear(Some(args.ts))?, linear(None)?);
        let held = match args.robots {
            0 => None,
            _ => Some(longest_held(
                *design,
                &robots,
                conditions[0],
                &known,
                5.0 * step_s,
                until_s,
            )?),
        };
        rows.push(Row {
            design: *design,
            untold,
            one,
            told,
            held,
        });
        bar.inc(1);
    }
    bar.finish_and_clear();
    Ok(rows)
}

fn text(rows: &[Row], args: &Args) -> String {
    let mut table = show::table([
        "Controller",
        "told none",
        "told one sample",
        "told",
        "held, told",
    ]);
    for row in rows {
        table.add_row([
            row.design.card().id.to_string(),
            ms(row.untold),
            ms(row.one),
            ms(row.told),
            row.held.map_or(String::new(), ms),
        ]);
    }
    let mut chains = show::table(["From sample to torque", "ms", "stable", "held, told"]);
    for chain in CHAINS {
        for dead_s in std::iter::once(0.0).chain(SERVO_DEAD_TIME_S) {
            let total_s = chain.total_s() + dead_s;
            let title = match dead_s {
                0.0 => chain.title.to_string(),
                dead_s => format!("  and a servo's dead time of {:.0} ms", 1e3 * dead_s),
            };
            let stable = survivors(rows, total_s, |row| Some(row.told)).len();
            chains.add_row([
                title,
                format!("{:.1}", 1e3 * total_s),
                format!("{stable} of {}", rows.len()),
                names(survivors(rows, total_s, |row| row.held)),
            ]);
        }
    }
    format!(
        "Longest delay survived, ms; the linear loop, and robots held 95 % under `{}`:\n{table}\n\n{chains}",
        args.condition
    )
}

fn survivors(
    rows: &[Row],
    delay_s: f64,
    longest: impl Fn(&Row) -> Option<Longest>,
) -> Vec<&'static str> {
    let survives = |row: &&Row| longest(row).is_some_and(|longest| longest.survives(delay_s));
    rows.iter()
        .filter(survives)
        .map(|row| row.design.card().id)
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

fn chain_data(chain: &Chain, rows: &[Row]) -> Vec<serde_json::Value> {
    let with = |dead_s: f64| {
        let total_s = chain.total_s() + dead_s;
        json!({
            "chain": chain.title,
            "bus_s": chain.bus_s(),
            "line_s": chain.line_s(),
            "servo_s": dead_s,
            "total_s": total_s,
            "stable": survivors(rows, total_s, |row| Some(row.told)),
            "held": survivors(rows, total_s, |row| row.held),
        })
    };
    std::iter::once(0.0)
        .chain(SERVO_DEAD_TIME_S)
        .map(with)
        .collect()
}
