//! `handstand map dead-zone LOG...`, `handstand map supply LOG...`: what a servo does at rest.
//!
//! `dead-zone` fits a dead zone, a line on either side and, where one is seen, a limit, from
//! commanded to measured speed or torque, and turns the map round: which command makes which
//! output. `supply` fits the relative speed error as a line over the supply voltage, and says at
//! which supply the speed is right.
//!
//! ```console
//! $ handstand map dead-zone ramp.csv --time t=s --input command=% --output angle=deg
//! $ handstand map supply runs.csv --time t=s --input goal=rad/s --output angle=deg \
//!     --supply volts=V
//! ```
//!
//! Both work on means over blocks of time, so record slowly: an input that changes within a block
//! blurs the edge.

use super::servo_columns::ServoColumns;
use super::show::{self, known};
use super::{Console, ExitStatus, input};
use handstand::error::Problem;
use handstand::log::{LogRequest, read};
use handstand::output::number::exact;
use handstand::sysid::{BlockMean, DeadZoneMap, IntervalEstimate, Side, SupplyLine, blocks};
use handstand::{Error, Result};
use serde_json::json;

/// What can be mapped.
#[derive(Debug, clap::Subcommand)]
pub enum MapCommand {
    /// Estimate dead zone, slope and limit from command to speed or torque, and the inverse map
    DeadZone(MapArgs),
    /// Estimate the relative speed error over the supply voltage
    Supply(MapArgs),
}

/// What to map.
#[derive(Debug, clap::Args)]
pub struct MapArgs {
    /// Logs
    #[arg(required = true, value_name = "LOG", value_parser = input::log)]
    logs: Vec<LogRequest>,
    /// Seconds to average over
    #[arg(long, value_name = "SECONDS", default_value_t = 0.2)]
    block: f64,
    #[command(flatten)]
    columns: ServoColumns,
}

/// Fits and prints.
pub fn run(command: &MapCommand, console: &Console) -> Result<ExitStatus> {
    match command {
        MapCommand::DeadZone(args) => dead_zone(args, console),
        MapCommand::Supply(args) => supply(args, console),
    }
}

/// Means of the logs, and the units of input and output.
fn measured(args: &MapArgs) -> Result<(Vec<BlockMean>, &'static str, &'static str)> {
    if !(args.block > 0.0 && args.block.is_finite()) {
        return Err(Error::usage(
            format!("blocks of {} s", args.block),
            "give a length above 0, such as --block 0.2",
        ));
    }
    let chosen = args.columns.chosen()?;
    let motions = read(&args.logs, &chosen.columns)?;
    let blocks = blocks(&motions, chosen.joint, chosen.output, args.block);
    Ok((blocks, chosen.input_unit, chosen.output_unit))
}

fn dead_zone(args: &MapArgs, console: &Console) -> Result<ExitStatus> {
    let (blocks, input_unit, output_unit) = measured(args)?;
    let map = match DeadZoneMap::fit(&blocks) {
        Ok(map) => map,
        Err(why) => return refused(&why, console),
    };
    let data = json!({
        "input_unit": input_unit,
        "output_unit": output_unit,
        "up": map.up,
        "down": map.down,
        "inverse": map.inverse(),
    });
    console.result(&data, || dead_zone_text(&map, input_unit, output_unit))?;
    Ok(ExitStatus::Done)
}

fn dead_zone_text(map: &DeadZoneMap, input_unit: &str, output_unit: &str) -> String {
    let inverse = map.inverse();
    let mut table = show::table(["", "Above zero", "Below zero", "Unit"]);
    let mut row = |name: &str, of: &dyn Fn(&Side) -> String, unit: String| {
        table.add_row([name.to_string(), of(&map.up), of(&map.down), unit]);
    };
    let slope = format!("{output_unit} per {input_unit}");
    let limit =
        |limit: Option<IntervalEstimate>| limit.map_or("none seen".into(), |limit| known(&limit));
    row("dead zone ends at", &|s| known(&s.edge), input_unit.into());
    row("slope outside", &|s| known(&s.slope), slope);
    row("limit", &|s| limit(s.limit), output_unit.into());
    row("left over, RMS", &|s| exact(s.rms), output_unit.into());
    row("blocks", &|s| s.blocks.to_string(), String::new());
    let most = match inverse.limit {
        Some(limit) => format!(", |y| up to {} {output_unit}", exact(limit)),
        None => String::new(),
    };
    format!(
        "{table}\n\nTurned round, the command u for an output y{most}:\n  \
         y > 0:  u =  {} + {} y\n  y < 0:  u = -{} + {} y",
        exact(inverse.edge_up),
        exact(inverse.per_output_up),
        exact(inverse.edge_down),
        exact(inverse.per_output_down),
    )
}

fn supply(args: &MapArgs, console: &Console) -> Result<ExitStatus> {
    let (blocks, input_unit, output_unit) = measured(args)?;
    if input_unit != output_unit {
        return Err(Error::usage(
            format!("the command is in {input_unit} and the output in {output_unit}"),
            "a speed error needs a commanded speed: give --input as a speed and --output as an \
             angle or a speed",
        ));
    }
    let line = match SupplyLine::fit(&blocks) {
        Ok(line) => line,
        Err(why) => return refused(&why, console),
    };
    console.result(&line, || supply_text(&line))?;
    Ok(ExitStatus::Done)
}

fn supply_text(line: &SupplyLine) -> String {
    let per_v = line.error_per_v;
    let percent = IntervalEstimate {
        value: 100.0 * per_v.value,
        low: 100.0 * per_v.low,
        high: 100.0 * per_v.high,
    };
    let seen = if per_v.holds(0.0) {
        "No effect of the supply is seen: the interval holds 0."
    } else {
        "The speed error follows the supply."
    };
    format!(
        "speed error per volt  {} % of the command\n\
         right at              {} V\n\
         supply seen           {} to {} V, {} blocks\n\
         left over, RMS        {} % of the command\n{seen}",
        known(&percent),
        known(&line.right_at_v),
        exact(line.range_v.0),
        exact(line.range_v.1),
        line.blocks,
        exact(100.0 * line.rms),
    )
}

fn refused(why: &Problem, console: &Console) -> Result<ExitStatus> {
    let data = json!({ "refused": why.to_string(), "remedy": why.remedy });
    console.result(&data, || format!("refused: {why} ({})", why.remedy))?;
    Ok(ExitStatus::Refused)
}
