//! `handstand identify LOG... [--orders bj:1,2,1,2,1]...`: identifies a servo as a black box.
//!
//! Discrete-time models from command to measured output, fitted by the prediction-error method. Of
//! several orders the one with the fewest coefficients is kept that predicts held-out data as well
//! as the best one. From a measured angle the speed is estimated as (theta(t) - theta(t - 1)) / Ts.
//!
//! ```console
//! $ handstand identify run.csv --time t=s --input goal=rad/s --output angle=deg \
//!     --validate other.csv
//! ```
//!
//! Orders are written as in MATLAB: `arx:na,nb,nk`, `armax:na,nb,nc,nk`, `oe:nb,nf,nk`,
//! `bj:nb,nc,nd,nf,nk`, each a number or a range such as `1-3`. Without `--validate` the last third
//! of each motion is held out. `docs/identify.md` explains the output; its keys as `--json` are in
//! `docs/json.md`. Exit code 1: no model could be fitted.

use super::servo_columns::{ChosenColumns, ServoColumns};
use super::{Console, ExitStatus, input};
use handstand::log::LogRequest;
use handstand::motion::Motion;
use handstand::sysid::{
    IntervalEstimate, Record, Structure, TriedStructure, dynamics, record, sampling_period_s,
    select, structures, try_all,
};
use handstand::{Error, Result};
use serde_json::{Value, json};

mod text;

/// Orders tried by default.
const DEFAULT: [&str; 4] = [
    "arx:1-3,1-2,1",
    "armax:1-3,1-2,1-2,1",
    "oe:1-2,1-3,1",
    "bj:1-2,1-2,1-2,1-3,1",
];

/// Identify a servo as a black box.
#[derive(Debug, clap::Args)]
pub struct IdentifyArgs {
    /// Logs to learn from
    #[arg(required = true, value_name = "LOG", value_parser = input::log)]
    logs: Vec<LogRequest>,
    /// Logs to judge by
    #[arg(long, num_args = 1.., value_name = "LOG", value_parser = input::log)]
    validate: Vec<LogRequest>,
    /// Share of each motion to learn from where no logs are held out
    #[arg(long, value_name = "SHARE", default_value_t = 2.0 / 3.0)]
    #[arg(hide_default_value = true, conflicts_with = "validate")]
    split: f64,
    /// Orders to try, with ranges: bj:1,2,1,2,1 or oe:1-2,1-3,1
    #[arg(long, value_name = "ORDERS", value_parser = orders)]
    orders: Vec<Grid>,
    #[command(flatten)]
    columns: ServoColumns,
}

/// The structures of one `--orders`.
#[derive(Debug, Clone)]
pub struct Grid(Vec<Structure>);

fn orders(text: &str) -> Result<Grid, String> {
    structures(text).map(Grid).map_err(input::said)
}

/// What is learned from and judged by.
struct Data {
    chosen: ChosenColumns,
    ts_s: f64,
    training: Vec<Record>,
    validation: Vec<Record>,
}

/// Fits, selects, prints.
pub fn run(args: &IdentifyArgs, console: &Console) -> Result<ExitStatus> {
    let data = data(args)?;
    let mut grid: Vec<Structure> = args.orders.iter().flat_map(|g| g.0.clone()).collect();
    if grid.is_empty() {
        for text in DEFAULT {
            grid.extend(structures(text)?);
        }
    }
    let bar = console.bar(grid.len() as u64);
    let trials = try_all(&grid, &data.training, &data.validation, &|| bar.inc(1));
    drop(bar);
    let chosen = select(&trials, &data.validation);
    console.result(&found_json(&data, &trials, chosen), || {
        text::text(&data, &trials, chosen)
    })?;
    Ok(ExitStatus::answer(chosen.is_some()))
}

fn data(args: &IdentifyArgs) -> Result<Data> {
    if !(args.split > 0.0 && args.split < 1.0) {
        return Err(Error::usage(
            format!("a share of {} to learn from", args.split),
            "give a share between 0 and 1, such as --split 0.7",
        ));
    }
    let chosen = args.columns.chosen()?;
    let split = input::log_set(&args.logs, &args.validate).read(&chosen.columns)?;
    let all: Vec<Motion> = split
        .training
        .iter()
        .chain(&split.held_out)
        .cloned()
        .collect();
    let ts_s = sampling_period_s(&all);
    let records = |motions: &[Motion]| -> Result<Vec<Record>> {
        let of = |motion| record(motion, chosen.joint, chosen.output, ts_s);
        motions.iter().map(of).collect()
    };
    let (mut training, mut validation) = (records(&split.training)?, records(&split.held_out)?);
    if validation.is_empty() {
        (training, validation) = training.iter().map(|r| r.split(args.split)).unzip();
    }
    Ok(Data {
        chosen,
        ts_s,
        training,
        validation,
    })
}

fn found_json(data: &Data, trials: &[TriedStructure], chosen: Option<usize>) -> Value {
    let trial = |trial: &TriedStructure| match &trial.outcome {
        Ok(fitted) => json!({
            "orders": trial.structure.to_string(),
            "coefficients": trial.structure.count(),
            "training": fitted.training,
            "validation": fitted.validation,
            "aic": fitted.estimate.aic(),
            "bic": fitted.estimate.bic(),
        }),
        Err(why) => json!({ "orders": trial.structure.to_string(), "unfitted": why.to_string() }),
    };
    let kept = chosen
        .and_then(|index| trials[index].outcome.as_ref().ok())
        .map(|fitted| {
            let estimate = &fitted.estimate;
            let coefficient = |(name, known): (String, IntervalEstimate)| {
                let (value, low, high) = (known.value, known.low, known.high);
                json!({ "name": name, "value": value, "low": low, "high": high })
            };
            let coefficients = estimate.coefficients().into_iter().map(coefficient);
            json!({
                "orders": estimate.structure.to_string(),
                "coefficients": coefficients.collect::<Vec<Value>>(),
                "polynomials": estimate.model,
                "dynamics": dynamics(estimate, data.ts_s),
                "converged": estimate.converged,
            })
        });
    json!({
        "sampling_period_s": data.ts_s,
        "input_unit": data.chosen.input_unit,
        "output_unit": data.chosen.output_unit,
        "trials": trials.iter().map(trial).collect::<Vec<_>>(),
        "kept": kept,
    })
}
