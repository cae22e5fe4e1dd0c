//! `handstand study sweep [NAME]... [--controller NAME] [--study FILE] [-o FOLDER]`: one quantity
//! varied, one table each.
//!
//! Every level is run from the same seeded random starts, and tilted until it is not stabilised.
//! With `-o` each sweep leaves `NAME.csv` and `NAME.svg`. Without names, lists the quantities that
//! can be swept.
//!
//! `--json` prints a list of sweeps: `sweep`, `unit`, `levels` (`level`, `label`, `figures`,
//! `tilt_border_rad`, `refused`); without names, of quantities: `id`, `unit`, `meaning`, `levels`.

use super::super::show::table;
use super::super::{Outcome, input, talk::Talk};
use handstand::controllers::{DESIGNS, design};
use handstand::output::number::exact;
use handstand::study::{Level, Levels, Quantity, Study, Sweep, quantity, sweep, sweep_svg, sweeps};
use handstand::{Error, Result, output};
use serde_json::json;
use std::path::PathBuf;

/// Sweep one parameter of the closed loop.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// Sweeps, or `all`
    #[arg(value_name = "NAME", value_parser = known)]
    names: Vec<String>,
    /// Study file; the paper's robot under ideal circumstances without one
    #[arg(long, value_name = "FILE.toml")]
    study: Option<PathBuf>,
    /// Controller instead of the study's
    #[arg(long, value_name = "NAME", value_parser = controller)]
    controller: Option<&'static str>,
    /// Levels instead of the sweep's own
    #[arg(long, value_delimiter = ',', allow_negative_numbers = true)]
    levels: Vec<f64>,
    /// Runs at each level
    #[arg(long, value_parser = clap::value_parser!(u64).range(1..))]
    runs: Option<u64>,
    /// Seed of robots, starts and noise
    #[arg(long)]
    seed: Option<u64>,
    /// Folder for tables and plots
    #[arg(long, short, value_name = "FOLDER")]
    output: Option<PathBuf>,
    /// Replace files there
    #[arg(long)]
    force: bool,
}

fn known(text: &str) -> Result<String, String> {
    if text == "all" || named(text).is_some() {
        return Ok(text.to_string());
    }
    let names: Vec<&str> = sweeps().map(|(quantity, _)| quantity.id).collect();
    Err(format!("known here: {}, all", names.join(", ")))
}

/// A quantity with the levels at which it is swept.
type Swept = (&'static Quantity, &'static Levels);

fn named(id: &str) -> Option<Swept> {
    let quantity = quantity(id)?;
    Some((quantity, quantity.levels.as_ref()?))
}

fn controller(id: &str) -> Result<&'static str, String> {
    let ids = || DESIGNS.iter().map(|design| design.info().id);
    ids()
        .find(|known| *known == id)
        .ok_or_else(|| format!("one of these: {}", ids().collect::<Vec<_>>().join(", ")))
}

/// Sweeps, prints, writes.
pub fn run(args: &Args, talk: &Talk) -> Result<Outcome> {
    if args.names.is_empty() {
        return list(talk);
    }
    let chosen: Vec<Swept> = match args.names.iter().any(|name| name == "all") {
        true => sweeps().collect(),
        false => args.names.iter().filter_map(|name| named(name)).collect(),
    };
    if !args.levels.is_empty() && chosen.len() > 1 {
        return Err(Error::usage(
            "the same levels for several sweeps",
            "give --levels to one sweep at a time",
        ));
    }
    let mut study = match &args.study {
        Some(file) => Study::load(file)?,
        None => Study::paper()?,
    };
    if let Some(runs) = args.runs {
        study.judging.runs = usize::try_from(runs).unwrap_or(usize::MAX);
    }
    study.judging.seed = args.seed.unwrap_or(study.judging.seed);
    if let Some(design) = args.controller.and_then(design) {
        study.case.control.design = design;
    }
    if let Some(folder) = &args.output {
        for (quantity, _) in &chosen {
            for ending in ["csv", "svg"] {
                let file = folder.join(format!("{}.{ending}", quantity.id));
                input::vacant(&file, args.force)?;
            }
        }
        super::write::folder(folder)?;
    }
    let bar = talk.bar();
    let levels = |levels: &Levels| match args.levels.is_empty() {
        true => levels.values.to_vec(),
        false => args.levels.clone(),
    };
    bar.set_length(chosen.iter().map(|(_, own)| levels(own).len() as u64).sum());
    let mut all = Vec::new();
    for one in chosen {
        bar.set_message(one.0.title);
        let ran = sweep(one, &levels(one.1), &study.case, &study.judging, || {
            bar.inc(1)
        })?;
        if !talk.json {
            bar.suspend(|| talk.print(&shown(one, &ran)))?;
        }
        if let Some(folder) = &args.output {
            let file = |ending: &str| folder.join(format!("{}.{ending}", one.0.id));
            output::write_new(&file("csv"), &csv(&ran), args.force)?;
            let svg = sweep_svg(one, &ran, &study.case.nominal.name);
            output::write_new(&file("svg"), &svg, args.force)?;
        }
        all.push(ran);
    }
    bar.finish_and_clear();
    if talk.json {
        talk.data(&all)?;
    }
    Ok(Outcome::Done)
}

