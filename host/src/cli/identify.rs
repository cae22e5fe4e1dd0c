//! `handstand identify LOG... [--orders bj:1,2,1,2,1]...`: a servo as a black box.
//!
//! Discrete-time models from what the servo was told to what it did, fitted by the prediction-error method. Of
//! several orders the plainest is kept that foretells data it was not fitted to as well as the best one. From a
//! measured angle the speed is estimated as (theta(t) - theta(t - 1)) / Ts.
//!
//! ```console
//! $ handstand identify run.csv --time t=s --input goal=rad/s --output angle=deg --validate other.csv
//! ```
//!
//! Orders are written as in MATLAB: `arx:na,nb,nk`, `armax:na,nb,nc,nk`, `oe:nb,nf,nk`, `bj:nb,nc,nd,nf,nk`,
//! each a number or a range such as `1-3`. Without `--validate` the last third of each motion is held out.
//! `docs/identify.md` explains the output; its keys as `--json` are in `docs/json.md`. Exit code 1: no model
//! could be fitted.

use super::signals::{self, Chosen, Signals};
use super::talk::Talk;
use super::{Outcome, input, show};
use handstand::log::{LogRequest, Motion};
use handstand::number::exact;
use handstand::servo::{
    Estimate, Fitted, Known, Record, Structure, Trial, dynamics, record, sampling_period_s, select,
    structures, transfer_function, try_all,
};
use handstand::{Error, Result};
use serde_json::{Value, json};

/// Orders tried unless told.
const DEFAULT: [&str; 4] = [
    "arx:1-3,1-2,1",
    "armax:1-3,1-2,1-2,1",
    "oe:1-2,1-3,1",
    "bj:1-2,1-2,1-2,1-3,1",
];
/// Rows of the table of orders.
const SHOWN: usize = 12;

/// Identify a servo as a black box.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// Logs to learn from
    #[arg(required = true, value_name = "LOG", value_parser = input::log)]
    logs: Vec<LogRequest>,
    /// Logs to judge by
    #[arg(long, num_args = 1.., value_name = "LOG", value_parser = input::log)]
    validate: Vec<LogRequest>,
    /// Share of each motion to learn from where no logs are held out
    #[arg(long, value_name = "SHARE", default_value_t = 2.0 / 3.0, hide_default_value = true, conflicts_with = "validate")]
    split: f64,
    /// Orders to try, with ranges: bj:1,2,1,2,1 or oe:1-2,1-3,1
    #[arg(long, value_name = "ORDERS", value_parser = orders)]
    orders: Vec<Grid>,
    #[command(flatten)]
    signals: Signals,
}

/// The structures of one `--orders`.
#[derive(Debug, Clone)]
pub struct Grid(Vec<Structure>);

fn orders(text: &str) -> Result<Grid, String> {
    structures(text).map(Grid).map_err(input::said)
}

/// What is learned from and judged by.
struct Data {
    chosen: Chosen,
    ts_s: f64,
    training: Vec<Record>,
    validation: Vec<Record>,
}

/// Fits, selects, prints.
pub fn run(args: &Args, talk: &Talk) -> Result<Outcome> {
    let data = data(args)?;
    let mut grid: Vec<Structure> = args.orders.iter().flat_map(|g| g.0.clone()).collect();
    if grid.is_empty() {
        for text in DEFAULT {
            grid.extend(structures(text)?);
        }
    }
    let bar = talk.bar();
    bar.set_length(grid.len() as u64);
    let trials = try_all(&grid, &data.training, &data.validation, &|| bar.inc(1));
    bar.finish_and_clear();
    let chosen = select(&trials, &data.validation);
    if talk.json {
        talk.data(&found_json(&data, &trials, chosen))?;
    } else {
        talk.print(&text(&data, &trials, chosen))?;
    }
    Ok(match chosen {
        Some(_) => Outcome::Done,
        None => Outcome::Refused,
    })
}

