//! `handstand controllers [MODEL]`: the controllers the library knows, tried on robots under everything the paper found.
//!
//! Without a model, a line for each controller and each condition. With one: from each of `--robots` random starts at
//! rest, within `--spread-deg` of the pose in each angle, every controller under every condition. Held is who never
//! leans a link more than 45 deg and keeps every joint within 10 deg of the pose over the last two seconds. The region
//! is the largest spread of starts of which 95 % are held.
//!
//! A controller knows the nominal model and what can be measured beforehand (sampling time, delay, nominal dead zone,
//! limit, resolutions); it does not know a robot's own dead zone (within a fifth of 10 %), where its masses lie beside
//! their lines (within 2 mm), or what they weigh (within 10 %), unless its page says so.
//!
//! ```console
//! $ handstand controllers handstand.toml --robots 200 --condition all
//! ```
//!
//! Exit code 1 when under some condition no controller holds 95 %. `--json` prints a list of `controller`,
//! `condition`, `robots`, `held`, `fell`, `rms_angle_rad`, `swing_rad`, `rms_torque_nm`, `region_rad`, `region_open`.

use super::talk::Talk;
use super::{Outcome, input, show};
use handstand::controllers::{
    CONDITIONS, Condition, DESIGNS, Design, Known, REGION_RUNS, Region, Robots, Speeds, Tried,
    condition, design, picture, region, try_out,
};
use handstand::synth::upright;
use handstand::{Error, Model, Result, output};
use serde_json::{Value, json};
use std::path::PathBuf;

/// Try controllers under everything the robot does to them.
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
    /// Draw the shares that were held
    #[arg(long, value_name = "FILE.svg")]
    plot: Option<PathBuf>,
    /// Replace the files if they exist
    #[arg(long)]
    force: bool,
}

/// A controller under a condition.
struct Row {
    design: &'static dyn Design,
    condition: &'static Condition,
    tried: Tried,
    region: Option<Region>,
}

/// Lists or tries.
pub fn run(args: &Args, talk: &Talk) -> Result<Outcome> {
    let Some(file) = &args.model else {
        return list(talk);
    };
    let (designs, conditions) = (
        chosen_designs(&args.controllers)?,
        chosen_conditions(&args.conditions)?,
    );
    if args.seconds <= 2.0 {
        return Err(Error::usage(
            format!(
                "--seconds {}: held is who stands still for the last 2 s",
                args.seconds
            ),
            "give more than 2",
        ));
    }
    for file in args.csv.iter().chain(&args.plot) {
        input::vacant(file, args.force)?;
    }
    let model = Model::load(file)?;
    let rows = trials(args, &model, &designs, &conditions, talk)?;
    if let Some(file) = &args.csv {
        output::write_new(file, &csv(&rows), args.force)?;
    }
    if let Some(file) = &args.plot {
        output::write_new(file, &plot(&rows, &designs, &conditions), args.force)?;
    }
    if talk.json {
        talk.data(&rows.iter().map(data).collect::<Vec<_>>())?;
    } else {
        talk.print(&text(&rows, &designs, &conditions))?;
    }
    let answered = |condition: &&Condition| {
        rows.iter()
            .any(|row| row.condition.id == condition.id && row.tried.held >= 0.95)
    };
    Ok(match conditions.iter().all(answered) {
        true => Outcome::Done,
        false => Outcome::Refused,
    })
}

