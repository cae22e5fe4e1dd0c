//! A verdict with all that belongs to it: values, errors, rivals, and what was ruled out.

use super::bench::Bench;
use super::findings::{
    Alternative, Diagnosis, ErrorFall, FittedEffect, FittedValue, MotionError, RuledOut,
};
use super::score::{Score, fall};
use super::trial::Trial;
use super::verdict::Case;
use super::words;
use crate::fitting::{Data, Horizon, Interval, intervals, profiled};
use crate::number::percent;

/// Draws the conclusion.
pub(super) fn conclude(case: &Case) -> Diagnosis {
    let rivals = case.rivals();
    let chosen = case.chosen();
    let base = &case.bench.base;
    let verdict = case.verdict(&rivals);
    let (values, collinear, determined) = fitted_values(chosen, case.bench);
    let (base_values, added) = values.split_at(values.len() - chosen.added_values());
    let (low, high) = match (base.deciding(), chosen.deciding()) {
        (Some(before), Some(after)) => fall(before, after, case.seed),
        _ => (0.0, 0.0),
    };
    let held_out = case.bench.held_out.is_some();
    let mut diagnosis = Diagnosis {
        verdict,
        effects: effects(chosen, added),
        error: ErrorFall {
            unit: "rad".to_string(),
            before: base.deciding_rms_rad(),
            after: chosen.deciding_rms_rad(),
            floor: floor_rad(case.bench),
            held_out,
            fall_low: low,
            fall_high: high,
        },
        alternatives: rivals.iter().map(|t| alternative(t, case.bench)).collect(),
        base: base_values.to_vec(),
        ruled_out: ruled_out(case, &rivals),
        remainder: case.remainder.clone(),
        motions: motions(case),
        collinear,
        summary: Vec::new(),
        next: Vec::new(),
        warnings: Vec::new(),
        horizon_s: match case.bench.horizon {
            Horizon::Whole => None,
            Horizon::Seconds(seconds) => Some(seconds),
        },
    };
    if !determined {
        diagnosis.warnings.push(
            "some fitted values have no effect on the residual: their intervals are unknown"
                .to_string(),
        );
    }
    if case.sham_ranks() {
        diagnosis.warnings.push(
            "a shuffled regressor gains as much as the best effect: nothing may be named"
                .to_string(),
        );
    }
    if case.inconstant() {
        diagnosis.warnings.push(format!(
            "values that fit one motion do not fit another: each by itself would leave {} less of the squared error",
            percent(case.own_values_share.unwrap_or(0.0))
        ));
    }
    words::complete(&mut diagnosis);
    diagnosis
}

fn floor_rad(bench: &Bench) -> f64 {
    let sigma = &bench.training.sigma_rad;
    (sigma.iter().map(|s| s * s).sum::<f64>() / sigma.len().max(1) as f64).sqrt()
}

/// Values with intervals, strongly correlated pairs, and whether the data determine them at all.
fn fitted_values(
    trial: &Trial,
    bench: &Bench,
) -> (Vec<FittedValue>, Vec<(String, String, f64)>, bool) {
    let fit = trial.fit();
    let known = intervals(fit, &bench.training)
        .map(|(intervals, correlation)| (profiled(fit, &bench.training, &intervals), correlation));
    let on_bound = fit.on_bound();
    let mut values = Vec::new();
    for (i, (path, value)) in fit.free.iter().zip(fit.values()).enumerate() {
        let unknown = Interval {
            standard_error: f64::INFINITY,
            low: path.bounds(&fit.model).0,
            high: path.bounds(&fit.model).1,
        };
        let interval = known.as_ref().map_or(unknown, |k| k.0[i]);
        values.push(FittedValue::of(*path, value, interval, on_bound[i]));
    }
    let mut collinear = Vec::new();
    if let Some((_, correlation)) = &known {
        for a in 0..values.len() {
            for b in 0..a {
                let r = correlation[(a, b)];
                if r.abs() > 0.95 {
                    collinear.push((values[b].path.clone(), values[a].path.clone(), r));
                }
            }
        }
    }
    (values, collinear, known.is_some())
}

/// The effects of a trial with their values, which come in the order of the set.
fn effects(trial: &Trial, mut values: &[FittedValue]) -> Vec<FittedEffect> {
    trial
        .set
        .iter()
        .map(|candidate| {
            let info = candidate.effect.info();
            let (own, rest) = values.split_at(info.parameters.len());
            values = rest;
            FittedEffect {
                kind: info.id.to_string(),
                title: info.title.to_string(),
                joint: candidate.joint.map(|j| j + 1),
                parameters: own.to_vec(),
            }
        })
        .collect()
}

fn alternative(trial: &Trial, bench: &Bench) -> Alternative {
    let (values, _, _) = fitted_values(trial, bench);
    Alternative {
        effects: effects(trial, &values[values.len() - trial.added_values()..]),
        error: trial.deciding_rms_rad(),
    }
}

fn ruled_out(case: &Case, rivals: &[&Trial]) -> Vec<RuledOut> {
    let base = &case.bench.base;
    case.trials
        .iter()
        .filter(|t| case.best.as_ref().is_none_or(|best| !t.adds(&best.set)))
        .filter(|t| !rivals.iter().any(|r| r.adds(&t.set)))
        .map(|t| RuledOut {
            set: t.set.iter().map(ToString::to_string).collect(),
            training_error: t.training_rms_rad(&case.bench.search),
            held_out_error: t
                .judged
                .as_ref()
                .and_then(|j| Some(j.held_out.as_ref()?.rms_rad())),
            bic_change: case.bench.bic_change(base, t),
            why: why_not(case, t),
        })
        .collect()
}

fn why_not(case: &Case, trial: &Trial) -> String {
    let base = &case.bench.base;
    if trial.rests_on_bound() {
        return "its best value is on a bound, where it vanishes or stops being physical"
            .to_string();
    }
    if trial.search_mean > 0.99 * base.search_mean {
        return "it does not lower the error".to_string();
    }
    if case.bench.held_out.is_some() {
        match trial.judged.as_ref().and_then(|j| j.held_out.as_ref()) {
            None => return "others leave far less on the training motions".to_string(),
            Some(held_out) if held_out.mean() > base.deciding_mean() => {
                return "it fits the training motions and makes the held-out ones worse"
                    .to_string();
            }
            Some(_) => {}
        }
    }
    match &case.best {
        Some(best) if trial.set.len() > best.set.len() => {
            "one more effect gains nothing sure".to_string()
        }
        Some(best) if case.bench.clearly_worse(trial, best, base) => {
            format!("{} surely leaves less", best.name())
        }
        Some(_) => "the chosen set does as well with fewer values".to_string(),
        None => "what it gains may be chance".to_string(),
    }
}

fn motions(case: &Case) -> Vec<MotionError> {
    let (Some(before), Some(after)) = (&case.bench.base.judged, &case.chosen().judged) else {
        return Vec::new();
    };
    let rms = |m: (f64, usize)| (m.0 / m.1.max(1) as f64).sqrt();
    let mut list = Vec::new();
    let mut add = |data: &Data, before: &Score, after: &Score, held_out: bool| {
        for (k, motion) in data.motions.iter().enumerate() {
            list.push(MotionError {
                motion: motion.name.clone(),
                held_out,
                before: rms(before.motions[k]),
                after: rms(after.motions[k]),
            });
        }
    };
    add(
        &case.bench.training,
        &before.training,
        &after.training,
        false,
    );
    if let (Some(data), Some(before), Some(after)) =
        (&case.bench.held_out, &before.held_out, &after.held_out)
    {
        add(data, before, after, true);
    }
    list
}
