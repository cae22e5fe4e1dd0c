//! What was identified, in words and tables.

use super::Data;
use crate::cli::show::{self, ends, known};
use handstand::output::number::exact;
use handstand::report::table::columns_of;
use handstand::sysid::{
    Estimate, FittedModel, IntervalEstimate, Pole, Record, TriedStructure, dynamics,
    transfer_function,
};

/// Rows of the table of orders.
const SHOWN: usize = 12;

/// The whole answer in words.
pub fn text(data: &Data, trials: &[TriedStructure], chosen: Option<usize>) -> String {
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
        Some(TriedStructure {
            outcome: Ok(fitted),
            ..
        }) => parts.push(model(data, fitted)),
        _ => {
            let unfitted = trials
                .iter()
                .filter_map(|trial| trial.outcome.as_ref().err());
            let mut why: Vec<String> = unfitted.map(ToString::to_string).collect();
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
fn table(trials: &[TriedStructure], chosen: Option<usize>) -> String {
    let mut rows: Vec<(usize, &TriedStructure, &FittedModel)> = trials
        .iter()
        .enumerate()
        .filter_map(|(k, trial)| Some((k, trial, trial.outcome.as_ref().ok()?)))
        .collect();
    rows.sort_by(|a, b| {
        let error = |fitted: &FittedModel| fitted.validation.error_rms;
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
    let passed = |fitted: &FittedModel, index: usize| match fitted.validation.tests.get(index) {
        Some(test) if test.passed => "yes".to_string(),
        Some(_) => "no".to_string(),
        None => "-".to_string(),
    };
    let kept = |k: usize| if Some(k) == chosen { "kept" } else { "" };
    let columns = columns_of::<(usize, &TriedStructure, &FittedModel)>()
        .text("Orders", |(_, trial, _)| trial.structure.to_string())
        .text("p", |(_, trial, _)| trial.structure.count().to_string())
        .text("Error", |(.., fitted)| exact(fitted.validation.error_rms))
        .text("Fit", |(.., fitted)| {
            percent(fitted.validation.predicted_fit_percent)
        })
        .text("Free fit", |(.., fitted)| {
            percent(fitted.validation.simulated_fit_percent)
        })
        .text("+AIC", |(.., fitted)| {
            format!("{:.1}", fitted.estimate.aic() - least_aic)
        })
        .text("+BIC", |(.., fitted)| {
            format!("{:.1}", fitted.estimate.bic() - least_bic)
        })
        .text("White", |(.., fitted)| passed(fitted, 0))
        .text("Indep.", |(.., fitted)| passed(fitted, 1))
        .text("", |(k, ..)| kept(*k).to_string());
    let mut text = format!(
        "{}\nOn what was held out: RMS error and fit one step ahead, fit from the input alone, \
         residual tests. AIC and BIC\nof the fit, above the least.",
        show::table_of(&rows, &columns)
    );
    let failed = trials.iter().filter(|trial| trial.outcome.is_err()).count();
    if left_out > 0 || failed > 0 {
        text += &format!(" {left_out} worse ones are left out; {failed} could not be fitted.");
    }
    text
}

fn percent(percent: f64) -> String {
    format!("{percent:.2} %")
}

fn model(data: &Data, fitted: &FittedModel) -> String {
    let estimate = &fitted.estimate;
    let (model, structure) = (&estimate.model, &estimate.structure);
    let columns = columns_of::<(String, IntervalEstimate)>()
        .text("Coefficient", |(name, _)| name.clone())
        .text("Value", |(_, known)| exact(known.value))
        .text("95 % interval", |(_, known)| ends(known));
    let coefficients = show::table_of(&estimate.coefficients(), &columns);
    let dynamics = dynamics(estimate, data.ts_s);
    let mut lines = vec![
        format!("{structure} has the transfer function"),
        format!("  {}", transfer_function(&model.b, &model.denominator(), 4)),
        coefficients.to_string(),
        format!("static gain {}", known(&dynamics.gain)),
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

fn pole_text(pole: &Pole) -> String {
    let (mut place, mut rate) = (known(&pole.re), exact(pole.decay_rad_s));
    if pole.im.value != 0.0 {
        place += &format!(" +- {} j ({})", exact(pole.im.value), ends(&pole.im));
        rate += &format!(" +- {} j", exact(pole.turn_rad_s));
    }
    let radius = exact(pole.radius.value);
    format!("z = {place}, |z| = {radius}: {rate} rad/s")
}