fn trials(
    args: &Args,
    model: &Model,
    designs: &[&'static dyn Design],
    conditions: &[&'static Condition],
    talk: &Talk,
) -> Result<Vec<Row>> {
    let pose_rad = upright(model);
    let ideal = Known::ideal(model, &pose_rad, args.ts)?;
    let robots = Robots {
        model,
        pose_rad: &pose_rad,
        period_s: args.ts,
        count: args.robots as usize,
        spread_rad: args.spread_deg.to_radians(),
        seconds: args.seconds,
        seed: args.seed,
    };
    let few = Robots {
        count: args.region_robots as usize,
        ..robots.clone()
    };
    let bar = talk.bar();
    let each = robots.count + REGION_RUNS * few.count;
    bar.set_length((each * designs.len() * conditions.len()) as u64);
    let mut rows = Vec::new();
    for condition in conditions {
        let known = condition.tell(&ideal);
        for design in designs {
            bar.set_message(format!("{} under {}", design.card().title, condition.title));
            let done = || bar.inc(1);
            rows.push(Row {
                design: *design,
                condition,
                tried: try_out(&robots, *design, condition, &known, &done)?,
                region: match few.count {
                    0 => None,
                    _ => Some(region(&few, *design, condition, &known, &done)?),
                },
            });
            bar.set_position((each * rows.len()) as u64);
        }
    }
    bar.finish_and_clear();
    Ok(rows)
}

/// Three tables: who is held, from how far, and how well under the last condition.
fn text(
    rows: &[Row],
    designs: &[&'static dyn Design],
    conditions: &[&'static Condition],
) -> String {
    let mut parts = vec![format!(
        "Robots held, % of {}:\n{}",
        rows.first().map_or(0, |row| row.tried.robots),
        matrix(rows, designs, conditions, |row| percent(row.tried.held))
    )];
    if rows.iter().any(|row| row.region.is_some()) {
        parts.push(format!(
            "Region: largest spread of starts of which 95 % are held, deg:\n{}",
            matrix(rows, designs, conditions, |row| row
                .region
                .map_or(String::new(), degrees))
        ));
    }
    for condition in conditions
        .iter()
        .filter(|c| conditions.len() <= 2 || c.id.starts_with("all"))
    {
        let mut table = show::table([
            "Controller",
            "held %",
            "fell %",
            "rms deg",
            "swing deg",
            "rms N m",
        ]);
        for row in rows.iter().filter(|row| row.condition.id == condition.id) {
            table.add_row([
                row.design.card().id.to_string(),
                percent(row.tried.held),
                percent(row.tried.fell),
                known(row.tried.rms_angle_rad.map(f64::to_degrees)),
                known(row.tried.swing_rad.map(f64::to_degrees)),
                known(row.tried.rms_torque_nm),
            ]);
        }
        parts.push(format!("{}, of those held:\n{table}", condition.title));
    }
    parts.join("\n\n")
}

fn matrix(
    rows: &[Row],
    designs: &[&'static dyn Design],
    conditions: &[&'static Condition],
    cell: impl Fn(&Row) -> String,
) -> String {
    let mut table = show::wide_table();
    let header = std::iter::once("").chain(conditions.iter().map(|condition| condition.id));
    table.set_header(header);
    for design in designs {
        let own = rows
            .iter()
            .filter(|row| row.design.card().id == design.card().id);
        table.add_row(std::iter::once(design.card().id.to_string()).chain(own.map(&cell)));
    }
    table.to_string()
}

fn plot(
    rows: &[Row],
    designs: &[&'static dyn Design],
    conditions: &[&'static Condition],
) -> String {
    let ids: Vec<&str> = designs.iter().map(|design| design.card().id).collect();
    let titles: Vec<&str> = conditions.iter().map(|condition| condition.title).collect();
    let fields: Vec<Vec<f64>> = ids
        .iter()
        .map(|id| {
            let own = rows.iter().filter(|row| row.design.card().id == *id);
            own.map(|row| row.tried.held).collect()
        })
        .collect();
    picture(
        "Robots held by each controller under each condition",
        &ids,
        &titles,
        &fields,
    )
}

fn percent(share: f64) -> String {
    format!("{:.1}", 100.0 * share)
}

fn known(value: Option<f64>) -> String {
    value.map_or("-".into(), |value| format!("{value:.2}"))
}

fn degrees(region: Region) -> String {
    let sign = if region.open { ">" } else { "" };
    format!("{sign}{:.1}", region.spread_rad.to_degrees())
}

fn csv(rows: &[Row]) -> String {
    let mut text = String::from(
        "controller,condition,robots,held,fell,rms_angle_rad,swing_rad,rms_torque_nm,region_rad,region_open\n",
    );
    let number = |value: Option<f64>| value.map_or(String::new(), |value| value.to_string());
    for row in rows {
        let fields = [
            row.design.card().id.to_string(),
            row.condition.id.to_string(),
            row.tried.robots.to_string(),
            row.tried.held.to_string(),
            row.tried.fell.to_string(),
            number(row.tried.rms_angle_rad),
            number(row.tried.swing_rad),
            number(row.tried.rms_torque_nm),
            number(row.region.map(|region| region.spread_rad)),
            row.region
                .map_or(String::new(), |region| region.open.to_string()),
        ];
        text += &fields.join(",");
        text.push('\n');
    }
    text
}

fn data(row: &Row) -> Value {
    json!({
        "controller": row.design.card().id,
        "condition": row.condition.id,
        "robots": row.tried.robots,
        "held": row.tried.held,
        "fell": row.tried.fell,
        "rms_angle_rad": row.tried.rms_angle_rad,
        "swing_rad": row.tried.swing_rad,
        "rms_torque_nm": row.tried.rms_torque_nm,
        "region_rad": row.region.map(|region| region.spread_rad),
        "region_open": row.region.map(|region| region.open),
    })
}

fn list(talk: &Talk) -> Result<Outcome> {
    if talk.json {
        let cards = DESIGNS.iter().map(|design| {
            let card = design.card();
            json!({
                "controller": card.id,
                "title": card.title,
                "law": card.law,
                "speeds": speeds(card.speeds),
                "told_balance": card.told_balance,
                "reference": card.reference,
            })
        });
        talk.data(&cards.collect::<Vec<_>>())?;
        return Ok(Outcome::Done);
    }
    let mut table = show::table(["Controller", "What it is", "Speeds", "Told balance"]);
    for design in DESIGNS {
        let card = design.card();
        let told = if card.told_balance { "yes" } else { "" };
        let what = format!("{}\n{}", card.title, card.law);
        table.add_row([card.id, &what, speeds(card.speeds), told]);
    }
    let mut conditions = show::table(["Condition", "What it is"]);
    for condition in CONDITIONS {
        conditions.add_row([condition.id, condition.title]);
    }
    talk.print(&format!("{table}\n\n{conditions}"))?;
    talk.say("`handstand controllers MODEL` tries them");
    Ok(Outcome::Done)
}

fn speeds(speeds: Speeds) -> &'static str {
    match speeds {
        Speeds::True => "true",
        Speeds::Differenced => "differences",
        Speeds::Estimated => "estimated",
    }
}

/// The controllers of these names, all without any.
pub fn chosen_designs(names: &[String]) -> Result<Vec<&'static dyn Design>> {
    if names.is_empty() {
        return Ok(DESIGNS.to_vec());
    }
    let one = |name: &String| {
        design(name).ok_or_else(|| {
            unknown(
                "controller",
                name,
                DESIGNS.iter().map(|design| design.card().id),
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
