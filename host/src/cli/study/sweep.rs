//! `handstand study sweep [NAME]... [--controller NAME] [--study FILE] [-o FOLDER]`: one quantity
//! varied, one table each.
//!
//! Every level is run from the same seeded random starts, and tilted until it is not stabilised.
//! With `-o` each sweep leaves `NAME.csv` and `NAME.svg`. Without names, lists the quantities that
//! can be swept.
//!
//! `--json` prints a list of sweeps: `sweep`, `unit`, `levels` (`level`, `label`, `figures`,
//! `tilt_border_rad`, `refused`); without names, of quantities: `id`, `unit`, `meaning`, `levels`.

use crate::cli::gains_choice::GainsChoice;
use crate::cli::show::{self, or_dash, table, table_of};
use crate::cli::{Console, ExitStatus};
use handstand::output::number::exact;
use handstand::output::table::or_empty;
use handstand::report::sweep_svg;
use handstand::report::table::{columns_of, csv_of};
use handstand::study::{Figures, Level, Levels, Quantity, Study, Sweep, quantity, sweep, sweeps};
use handstand::synth::controllers::{DESIGNS, design};
use handstand::{Error, Result, output};
use serde_json::json;
use std::path::PathBuf;

/// Sweep one parameter of the closed loop.
#[derive(Debug, clap::Args)]
pub struct SweepArgs {
    /// Sweeps, or `all`
    #[arg(value_name = "NAME", value_parser = known)]
    names: Vec<String>,
    /// Study file; the paper's robot under ideal circumstances without one
    #[arg(long, value_name = "FILE.toml")]
    study: Option<PathBuf>,
    /// Controller instead of the study's
    #[arg(long, value_name = "NAME", value_parser = controller, conflicts_with = "plan")]
    controller: Option<&'static str>,
    #[command(flatten)]
    gains: GainsChoice,
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
pub fn run(args: &SweepArgs, console: &Console) -> Result<ExitStatus> {
    if args.names.is_empty() {
        return list(console);
    }
    let chosen: Vec<Swept> = if args.names.iter().any(|name| name == "all") {
        sweeps().collect()
    } else {
        args.names.iter().filter_map(|name| named(name)).collect()
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
    args.gains.put_into(&mut study.case)?;
    if let Some(folder) = &args.output {
        super::write::folder(folder)?;
        for (quantity, _) in &chosen {
            for ending in ["csv", "svg"] {
                let file = folder.join(format!("{}.{ending}", quantity.id));
                output::vacant(&file, args.force)?;
            }
        }
    }
    let levels = |levels: &Levels| {
        if args.levels.is_empty() {
            levels.values.to_vec()
        } else {
            args.levels.clone()
        }
    };
    let bar = console.bar(chosen.iter().map(|(_, own)| levels(own).len() as u64).sum());
    let mut all = Vec::new();
    for one in chosen {
        bar.set_message(one.0.title);
        let ran = sweep(one, &levels(one.1), &study.case, &study.judging, || {
            bar.inc(1)
        })?;
        if !console.json {
            bar.suspend(|| console.print(&shown(one, &ran)))?;
        }
        if let Some(folder) = &args.output {
            let file = |ending: &str| folder.join(format!("{}.{ending}", one.0.id));
            output::write_new(&file("csv"), &csv(&ran), args.force)?;
            let svg = sweep_svg(one, &ran, &study.case.nominal.name);
            output::write_new(&file("svg"), &svg, args.force)?;
        }
        all.push(ran);
    }
    drop(bar);
    if console.json {
        console.data(&all)?;
    }
    if let Some((ran, why)) = all.iter().find_map(|ran| Some((ran, ran.refused()?))) {
        return Err(Error::design(
            format!("no level of {} has a controller: {why}", ran.sweep),
            "design for another model, sampling time or controller, or sweep other levels",
        ));
    }
    Ok(ExitStatus::Done)
}

fn list(console: &Console) -> Result<ExitStatus> {
    let data = sweeps().map(|(quantity, levels)| {
        json!({
            "id": quantity.id,
            "unit": levels.unit,
            "meaning": quantity.meaning,
            "levels": levels.values,
        })
    });
    console.result(&data.collect::<Vec<_>>(), || {
        let mut table = table(["Sweep", "Unit", "What is varied"]);
        let rows = sweeps().map(|(quantity, levels)| [quantity.id, levels.unit, quantity.meaning]);
        table.add_rows(rows);
        table.to_string()
    })?;
    Ok(ExitStatus::Done)
}

/// The levels as a table, and why some have no controller.
fn shown((quantity, levels): Swept, ran: &Sweep) -> String {
    let level = match levels.unit {
        "" => quantity.title.to_string(),
        unit => format!("{}, {unit}", quantity.title),
    };
    let figure = |level: &Level, of: fn(&Figures) -> Option<f64>| {
        or_dash(level.figures.as_ref().and_then(of), exact)
    };
    let share = |level: &Level, of: fn(&Figures) -> String| or_dash(level.figures.as_ref(), of);
    let degrees = |rad: f64| format!("{:.1}", rad.to_degrees());
    let columns = columns_of::<Level>()
        .text(level, |l| l.label.clone())
        .text("stabilised", |l| share(l, |f| percent(f.stabilised_share)))
        .text("95 % interval", |l| share(l, stabilised_interval))
        .text("tilt, deg", |l| or_dash(l.tilt_border_rad, degrees))
        .text("rms, deg", |l| {
            figure(l, |f| f.rms_angle_rad.map(f64::to_degrees))
        })
        .text("cycle, deg", |l| {
            figure(l, |f| f.limit_cycle_rad.map(f64::to_degrees))
        })
        .text("torque, N m", |l| figure(l, |f| f.rms_torque_nm))
        .text("settles, s", |l| figure(l, |f| f.settle_s));
    let refused = ran.levels.iter().filter_map(|level| {
        let why = level.refused.as_ref()?;
        Some(format!("{}: no controller, {why}", level.label))
    });
    let figures = ran.levels.iter().filter_map(|level| level.figures);
    let held = show::held(figures.map(|figures| figures.held).sum());
    let refused: Vec<String> = refused.chain(held).collect();
    format!(
        "{}\n{}\n",
        table_of(&ran.levels, &columns),
        refused.join("\n")
    )
}

fn percent(share: f64) -> String {
    format!("{:.0} %", 100.0 * share)
}

fn stabilised_interval(figures: &Figures) -> String {
    let low = 100.0 * figures.stabilised_low;
    format!("{low:.0} to {}", percent(figures.stabilised_high))
}

fn csv(ran: &Sweep) -> String {
    let figure = |level: &Level, of: fn(&Figures) -> Option<f64>| {
        or_empty(level.figures.as_ref().and_then(of))
    };
    let columns = columns_of::<Level>()
        .text("level", |l| l.level.to_string())
        .text("unit", |_| ran.unit.to_string())
        .text("runs", |l| figure(l, |f| Some(f.runs as f64)))
        .text("stabilised", |l| figure(l, |f| Some(f.stabilised as f64)))
        .text("stabilised_share", |l| {
            figure(l, |f| Some(f.stabilised_share))
        })
        .text("stabilised_low", |l| figure(l, |f| Some(f.stabilised_low)))
        .text("stabilised_high", |l| {
            figure(l, |f| Some(f.stabilised_high))
        })
        .text("tilt_border_rad", |l| or_empty(l.tilt_border_rad))
        .text("rms_angle_rad", |l| figure(l, |f| f.rms_angle_rad))
        .text("rms_torque_nm", |l| figure(l, |f| f.rms_torque_nm))
        .text("limit_cycle_rad", |l| figure(l, |f| f.limit_cycle_rad))
        .text("settle_s", |l| figure(l, |f| f.settle_s));
    csv_of(&ran.levels, &columns)
}