fn list(talk: &Talk) -> Result<Outcome> {
    if talk.json {
        let all = sweeps().map(|(quantity, levels)| {
            json!({
                "id": quantity.id,
                "unit": levels.unit,
                "meaning": quantity.meaning,
                "levels": levels.values,
            })
        });
        talk.data(&all.collect::<Vec<_>>())?;
        return Ok(Outcome::Done);
    }
    let mut rows = table(["Sweep", "Unit", "What is varied"]);
    for (quantity, levels) in sweeps() {
        rows.add_row([quantity.id, levels.unit, quantity.meaning]);
    }
    talk.print(&rows.to_string())?;
    Ok(Outcome::Done)
}

fn shown((quantity, levels): Swept, ran: &Sweep) -> String {
    let level = match levels.unit {
        "" => quantity.title.to_string(),
        unit => format!("{}, {unit}", quantity.title),
    };
    let mut rows = table([
        level.as_str(),
        "stabilised",
        "95 % interval",
        "tilt, deg",
        "rms, deg",
        "cycle, deg",
        "torque, N m",
        "settles, s",
    ]);
    for level in &ran.levels {
        rows.add_row(cells(level));
    }
    let refused = ran.levels.iter().filter_map(|level| {
        let why = level.refused.as_ref()?;
        Some(format!("{}: no controller, {why}", level.label))
    });
    let refused: Vec<String> = refused.collect();
    format!("{rows}\n{}\n", refused.join("\n"))
}

fn cells(level: &Level) -> Vec<String> {
    let Some(figures) = &level.figures else {
        let mut cells = vec![level.label.clone()];
        cells.resize(8, "–".to_string());
        return cells;
    };
    let or = |value: Option<f64>| value.map_or("–".to_string(), exact);
    let degrees = |rad: Option<f64>| or(rad.map(f64::to_degrees));
    let percent = |share: f64| format!("{:.0} %", 100.0 * share);
    vec![
        level.label.clone(),
        percent(figures.stabilised_share),
        format!(
            "{:.0} to {}",
            100.0 * figures.stabilised_low,
            percent(figures.stabilised_high)
        ),
        level
            .tilt_border_rad
            .map_or("–".to_string(), |rad| format!("{:.1}", rad.to_degrees())),
        degrees(figures.rms_angle_rad),
        degrees(figures.limit_cycle_rad),
        or(figures.rms_torque_nm),
        or(figures.settle_s),
    ]
}

fn csv(ran: &Sweep) -> String {
    let mut text = String::from(
        "level,unit,runs,stabilised,stabilised_share,stabilised_low,stabilised_high,tilt_border_rad,rms_angle_rad,rms_torque_nm,limit_cycle_rad,settle_s\n",
    );
    for level in &ran.levels {
        let Some(f) = &level.figures else {
            text += &format!("{},{},,,,,,,,,,\n", level.level, ran.unit);
            continue;
        };
        let or = |value: Option<f64>| value.map_or(String::new(), |value| value.to_string());
        let fields = [
            level.level.to_string(),
            ran.unit.to_string(),
            f.runs.to_string(),
            f.stabilised.to_string(),
            f.stabilised_share.to_string(),
            f.stabilised_low.to_string(),
            f.stabilised_high.to_string(),
            or(level.tilt_border_rad),
            or(f.rms_angle_rad),
            or(f.rms_torque_nm),
            or(f.limit_cycle_rad),
            or(f.settle_s),
        ];
        text += &fields.join(",");
        text.push('\n');
    }
    text
}
