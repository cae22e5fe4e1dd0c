//! A diagnosis as text for the terminal.

use super::candidates::{alternatives, tried_columns};
use super::parameters::{EffectValue, effect_values, value_columns};
use super::remains::free_form;
use super::table::table_lines;
use super::waterfall::budget_columns;
use super::words::{floor_interval, measured_on, odd_shares, reduction, sentences, sorted};
use crate::diagnose::words::{change, headline as sentence};
use crate::diagnose::{BudgetedPart, Diagnosis, FittedEffect, Fold, WrongValue};
use crate::fitting::in_windows;
use crate::model::{JointNames, MeasuredSignal};
use crate::output::number::{given, mrad};
use maud::Markup;

/// Columns of a table.
const WIDTH: u16 = 90;
/// Rows shown of what was ruled out.
const SHOWN: usize = 8;

/// Everything a diagnosis says that fits a terminal. Links and joints are called as `names` has
/// them.
pub fn diagnosis_text(diagnosis: &Diagnosis, names: &JointNames) -> String {
    let sections = [
        Some(headline(diagnosis)),
        parameters("Missing effects", &diagnosis.effects, names),
        wrong_values(&diagnosis.wrong_values),
        error(diagnosis),
        budget(&diagnosis.budget, names, diagnosis.error.quantity),
        list("As good", &alternatives(diagnosis)),
        not_chosen(diagnosis, names, true),
        not_chosen(diagnosis, names, false),
        diagnosis.residual_structure.as_ref().map(free_form),
        list("Next", &diagnosis.next),
        list("Warnings", &diagnosis.warnings),
    ];
    let sections: Vec<String> = sections.into_iter().flatten().collect();
    names.in_text(&sections.join("\n\n")) + "\n"
}

fn headline(diagnosis: &Diagnosis) -> String {
    let verdict = diagnosis.verdict.name();
    let mut lines = vec![format!("Verdict: {verdict}. {}", sentence(diagnosis))];
    lines.extend(sentences(diagnosis).cloned());
    lines.join("\n")
}

/// The values of effects, under this title.
pub(crate) fn parameters(
    title: &str,
    effects: &[FittedEffect],
    names: &JointNames,
) -> Option<String> {
    let values: Vec<EffectValue> = effect_values(effects).collect();
    let lines = table_lines(&values, &value_columns(names), WIDTH)?;
    Some(format!("{title}\n{lines}"))
}

fn wrong_values(wrong: &[WrongValue]) -> Option<String> {
    let line = |wrong: &WrongValue| format!("{}: {}", wrong.fitted.path, change(wrong));
    let lines = |within: bool| -> Vec<String> {
        let own = wrong.iter().filter(|w| w.within_uncertainty == within);
        own.map(line).collect()
    };
    let lists = [
        list("Wrong values", &lines(false)),
        list("Better values, within their uncertainty", &lines(true)),
    ];
    let lists: Vec<String> = lists.into_iter().flatten().collect();
    (!lists.is_empty()).then(|| lists.join("\n\n"))
}

pub(crate) fn error(diagnosis: &Diagnosis) -> Option<String> {
    let error = &diagnosis.error;
    let unit = error.quantity.milli();
    let (before, after) = (mrad(error.before_rad), mrad(error.after_rad));
    let added = !diagnosis.effects.is_empty() || !diagnosis.wrong_values.is_empty();
    let refitted = error
        .refitted_rad
        .map(|rad| format!(", {} {unit} refitted", mrad(rad)));
    let refitted = refitted.unwrap_or_default();
    let change = if added {
        format!(" as given{refitted} -> {after} {unit};")
    } else {
        format!(" as given{refitted};")
    };
    let mut lines = vec![
        format!(
            "Error: {before} {unit}{change} floor {}{} {unit}.",
            mrad(error.floor_rad),
            floor_interval(error)
        ),
        format!(
            "Searched {}; RMS {}, on {}.",
            searched(diagnosis.search_horizon_s),
            in_windows(&diagnosis.windows),
            measured_on(error)
        ),
    ];
    lines.extend(
        reduction(error)
            .filter(|_| added)
            .map(|reduction| format!("So {reduction}.")),
    );
    lines.extend(folds(&diagnosis.folds, unit));
    error.before_rad.is_finite().then(|| lines.join("\n"))
}

/// "in windows of 1 s"
fn searched(horizon_s: Option<f64>) -> String {
    horizon_s.map_or("over whole motions".to_string(), |seconds| {
        format!("in windows of {} s", given(seconds))
    })
}

/// "With other motions held out: 41.0 -> 6.2, 39.5 -> 6.4 mrad."
fn folds(folds: &[Fold], unit: &str) -> Option<String> {
    let each = folds.iter();
    let each = each.map(|fold| format!("{} -> {}", mrad(fold.before_rad), mrad(fold.after_rad)));
    let each: Vec<String> = each.collect();
    (!each.is_empty()).then(|| format!("With other motions held out: {} {unit}.", each.join(", ")))
}

/// What each part of an explanation of several removes.
fn budget(parts: &[BudgetedPart], names: &JointNames, quantity: MeasuredSignal) -> Option<String> {
    if parts.len() < 2 {
        return None;
    }
    let table = table_lines(parts, &budget_columns(names, quantity), WIDTH)?;
    let title = "Share of the squared error of the model as given that each part removes";
    let lines = [title, &table].into_iter().chain(odd_shares(parts));
    Some(lines.collect::<Vec<_>>().join("\n"))
}

/// What was tried and not chosen: what does as well, then what does worse.
fn not_chosen(diagnosis: &Diagnosis, names: &JointNames, as_good: bool) -> Option<String> {
    let rows = sorted(diagnosis, as_good);
    let title = if as_good {
        "As good, not needed"
    } else {
        "Ruled out"
    };
    let quantity = diagnosis.error.quantity;
    let columns = tried_columns(title, names, quantity, |_| Markup::default());
    let mut lines = vec![table_lines(
        rows.iter().copied().take(SHOWN),
        &columns,
        WIDTH,
    )?];
    lines.extend(and_more(rows.len(), SHOWN));
    Some(lines.join("\n"))
}

pub(crate) fn list(title: &str, items: &[String]) -> Option<String> {
    let lines: Vec<String> = items.iter().map(|item| format!("  - {item}")).collect();
    (!items.is_empty()).then(|| format!("{title}\n{}", lines.join("\n")))
}

pub(crate) fn and_more(all: usize, shown: usize) -> Option<String> {
    (all > shown).then(|| format!("and {} more", all - shown))
}