fn data(args: &Args) -> Result<Data> {
    if !(args.split > 0.0 && args.split < 1.0) {
        return Err(Error::usage(
            format!("a share of {} to learn from", args.split),
            "give a share between 0 and 1, such as --split 0.7",
        ));
    }
    let chosen = args.signals.chosen()?;
    let (logs, held_out) = signals::motions(&chosen, &args.logs, &args.validate)?;
    let all: Vec<Motion> = logs.iter().chain(&held_out).cloned().collect();
    let ts_s = sampling_period_s(&all);
    let records = |motions: &[Motion]| -> Result<Vec<Record>> {
        let of = |motion| record(motion, chosen.joint, chosen.output, ts_s);
        motions.iter().map(of).collect()
    };
    let (mut training, mut validation) = (records(&logs)?, records(&held_out)?);
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

fn text(data: &Data, trials: &[Trial], chosen: Option<usize>) -> String {
    let count = |records: &[Record]| records.iter().map(Record::count).sum::<usize>();
    let head = format!(
        "{} samples to learn from, {} to judge by, Ts = {} ms; from {} to {}.",
        count(&data.training),
        count(&data.validation),
        exact(1e3 * data.ts_s),
        unit(data.chosen.input_unit),
        unit(data.chosen.output_unit),
    );
    let mut parts = vec![head, table(trials, chosen)];
    match chosen.map(|index| &trials[index]) {
        Some(Trial {
            outcome: Ok(fitted),
            ..
        }) => parts.push(model(data, fitted)),
        _ => {
            let mut why: Vec<String> = trials
                .iter()
                .filter_map(|trial| trial.outcome.as_ref().err().map(ToString::to_string))
                .collect();
            why.sort();
            why.dedup();
            parts.push(format!("No model could be fitted: {}.", why.join("; ")));
        }
    }
    parts.join("\n\n")
}

fn unit(unit: &str) -> &str {
    if unit == "1" { "a share" } else { unit }
}

/// Best first; the chosen one marked.
fn table(trials: &[Trial], chosen: Option<usize>) -> String {
    let mut rows: Vec<(usize, &Trial, &Fitted)> = trials
        .iter()
        .enumerate()
        .filter_map(|(k, trial)| Some((k, trial, trial.outcome.as_ref().ok()?)))
        .collect();
    rows.sort_by(|a, b| {
        let error = |fitted: &Fitted| fitted.validation.error_rms;
        error(a.2).total_cmp(&error(b.2))
    });
    let least = |of: fn(&Estimate) -> f64| {
        let values = rows.iter().map(|(.., fitted)| of(&fitted.estimate));
        values.fold(f64::INFINITY, f64::min)
    };
    let (least_aic, least_bic) = (least(Estimate::aic), least(Estimate::bic));
    let place = rows.iter().position(|(k, ..)| Some(*k) == chosen);
    let left_out = rows.len().saturating_sub(SHOWN);
    if left_out > 0 {
        if let Some(place) = place.filter(|place| *place >= SHOWN) {
            rows.swap(SHOWN - 1, place);
        }
        rows.truncate(SHOWN);
    }
    let mut table = show::table([
        "Orders", "p", "Error", "Fit", "Free fit", "+AIC", "+BIC", "White", "Indep.", "",
    ]);
    for (k, trial, fitted) in rows {
        let score = &fitted.validation;
        let passed = |index: usize| match score.tests.get(index) {
            Some(test) if test.passed => "yes",
            Some(_) => "no",
            None => "-",
        };
        table.add_row([
            trial.structure.to_string(),
            trial.structure.count().to_string(),
            exact(score.error_rms),
            format!("{:.2} %", score.predicted_fit_percent),
            format!("{:.2} %", score.simulated_fit_percent),
            format!("{:.1}", fitted.estimate.aic() - least_aic),
            format!("{:.1}", fitted.estimate.bic() - least_bic),
            passed(0).to_string(),
            passed(1).to_string(),
            if Some(k) == chosen { "kept" } else { "" }.to_string(),
        ]);
    }
    let mut text = format!(
        "{table}\nOn what was held out: RMS error and fit one step ahead, fit from the input alone, residual tests. AIC \
         and BIC\nof the fit, above the least."
    );
    let failed = trials.iter().filter(|trial| trial.outcome.is_err()).count();
    if left_out > 0 || failed > 0 {
        text += &format!(" {left_out} worse ones are left out; {failed} could not be fitted.");
    }
    text
}

fn model(data: &Data, fitted: &Fitted) -> String {
    let estimate = &fitted.estimate;
    let (model, structure) = (&estimate.model, &estimate.structure);
    let mut coefficients = show::table(["Coefficient", "Value", "95 % interval"]);
    let values = model.values(structure);
    for ((name, value), half) in structure
        .names()
        .into_iter()
        .zip(values)
        .zip(estimate.half_widths())
    {
        coefficients.add_row([name, exact(value), ends(&Known::around(value, half))]);
    }
    let dynamics = dynamics(estimate, data.ts_s);
    let mut lines = vec![
        format!("{structure} has the transfer function"),
        format!("  {}", transfer_function(&model.b, &model.denominator(), 4)),
        coefficients.to_string(),
        format!(
            "static gain {} ({})",
            exact(dynamics.gain.value),
            ends(&dynamics.gain)
        ),
    ];
    for pole in dynamics.poles.iter().filter(|pole| pole.im.value >= 0.0) {
        lines.push(format!("pole {}", pole_text(pole)));
    }
    lines.push(match dynamics.settling_s {
        Some(settling) => format!("settles to 2 % in {} s", exact(settling)),
        None => "does not settle".to_string(),
    });
    lines.extend(fitted.validation.tests.iter().map(|test| {
        let verdict = if test.passed { "passed" } else { "failed" };
        format!("{}: {verdict}; {}", test.name, test.meaning)
    }));
    if !estimate.converged {
        lines.push("warning: the search had not come to rest when its steps ran out".to_string());
    }
    lines.join("\n")
}

fn pole_text(pole: &handstand::servo::Pole) -> String {
    let place = match pole.im.value == 0.0 {
        true => format!("z = {} ({})", exact(pole.re.value), ends(&pole.re)),
        false => format!(
            "z = {} ({}) +- {} j ({})",
            exact(pole.re.value),
            ends(&pole.re),
            exact(pole.im.value),
            ends(&pole.im)
        ),
    };
    format!(
        "{place}, |z| = {}: {} rad/s",
        exact(pole.radius.value),
        match pole.im.value == 0.0 {
            true => exact(pole.decay_rad_s),
            false => format!(
                "{} +- {} j",
                exact(pole.decay_rad_s),
                exact(pole.turn_rad_s)
            ),
        }
    )
}

fn ends(known: &Known) -> String {
    format!("{} to {}", exact(known.low), exact(known.high))
}

fn found_json(data: &Data, trials: &[Trial], chosen: Option<usize>) -> Value {
    let trial = |trial: &Trial| match &trial.outcome {
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
            let names = estimate.structure.names();
            let values = estimate.model.values(&estimate.structure);
            let halves = estimate.half_widths();
            let coefficients: Vec<Value> = (0..names.len())
                .map(|k| {
                    let known = Known::around(values[k], halves[k]);
                    json!({ "name": names[k], "value": known.value, "low": known.low, "high": known.high })
                })
                .collect();
            json!({
                "orders": estimate.structure.to_string(),
                "coefficients": coefficients,
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
